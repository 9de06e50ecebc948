// tests/sim/lockstep_test.cpp
// Whole attempts on the shipped scene: the same seed gives the same bits, a recording replays to
// them, and the recorded ticks give back the score exactly.
#include "sim/session/session.h"

#include <cstdio>
#include <doctest/doctest.h>
#include <filesystem>
#include <unistd.h>

namespace {

constexpr double kSeconds = 12.0;    // long enough for a touch, short enough for every build
constexpr double kSameSeconds = 8.0; // done three times for each exercise

constexpr const char* kExercises[] = {"touch-points", "follow-path", "find-tubes"};

// A novice's; of find-tubes an expert's, for in this time a novice has not yet lifted the flap.
sim::RunOptions short_run(std::uint64_t seed, const std::string& exercise = "touch-points") {
    sim::RunOptions options;
    options.exercise = exercise;
    options.seed = seed;
    options.hands = exercise == "find-tubes" ? "expert" : "novice";
    options.max_seconds = kSeconds;
    return options;
}

sim::Attempt::Outcome perform(const sim::RunOptions& options, tasks::Logbook* logbook = nullptr,
                              std::int64_t* id = nullptr) {
    const auto session = sim::make_session(options);
    std::int64_t attempt = 0;
    if (logbook) {
        tasks::AttemptRow row = sim::attempt_row(*session, false);
        row.session = logbook->add_session(sim::session_row("scripted"));
        attempt = *id = logbook->begin_attempt(row);
    }
    return sim::run_lockstep(*session, logbook, attempt);
}

struct TemporaryLog {
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("trocar_test_" + std::to_string(getpid()));
    std::string path() const { return (folder / "station.db").string(); }
    TemporaryLog() { std::filesystem::create_directories(folder); }
    ~TemporaryLog() { std::filesystem::remove_all(folder); }
};

// Short, but long enough to touch.
void replay_of(const std::string& exercise) {
    CAPTURE(exercise);
    const TemporaryLog log;
    tasks::Logbook logbook(log.path());
    std::int64_t id = 0;
    const sim::Attempt::Outcome live = perform(short_run(5, exercise), &logbook, &id);
    const auto row = logbook.attempt(id);
    REQUIRE(row);
    std::vector<tasks::Chunk> chunks;
    for (const auto& bytes : logbook.chunks(id))
        chunks.push_back(tasks::decode_chunk(bytes));
    const auto session = sim::session_of(*row);
    const sim::ReplayResult again = sim::run_replay(*session, *row, chunks, logbook.events(id));
    CHECK(again.worst_force_difference_n == 0.0);
    CHECK(again.first_difference_tick == -1);
    CHECK(again.outcome.row.log_sha256 == live.row.log_sha256);
}

void rescore_of(const std::string& kind) {
    CAPTURE(kind);
    const TemporaryLog log;
    tasks::Logbook logbook(log.path());
    std::int64_t id = 0;
    const sim::Attempt::Outcome live = perform(short_run(6, kind), &logbook, &id);
    const auto row = logbook.attempt(id);
    REQUIRE(row);
    const sim::Scene scene = sim::parse_scene(row->scene_text, "log");
    const tasks::Exercise exercise = tasks::parse_exercise(row->exercise_text, "log");
    sim::Attempt fold(scene, exercise, std::vector<tasks::Target>(tasks::places_of(exercise)), *row,
                      nullptr);
    for (const auto& bytes : logbook.chunks(id)) {
        const tasks::Chunk chunk = tasks::decode_chunk(bytes);
        for (const tasks::StepTrace& step : chunk.steps)
            fold.add(step);
        for (const tasks::TickTrace& tick : chunk.ticks)
            fold.add(tick);
    }
    const std::vector<tasks::Metric> again = fold.finish(row->rig).metrics;
    REQUIRE(again.size() == live.metrics.size());
    for (std::size_t i = 0; i < again.size(); ++i) {
        CHECK(again[i].id == live.metrics[i].id);
        CHECK(again[i].value == live.metrics[i].value);
    }
}

} // namespace

TEST_CASE("lockstep: the same seed gives the same hash, another seed another") {
    for (const char* exercise : kExercises) {
        CAPTURE(exercise);
        const auto hash_of = [&](std::uint64_t seed) {
            sim::RunOptions options = short_run(seed, exercise);
            options.max_seconds = kSameSeconds;
            return perform(options).row.log_sha256;
        };
        const std::string first = hash_of(3);
        CHECK(first == hash_of(3));
        CHECK(first != hash_of(4));
        CHECK(first.size() == 64);
    }
}

TEST_CASE("lockstep: the logbook says when an attempt began, and the hash does not") {
    const TemporaryLog log;
    tasks::Logbook logbook(log.path());
    std::int64_t id = 0;
    sim::RunOptions options = short_run(3);
    options.max_seconds = 1.0;
    const std::string hash = perform(options, &logbook, &id).row.log_sha256;
    const auto row = logbook.attempt(id);
    REQUIRE(row);
    CHECK(row->started_utc.size() == std::string("2026-01-01T00:00:00Z").size());
    CHECK(row->started_utc.back() == 'Z');
    CHECK(hash == perform(options).row.log_sha256); // begun at another moment
}

TEST_CASE("lockstep: no rig fault, and the tools do touch the tissue") {
    const sim::Attempt::Outcome outcome = perform(short_run(3));
    CHECK(outcome.row.valid);
    double force_peak = 0.0;
    for (const tasks::Metric& m : outcome.metrics) {
        if (m.id == "force_peak")
            force_peak = m.value;
    }
    CHECK(force_peak > 0.05);
}

TEST_CASE("replay: a recorded attempt gives the same hash and the same forces") {
    for (const char* exercise : kExercises)
        replay_of(exercise);
}

TEST_CASE("replay: another coupling moves the same way and feels different") {
    const TemporaryLog log;
    tasks::Logbook logbook(log.path());
    std::int64_t id = 0;
    perform(short_run(3), &logbook, &id);
    const auto row = logbook.attempt(id);
    REQUIRE(row);
    std::vector<tasks::Chunk> chunks;
    for (const auto& bytes : logbook.chunks(id))
        chunks.push_back(tasks::decode_chunk(bytes));
    const auto session = sim::session_of(*row);
    session->haptics.coupling = sim::Coupling::hold;
    const sim::ReplayResult held = sim::run_replay(*session, *row, chunks, logbook.events(id));
    CHECK(held.worst_force_difference_n > 0.01);
}

TEST_CASE("rescore: the recorded ticks alone give back every metric exactly") {
    for (const char* exercise : kExercises)
        rescore_of(exercise);
}

TEST_CASE("follow-path: an expert draws along the whole path, valid and without leaving it") {
    sim::RunOptions options;
    options.exercise = "follow-path";
    options.seed = 2;
    const sim::Attempt::Outcome outcome = perform(options);
    CHECK(outcome.row.completed);
    CHECK(outcome.row.valid);
    for (const tasks::Metric& m : outcome.metrics) {
        if (m.id == "errors")
            CHECK(m.value == 0.0);
        if (m.id == "path_coverage")
            CHECK(m.value > 0.95);
        if (m.id == "deviation_rms")
            CHECK(m.value < 2e-3);
    }
}
