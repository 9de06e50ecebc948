// sim/session/replay.cpp
// A recorded attempt again: the device counts and the schedule (which tool tick each FEM step
// read, at which tick each answer was taken up) come from the log, everything else is computed.
// An attempt that was recorded in real time replays to the same bits, late answers included.
#include "haptics/device/replay_device.h"
#include "sim/session/session.h"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

struct Recording {
    std::vector<tasks::TickTrace> ticks;
    std::vector<tasks::StepTrace> steps;
};

Recording join(const std::vector<tasks::Chunk>& chunks) {
    Recording all;
    for (const tasks::Chunk& chunk : chunks) {
        all.ticks.insert(all.ticks.end(), chunk.ticks.begin(), chunk.ticks.end());
        all.steps.insert(all.steps.end(), chunk.steps.begin(), chunk.steps.end());
    }
    return all;
}

// What each device gave, tick by tick. A tool that nobody held has no device.
struct RecordedTools {
    std::array<std::vector<haptics::RecordedRead>, kTools> read;
    std::array<std::unique_ptr<haptics::ReplayDevice>, kTools> device;
};

RecordedTools recorded_tools(const Recording& recording) {
    RecordedTools tools;
    for (int i = 0; i < kTools; ++i) {
        bool held = false;
        for (const tasks::TickTrace& tick : recording.ticks) {
            const tasks::ToolTrace& t = tick.tool[i];
            held |= (t.flags & 2) != 0;
            tools.read[i].push_back({.sample = {.counts = t.counts,
                                                .roll_counts = t.roll_counts,
                                                .jaw_counts = t.jaw_counts},
                                     .fault = (t.flags & 4) ? haptics::DeviceFault::timeout
                                                            : haptics::DeviceFault::none});
        }
        if (held)
            tools.device[i] =
                std::make_unique<haptics::ReplayDevice>(haptics::DeviceInfo{}, tools.read[i]);
    }
    return tools;
}

bool from_outside(tasks::EventKind kind) {
    using enum tasks::EventKind;
    return kind == paused || kind == resumed || kind == abandoned || kind == rig_fault;
}

double difference_n(const tasks::TickTrace& a, const tasks::TickTrace& b) {
    double worst = 0.0;
    for (int i = 0; i < kTools; ++i) {
        double square = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const double d = (a.tool[i].force_mn[axis] - b.tool[i].force_mn[axis]) * 1e-3;
            square += d * d;
        }
        worst = std::max(worst, std::sqrt(square));
    }
    return worst;
}

} // namespace

ReplayResult run_replay(Session& session, const tasks::AttemptRow& recorded,
                        const std::vector<tasks::Chunk>& chunks,
                        const std::vector<tasks::Event>& events) {
    const Recording recording = join(chunks);
    tasks::AttemptRow row = recorded;
    Attempt attempt(session.scene.scene, session.exercise, session.rest_targets, row, nullptr);
    Exchange& exchange = *session.exchange;
    RecordedTools tools = recorded_tools(recording);
    for (int i = 0; i < kTools; ++i)
        session.haptics.instrument[i].device = tools.device[i].get();

    constexpr std::size_t kRemembered = 4096; // ticks; an answer older than this never was used
    std::vector<ToolsNow> past(kRemembered);
    ReplayResult result;
    std::size_t next_step = 0;
    tasks::TickTrace trace;
    for (const tasks::TickTrace& wanted : recording.ticks) {
        // FEM steps are made when the schedule takes them up, with the poses they read then
        bool fresh = false;
        while (next_step < recording.steps.size() && wanted.adopted_step >= 0 &&
               recording.steps[next_step].step <= wanted.adopted_step) {
            const auto sample = recording.steps[next_step].sample_tick;
            attempt.add(run_step(session, past[static_cast<std::size_t>(sample) % kRemembered],
                                 exchange.answers.back()));
            ++next_step;
            fresh = true;
        }
        if (fresh)
            exchange.answers.publish();
        haptic_tick(session.haptics, exchange, trace);
        past[static_cast<std::size_t>(trace.tick) % kRemembered] = exchange.tools.latest();
        attempt.add(trace);
        for (const tasks::Event& event : events) { // what people and faults did, not the fold
            if (event.tick == trace.tick && from_outside(event.kind))
                attempt.add_event(event);
        }
        const double difference = difference_n(trace, wanted);
        if (difference > 0.0 && result.first_difference_tick < 0) {
            result.first_difference_tick = trace.tick;
        }
        result.worst_force_difference_n = std::max(result.worst_force_difference_n, difference);
    }
    fill_report(session, static_cast<std::int64_t>(recording.ticks.size()), false);
    result.outcome = attempt.finish(session.report);
    return result;
}

} // namespace sim
