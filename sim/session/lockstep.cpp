// sim/session/lockstep.cpp
// No clock in anything that counts: the integer tick is the time, and the FEM's latency of one
// period is emulated. Everything headless runs like this. A step is made while the ticks of its
// period are: it sees what they do not change, and they see it when all of them are done.
#include "sim/session/step_thread.h"

#include <chrono>

namespace sim {
namespace {

using Clock = std::chrono::steady_clock;

double microseconds(Clock::duration d) {
    return std::chrono::duration<double, std::micro>(d).count();
}

std::int64_t run_ticks(Session& session, Attempt& attempt, bool (*should_stop)()) {
    Exchange& exchange = *session.exchange;
    const std::int64_t period = session.haptics.coupling_config.period_ticks;
    StepThread steps(session);
    tasks::TickTrace trace;
    tasks::HandSight sight = sight_of(session, trace, 0, 0, false);
    std::int64_t tick = 0;
    for (; tick < session.max_ticks && !attempt.progress().complete; ++tick) {
        if (tick > 0 && tick % period == 0) {
            attempt.add(steps.end());
            exchange.answers.publish();
        }
        crew_tick(session.crew, session.haptics, sight);
        const auto start = Clock::now();
        haptic_tick(session.haptics, exchange, trace);
        session.tick_time.add(microseconds(Clock::now() - start));
        attempt.add(trace);
        if (tick % period == 0)
            steps.begin(exchange.tools.latest());
        const tasks::Progress& progress = attempt.progress();
        sight = sight_of(session, trace, progress.next, tasks::found_tubes(progress),
                         progress.complete);
        if (tick % 1000 == 0 && should_stop && should_stop()) {
            attempt.add_event({.tick = tick, .kind = tasks::EventKind::abandoned});
            break;
        }
    }
    return tick;
}

} // namespace

Attempt::Outcome run_lockstep(Session& session, tasks::Logbook* logbook, std::int64_t attempt_id,
                              bool (*should_stop)()) {
    tasks::AttemptRow row = attempt_row(session, false);
    row.id = attempt_id;
    Attempt attempt(session.scene.scene, session.exercise, session.rest_targets, row, logbook);
    if (session.keep_recording)
        attempt.keep_recording();
    const std::int64_t ticks = run_ticks(session, attempt, should_stop);
    fill_report(session, ticks, false);
    return attempt.finish(session.report);
}

} // namespace sim
