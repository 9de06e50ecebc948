// sim/session/moment_replay.h
// One moment of a recorded attempt again, for the window: from 3 s before it to 2 s after it. The
// tissue is simulated anew from the last time before that at which nothing had been touched for
// half a second, so the start takes a second or two, not the whole attempt. Poses are the recorded
// ones; forces and surfaces are those of the replay. One thread, no clock.
#pragma once

#include "sim/session/replayer.h"

namespace sim {

inline constexpr std::int64_t kBeforeMoment_ticks = 3000, kAfterMoment_ticks = 2000;

/// Index of the tick at which a replay of what begins at index `wanted` may start: the last one,
/// not after it, before which no tool touched for 500 ticks; 0 if there is none.
std::size_t quiet_start(std::span<const tasks::TickTrace> ticks, std::size_t wanted);

class MomentReplay {
  public:
    /// `row` and `chunks` of the attempt; `place`: the scene's directory, empty: a shipped scene.
    /// Throws what session_of throws, and std::invalid_argument for an empty recording.
    MomentReplay(const tasks::AttemptRow& row, std::span<const std::vector<std::byte>> chunks,
                 std::int64_t tick, const std::string& place = {});

    Session& session() { return *session_; }
    bool over() const { return replayer_.next() >= end_; }
    /// Goes on by that many ticks, at most to the end, and publishes what the window shows.
    void advance(int ticks);

  private:
    void one_tick();
    void publish();

    std::unique_ptr<Session> session_;
    Recording recording_;
    std::size_t begin_, end_;
    Replayer replayer_;
    Attempt progress_; // folds the recorded ticks: what the trainee had done by then
    std::size_t next_step_ = 0, folded_ = 0;
};

} // namespace sim
