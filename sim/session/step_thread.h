// sim/session/step_thread.h
// FEM steps on a thread of their own while another one ticks, in a session whose time is counted
// and not measured: a step begins and is taken at ticks that are given, so the bits are those of
// one thread, however long it takes. What both share is in sim/exchange.h, as in real time.
#pragma once

#include "sim/session/session.h"

#include <exception>
#include <semaphore>
#include <thread>

namespace sim {

class StepThread {
  public:
    /// `session` must stay where it is. Throws std::system_error if there is no thread to be had.
    explicit StepThread(Session& session);
    /// Waits for a step that was begun.
    ~StepThread();
    StepThread(const StepThread&) = delete;
    StepThread& operator=(const StepThread&) = delete;

    /// Begins the step that sees these tools. Not again before end().
    void begin(const ToolsNow& tools);
    /// Waits for it; its answer is then at the back of the exchange. Throws what it threw.
    tasks::StepTrace end();

  private:
    void run();

    Session& session_;
    ToolsNow tools_;
    tasks::StepTrace step_;
    std::exception_ptr thrown_;
    bool waits_ = false, leave_ = false;
    std::binary_semaphore begun_{0}, made_{0};
    std::thread thread_; // last: it uses all of the above
};

} // namespace sim
