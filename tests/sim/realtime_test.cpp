// tests/sim/realtime_test.cpp
// The threaded session: what it recorded replays in lockstep to the same bits, late answers, late
// ticks and all. Under the thread sanitizer this is also the data-race test of the whole program.
#include "sim/session/session.h"

#include <doctest/doctest.h>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <unistd.h>

namespace {

// Returns the session as it was left.
std::unique_ptr<sim::Session> perform_and_replay(const std::string& exercise,
                                                 const std::string& hands, double seconds) {
    CAPTURE(exercise);
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("trocar_realtime_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    tasks::Logbook logbook((folder / "station.db").string());
    sim::RunOptions options;
    options.exercise = exercise;
    options.hands = hands;
    options.seed = 11;
    auto session = sim::make_session(options);
    tasks::AttemptRow row = sim::attempt_row(*session, true);
    row.session = logbook.add_session(sim::session_row("scripted"));
    const std::int64_t id = logbook.begin_attempt(row);
    int frames = 0;
    session->exchange->surface_wanted = true;
    const sim::Attempt::Outcome live =
        sim::run_realtime(*session, &logbook, id, seconds, [&](sim::Exchange& exchange) {
            exchange.surface.latest(); // a window would draw these
            exchange.tools_seen.latest();
            ++frames;
            std::this_thread::sleep_for(std::chrono::milliseconds(16));
            return true;
        });
    CHECK(frames > 10);
    CHECK(live.row.rig.dropped == 0);

    const auto recorded = logbook.attempt(id);
    REQUIRE(recorded);
    CHECK(recorded->ended);
    std::vector<tasks::Chunk> chunks;
    for (const auto& bytes : logbook.chunks(id))
        chunks.push_back(tasks::decode_chunk(bytes));
    const auto again_session = sim::session_of(*recorded);
    const sim::ReplayResult again =
        sim::run_replay(*again_session, *recorded, chunks, logbook.events(id));
    CHECK(again.worst_force_difference_n == 0.0);
    CHECK(again.outcome.row.log_sha256 == recorded->log_sha256);
    REQUIRE(again.outcome.metrics.size() == live.metrics.size());
    for (std::size_t i = 0; i < live.metrics.size(); ++i) {
        CHECK(again.outcome.metrics[i].value == live.metrics[i].value);
    }
    std::filesystem::remove_all(folder);
    return session;
}

} // namespace

TEST_CASE("real time: a threaded attempt replays to the same hash and the same score") {
    perform_and_replay("touch-points", "novice", 5.0);
    perform_and_replay("follow-path", "novice", 2.0);
}

TEST_CASE("real time: so does one with rays from an endoscope that an assistant holds") {
    // the expert has the flap in the jaws after 3 s
    const auto session = perform_and_replay("find-tubes", "expert", 5.0);
    CHECK(session->tissue.sight);
    CHECK(session->crew.camera);
}
