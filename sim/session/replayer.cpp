#include "sim/session/replayer.h"

namespace sim {
namespace {

constexpr std::size_t kRemembered = 4096; // ticks; an answer older than this never was used

// What a device gave, tick by tick; nothing for a tool that nobody held.
std::vector<haptics::RecordedRead> reads_of(const Recording& recording, int tool,
                                            std::size_t from) {
    std::vector<haptics::RecordedRead> reads;
    bool held = false;
    for (std::size_t i = from; i < recording.ticks.size(); ++i) {
        const tasks::ToolTrace& t = recording.ticks[i].tool[tool];
        held |= (t.flags & 2) != 0;
        reads.push_back(
            {.sample = {.counts = t.counts,
                        .roll_counts = t.roll_counts,
                        .jaw_counts = t.jaw_counts},
             .fault = (t.flags & 4) ? haptics::DeviceFault::timeout : haptics::DeviceFault::none});
    }
    if (!held)
        reads.clear();
    return reads;
}

std::vector<haptics::RecordedRead> scope_reads_of(const Recording& recording, std::size_t from) {
    std::vector<haptics::RecordedRead> reads;
    for (std::size_t i = from; i < recording.ticks.size(); ++i) {
        const tasks::ScopeTrace& t = recording.ticks[i].scope;
        reads.push_back(
            {.sample = {.counts = t.counts,
                        .roll_counts = t.camera_counts,
                        .optic_counts = t.optic_counts},
             .fault = (t.flags & 4) ? haptics::DeviceFault::timeout : haptics::DeviceFault::none});
    }
    return reads;
}

} // namespace

Recording join(const std::vector<tasks::Chunk>& chunks) {
    Recording all;
    for (const tasks::Chunk& chunk : chunks) {
        all.ticks.insert(all.ticks.end(), chunk.ticks.begin(), chunk.ticks.end());
        all.steps.insert(all.steps.end(), chunk.steps.begin(), chunk.steps.end());
    }
    return all;
}

Replayer::Replayer(Session& session, const Recording& recording, std::size_t from)
    : session_(session), recording_(recording), next_(from), past_(kRemembered) {
    for (int i = 0; i < kTools; ++i) {
        read_[i] = reads_of(recording, i, from);
        if (!read_[i].empty())
            device_[i] = std::make_unique<haptics::ReplayDevice>(haptics::DeviceInfo{}, read_[i]);
        session.haptics.instrument[i].device = device_[i].get();
    }
    if (session.haptics.scope.fitted) {
        scope_read_ = scope_reads_of(recording, from);
        scope_ = std::make_unique<haptics::ReplayDevice>(haptics::DeviceInfo{}, scope_read_);
        session.haptics.scope.device = scope_.get();
    }
    if (from == 0 || from >= recording.ticks.size())
        return;
    first_tick_ = recording.ticks[from].tick;
    session.haptics.next_tick = first_tick_;
}

// FEM steps are made when the schedule takes them up, with the poses they read then. A step that
// read a pose before the first tick of this replay is left out.
bool Replayer::take_steps(const tasks::TickTrace& wanted, Attempt* fold) {
    bool fresh = false;
    while (next_step_ < recording_.steps.size() && wanted.adopted_step >= 0 &&
           recording_.steps[next_step_].step <= wanted.adopted_step) {
        const std::int64_t sample = recording_.steps[next_step_++].sample_tick;
        if (sample < first_tick_)
            continue;
        const ToolsNow& poses = past_[static_cast<std::size_t>(sample) % kRemembered];
        const tasks::StepTrace step = run_step(session_, poses, session_.exchange->answers.back());
        if (fold)
            fold->add(step);
        fresh = true;
    }
    return fresh;
}

const tasks::TickTrace& Replayer::tick(Attempt* fold) {
    Exchange& exchange = *session_.exchange;
    if (take_steps(recording_.ticks[next_], fold))
        exchange.answers.publish();
    session_.haptics.scope.holder = holder_of(recording_.ticks[next_].scope);
    haptic_tick(session_.haptics, exchange, trace_);
    past_[static_cast<std::size_t>(trace_.tick) % kRemembered] = exchange.tools.latest();
    if (fold)
        fold->add(trace_);
    ++next_;
    return trace_;
}

} // namespace sim
