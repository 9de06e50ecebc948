// sim/session/replayer.h
// A recorded attempt, one tick at a time: device counts and schedule come from the log, everything
// else is computed. From its first tick on it gives the recorded bits (run_replay); from a later
// one, before which no tool touched for a while, what a person sees of it (MomentReplay).
#pragma once

#include "haptics/device/replay_device.h"
#include "sim/session/session.h"

namespace sim {

struct Recording {
    std::vector<tasks::TickTrace> ticks; // one after another
    std::vector<tasks::StepTrace> steps;
};
Recording join(const std::vector<tasks::Chunk>& chunks);

class Replayer {
  public:
    /// Takes over the instruments of `session`, which has done no tick yet. `from`: index of the
    /// first tick. Both references must outlive this.
    Replayer(Session& session, const Recording& recording, std::size_t from = 0);

    bool done() const { return next_ >= recording_.ticks.size(); }
    std::size_t next() const { return next_; }
    /// The next recorded tick, simulated again. FEM steps and ticks go to `fold`, if any.
    const tasks::TickTrace& tick(Attempt* fold);

  private:
    bool take_steps(const tasks::TickTrace& wanted, Attempt* fold);

    Session& session_;
    const Recording& recording_;
    std::size_t next_, next_step_ = 0;
    std::array<std::vector<haptics::RecordedRead>, kTools> read_;
    std::array<std::unique_ptr<haptics::ReplayDevice>, kTools> device_;
    std::vector<haptics::RecordedRead> scope_read_; // empty: the picture was fixed
    std::unique_ptr<haptics::ReplayDevice> scope_;
    std::vector<ToolsNow> past_;
    std::int64_t first_tick_ = 0;
    tasks::TickTrace trace_;
};

} // namespace sim
