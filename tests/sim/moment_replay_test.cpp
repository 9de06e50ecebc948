// A moment of a recorded attempt, shown again without simulating all that was before.
#include "sim/session/moment_replay.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

namespace {

std::vector<tasks::TickTrace> ticks_touching(std::size_t n, std::size_t from, std::size_t to) {
    std::vector<tasks::TickTrace> ticks(n);
    for (std::size_t i = from; i < to; ++i)
        ticks[i].tool[1].flags = 1;
    return ticks;
}

sim::Attempt::Outcome recorded_attempt() {
    sim::RunOptions options;
    options.seed = 3;
    options.max_seconds = 12.0;
    const auto session = sim::make_session(options);
    session->keep_recording = true;
    return sim::run_lockstep(*session, nullptr, 0);
}

const tasks::Moment& largest_force(const sim::Attempt::Outcome& outcome) {
    for (const tasks::Moment& moment : outcome.moments)
        if (moment.kind == "largest_force")
            return moment;
    FAIL("nothing was pressed");
    return outcome.moments.front();
}

} // namespace

TEST_CASE("moment: the replay starts where nothing was touched for half a second") {
    const auto ticks = ticks_touching(5000, 1000, 2000);
    CHECK(sim::quiet_start(ticks, 400) == 0); // no half second yet
    CHECK(sim::quiet_start(ticks, 800) == 800);
    CHECK(sim::quiet_start(ticks, 1500) == 999);
    CHECK(sim::quiet_start(ticks, 2400) == 999);
    CHECK(sim::quiet_start(ticks, 2499) == 999);
    CHECK(sim::quiet_start(ticks, 2500) == 2500);
    CHECK(sim::quiet_start(ticks_touching(100, 0, 100), 99) == 0);
    CHECK(sim::quiet_start({}, 7) == 0);
}

TEST_CASE(
    "moment: it lasts from 3 s before to 2 s after, and shows the recorded force and target") {
    const sim::Attempt::Outcome outcome = recorded_attempt();
    REQUIRE_FALSE(outcome.chunks.empty());
    const tasks::Moment& moment = largest_force(outcome);
    REQUIRE(moment.tick > 4000); // so that the replay does not begin at the beginning
    double peak_n = 0.0;
    for (const tasks::Metric& metric : outcome.metrics)
        if (metric.id == "force_peak")
            peak_n = metric.value;

    sim::MomentReplay replay(outcome.row, outcome.chunks, moment.tick);
    sim::Exchange& exchange = *replay.session().exchange;
    CHECK(exchange.tools_seen.latest().tick == moment.tick - 3001);
    replay.advance(3001);
    const sim::ToolsNow now = exchange.tools_seen.latest();
    CHECK(now.tick == moment.tick);
    // 2 %: the tissue was at rest to less than that when the replay began
    CHECK(glm::length(now.force_n[moment.tool]) ==
          doctest::Approx(peak_n).scale(0.0).epsilon(0.02));
    CHECK(glm::distance(now.tip[moment.tool].centre_m, moment.place_m) < 1e-9);
    CHECK(exchange.surface.latest().step >= 0);

    int touched = 0; // by then, as the events of the attempt have it
    for (const tasks::Event& event : outcome.events)
        touched += event.kind == tasks::EventKind::target_touched && event.tick <= moment.tick;
    CHECK(exchange.progress_seen.latest().next_target == touched);

    CHECK_FALSE(replay.over());
    replay.advance(1 << 20);
    CHECK(replay.over());
    CHECK(exchange.tools_seen.latest().tick == std::min<std::int64_t>(moment.tick + 2000, 11999));
}

TEST_CASE("moment: nothing recorded is refused") {
    sim::RunOptions options;
    options.max_seconds = 0.1;
    const auto session = sim::make_session(options);
    const sim::Attempt::Outcome outcome = sim::run_lockstep(*session, nullptr, 0);
    CHECK(outcome.chunks.empty()); // not asked for
    CHECK_THROWS_AS(sim::MomentReplay(outcome.row, outcome.chunks, 50), std::invalid_argument);
}
