#include "sim/session/moment_replay.h"

#include <algorithm>

namespace sim {
namespace {

constexpr std::size_t kQuiet_ticks = 500;

Recording decoded(std::span<const std::vector<std::byte>> chunks) {
    std::vector<tasks::Chunk> all;
    for (const auto& bytes : chunks)
        all.push_back(tasks::decode_chunk(bytes));
    Recording recording = join(all);
    if (recording.ticks.empty())
        throw std::invalid_argument("this attempt has no recorded ticks to show");
    return recording;
}

// Index of a tick, or the nearest there is.
std::size_t index_of(const Recording& recording, std::int64_t tick) {
    const std::int64_t last = static_cast<std::int64_t>(recording.ticks.size()) - 1;
    return static_cast<std::size_t>(
        std::clamp<std::int64_t>(tick - recording.ticks.front().tick, 0, last));
}

} // namespace

std::size_t quiet_start(std::span<const tasks::TickTrace> ticks, std::size_t wanted) {
    std::size_t quiet = 0, start = 0;
    for (std::size_t i = 0; i <= wanted && i < ticks.size(); ++i) {
        const auto& tool = ticks[i].tool;
        const bool touched = std::any_of(tool.begin(), tool.end(),
                                         [](const tasks::ToolTrace& t) { return t.flags & 1; });
        quiet = touched ? 0 : quiet + 1;
        if (quiet > kQuiet_ticks)
            start = i;
    }
    return start;
}

MomentReplay::MomentReplay(const tasks::AttemptRow& row,
                           std::span<const std::vector<std::byte>> chunks, std::int64_t tick,
                           const std::string& place)
    : session_(session_of(row, place)), recording_(decoded(chunks)),
      begin_(index_of(recording_, tick - kBeforeMoment_ticks)),
      end_(index_of(recording_, tick + kAfterMoment_ticks) + 1),
      replayer_(*session_, recording_, quiet_start(recording_.ticks, begin_ > 0 ? begin_ - 1 : 0)),
      progress_(session_->scene.scene, session_->exercise, session_->rest_targets, row, nullptr) {
    do { // one tick at least, so that there is something to show
        one_tick();
    } while (replayer_.next() < begin_);
    publish();
}

void MomentReplay::one_tick() {
    replayer_.tick(nullptr);
    for (; folded_ < replayer_.next(); ++folded_) {
        const tasks::TickTrace& tick = recording_.ticks[folded_];
        for (; next_step_ < recording_.steps.size() &&
               recording_.steps[next_step_].step <= tick.adopted_step;
             ++next_step_)
            progress_.add(recording_.steps[next_step_]);
        progress_.add(tick);
    }
}

void MomentReplay::publish() {
    Exchange& exchange = *session_->exchange;
    draw_surface(session_->tissue, exchange.surface.back());
    exchange.surface.publish();
    exchange.progress_seen.back() = progress_now(progress_, session_->exercise);
    exchange.progress_seen.publish();
}

void MomentReplay::advance(int ticks) {
    for (int i = 0; i < ticks && !over(); ++i)
        one_tick();
    publish();
}

} // namespace sim
