// sim/session/replay.cpp
// A recorded attempt again: the device counts and the schedule (which tool tick each FEM step
// read, at which tick each answer was taken up) come from the log, everything else is computed.
// An attempt that was recorded in real time replays to the same bits, late answers included.
#include "sim/session/replayer.h"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

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
    Replayer replayer(session, recording);
    ReplayResult result;
    for (const tasks::TickTrace& wanted : recording.ticks) {
        const tasks::TickTrace& trace = replayer.tick(&attempt);
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
