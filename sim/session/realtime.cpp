// sim/session/realtime.cpp
// The threaded session: haptic thread at 1 kHz, tissue thread at the FEM rate, recorder, and the
// caller's thread for the picture. They meet in sim/exchange.h and nowhere else.
#include "sim/loop/pacer.h"
#include "sim/session/session.h"

#include <chrono>
#include <thread>

namespace sim {
namespace {

using Clock = std::chrono::steady_clock;

double microseconds(Clock::duration d) {
    return std::chrono::duration<double, std::micro>(d).count();
}

struct Counts { // written by one thread each, read after the join
    std::uint64_t missed = 0;
    std::int64_t ticks = 0;
    bool real_time_priority = false;
};

void limp(Session& session) {
    for (Instrument& instrument : session.haptics.instrument) {
        if (instrument.device)
            instrument.device->write(glm::dvec3{0.0});
        haptics::resume(instrument.limit_state);
    }
}

void haptic_thread(Session& session, Counts& counts) {
    counts.real_time_priority = raise_priority(80);
    Exchange& exchange = *session.exchange;
    Pacer pacer(kTick_s);
    tasks::TickTrace trace;
    ProgressNow progress;
    tasks::HandSight sight = sight_of(session, trace, 0, 0, false);
    while (!exchange.stop.load(std::memory_order_relaxed)) {
        pacer.wait();
        if (exchange.paused.load(std::memory_order_relaxed)) {
            limp(session);
            continue;
        }
        if (const ProgressNow* news = exchange.progress.fetch())
            progress = *news;
        if (const PointerGoals* goals = exchange.pointer.fetch())
            session.crew.pointer = *goals;
        crew_tick(session.crew, session.haptics, sight);
        const auto start = Clock::now();
        haptic_tick(session.haptics, exchange, trace);
        session.tick_time.add(microseconds(Clock::now() - start));
        if (!exchange.ticks.push(trace))
            exchange.dropped.fetch_add(1, std::memory_order_relaxed);
        sight = sight_of(session, trace, progress.next_target, progress.found, progress.complete);
        ++counts.ticks;
    }
    limp(session);
    counts.missed = pacer.missed();
}

void tissue_thread(Session& session) {
    raise_priority(60);
    Exchange& exchange = *session.exchange;
    Pacer pacer(session.tissue.config.step_s);
    std::int64_t last_tick = -1;
    while (!exchange.stop.load(std::memory_order_relaxed)) {
        pacer.wait();
        const ToolsNow& tools = exchange.tools.latest();
        if (tools.tick == last_tick)
            continue; // paused, or not begun
        last_tick = tools.tick;
        const tasks::StepTrace step = run_step(session, tools, exchange.answers.back());
        // the recorder must know a step before any tick can have adopted it
        if (!exchange.steps.push(step))
            exchange.dropped.fetch_add(1, std::memory_order_relaxed);
        exchange.answers.publish();
        if (exchange.surface_wanted.load(std::memory_order_relaxed)) {
            draw_surface(session.tissue, exchange.surface.back());
            exchange.surface.publish();
        }
    }
}

struct Recorder {
    Session& session;
    Attempt& attempt;
    std::string error;
    std::int64_t last_tick = 0;

    bool drain() {
        Exchange& exchange = *session.exchange;
        bool any = false;
        tasks::TickTrace tick;
        tasks::StepTrace step;
        tasks::Event mark;
        while (exchange.ticks.pop(tick)) {
            while (exchange.steps.pop(step))
                attempt.add(step);
            attempt.add(tick);
            last_tick = tick.tick;
            any = true;
        }
        while (exchange.marks.pop(mark)) {
            mark.tick = last_tick;
            attempt.add_event(mark);
        }
        return any;
    }

    void publish_progress() {
        const ProgressNow now = progress_now(attempt, session.exercise);
        Exchange& exchange = *session.exchange;
        exchange.progress.back() = now;
        exchange.progress.publish();
        exchange.progress_seen.back() = now;
        exchange.progress_seen.publish();
    }

    void run() {
        try {
            while (!session.exchange->stop.load()) {
                if (drain())
                    publish_progress();
                std::this_thread::sleep_for(std::chrono::milliseconds(4));
            }
            drain();
        } catch (const std::exception& e) {
            error = e.what(); // a full disk ends the attempt; what is written stays whole
            session.exchange->stop.store(true);
        }
    }
};

} // namespace

Attempt::Outcome run_realtime(Session& session, tasks::Logbook* logbook, std::int64_t attempt_id,
                              double seconds, const std::function<bool(Exchange&)>& while_running) {
    tasks::AttemptRow row = attempt_row(session, true);
    row.id = attempt_id;
    Attempt attempt(session.scene.scene, session.exercise, session.rest_targets, row, logbook);
    if (session.keep_recording)
        attempt.keep_recording();
    Exchange& exchange = *session.exchange;
    Counts counts;
    Recorder recorder{session, attempt, {}, 0};
    std::thread haptic([&] { haptic_thread(session, counts); });
    std::thread tissue([&] { tissue_thread(session); });
    std::thread record([&] { recorder.run(); });

    while (!exchange.stop.load()) {
        if (!while_running(exchange))
            break;
        const ProgressNow& progress = exchange.progress_seen.latest();
        const bool over = seconds > 0.0 ? double(progress.tick) * kTick_s >= seconds
                                        : progress.complete || progress.tick >= session.max_ticks;
        if (over)
            break;
    }
    exchange.stop.store(true);
    haptic.join();
    tissue.join();
    record.join();
    if (!recorder.error.empty())
        throw std::runtime_error(recorder.error);
    session.report.missed = static_cast<std::int64_t>(counts.missed);
    fill_report(session, counts.ticks, true);
    return attempt.finish(session.report);
}

} // namespace sim
