// See the header.
#include "sim/session/step_thread.h"

#include <utility>

namespace sim {

StepThread::StepThread(Session& session) : session_(session), thread_([this] { run(); }) {}

StepThread::~StepThread() {
    if (waits_)
        made_.acquire();
    leave_ = true; // read after begun_ alone
    begun_.release();
    thread_.join();
}

void StepThread::begin(const ToolsNow& tools) {
    tools_ = tools;
    waits_ = true;
    begun_.release();
}

tasks::StepTrace StepThread::end() {
    made_.acquire();
    waits_ = false;
    if (thrown_)
        std::rethrow_exception(std::exchange(thrown_, nullptr));
    return step_;
}

void StepThread::run() {
    for (begun_.acquire(); !leave_; begun_.acquire()) {
        try {
            step_ = run_step(session_, tools_, session_.exchange->answers.back());
        } catch (...) {
            thrown_ = std::current_exception();
        }
        made_.release();
    }
}

} // namespace sim
