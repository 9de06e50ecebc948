// tests/tasks/log_hash_test.cpp
// The hash of an attempt against log_hash_vector.py, and what it must and must not depend on.
#include "tests/tasks/logbook_samples.h"

#include <doctest/doctest.h>
#include <functional>
#include <limits>

namespace {

// The attempt of log_hash_vector.py.
struct Log {
    tasks::AttemptRow setup = samples::attempt(1);
    std::vector<tasks::TickTrace> ticks{2};
    std::vector<tasks::StepTrace> steps{2};
    std::vector<tasks::Event> events{2};
    std::vector<tasks::Metric> metrics{1};

    Log() {
        constexpr std::array<std::uint8_t, 3> kFlags{1 | 2, 4 | 8, 2 | 4};
        for (std::int32_t i = 0; i < 2; ++i) {
            tasks::TickTrace& row = ticks[static_cast<std::size_t>(i)];
            row.tick = 5 + i;
            row.adopted_step = i - 1;
            for (std::int32_t k = 0; k < 3; ++k)
                row.tool[static_cast<std::size_t>(k)] = {
                    .counts = {100 * k + 5 + i, -k, std::numeric_limits<std::int32_t>::max()},
                    .roll_counts = 7,
                    .jaw_counts = -8,
                    .force_mn = {900, 0, k},
                    .flags = kFlags[static_cast<std::size_t>(k)]};
        }
        steps[0].step = 3;
        steps[0].sample_tick = 4;
        steps[0].flags = 3;
        steps[1].step = 4;
        steps[1].sample_tick = 14;
        steps[1].flags = 2;
        events[0] = {1234, tasks::EventKind::over_force, 1, -1, {0.01, -0.25, -0.0}, 2.5};
        events[1] = {1300,      tasks::EventKind::completed,
                     -1,        -1,
                     {1, 2, 3}, -std::numeric_limits<double>::quiet_NaN()};
        metrics[0] = samples::metric("path_length.left", 0.1, "m");
        metrics[0].version = 2;
        metrics[0].felt = false;
        metrics[0].first_tick = 10;
    }

    std::string hash() const {
        tasks::LogHash hash;
        hash.add_setup(setup);
        for (const auto& row : ticks)
            hash.add(row);
        for (const auto& row : steps)
            hash.add(row);
        for (const auto& row : events)
            hash.add(row);
        for (const auto& row : metrics)
            hash.add(row);
        return hash.finish();
    }
};

std::string hash_after(const std::function<void(Log&)>& change) {
    Log log;
    change(log);
    return log.hash();
}

} // namespace

TEST_CASE("the log hash is the one that an independent program computes from the written layout") {
    // From: python3 tests/tasks/log_hash_vector.py (hashlib and struct).
    CHECK(tasks::LogHash().finish() ==
          "67f802cdd3df680362a6f64b31d9a76662a8aef90ee68bb26c9bfdd72e27f670");
    CHECK(Log().hash() == "1d24a066112c12ff7dfa95bc0b4ca230347df6f91dc6b3135bd59ea446b567dc");
    const auto with_scope = [](Log& log) {
        log.ticks[0].scope = {
            .counts = {1, -2, 3}, .camera_counts = 4, .optic_counts = -5, .flags = 2 | 8};
    };
    CHECK(hash_after(with_scope) ==
          "c583122eaf07711b8beab09fef92a68c0a930ca8d44480afd533d2598929207f");
}

TEST_CASE("ids, dates, durations, hands and results do not change the log hash") {
    const std::string before = Log().hash();
    CHECK(before == hash_after([](Log& log) {
              log.setup.id = 99;
              log.setup.session = 98;
              log.setup.trainee = "someone";
              log.setup.started_utc = "2031-01-01T00:00:00Z";
              log.setup.hands = "DB:7";
              log.setup.realtime = log.setup.completed = log.setup.valid = log.setup.ended = true;
              log.setup.log_sha256 = "x";
              log.setup.rig.tick_us_max = 400;
              log.steps[0].duration_us = 4321;
              log.steps[0].targets = 4;
              log.ticks[0].tool[1].force_mn = {1, 2, 3};
              log.ticks[0].tool[1].contact_um = {1, 2, 3};
              log.ticks[0].tool[1].flags ^= 1 | 8;
          }));
}

TEST_CASE("every hashed field changes the log hash") {
    const std::vector<std::function<void(Log&)>> changes{
        [](Log& log) { log.setup.exercise += "x"; },
        [](Log& log) { log.setup.exercise_text += "x"; },
        [](Log& log) { log.setup.scene_text += "x"; },
        [](Log& log) { log.setup.scene_hash += "x"; },
        [](Log& log) { log.setup.model += "x"; },
        [](Log& log) { log.setup.coupling += "x"; },
        [](Log& log) { log.setup.seed ^= 1; },
        [](Log& log) { log.setup.fem_hz += 1; },
        [](Log& log) { log.setup.forces_on = false; },
        [](Log& log) { log.setup.start_counts[2][1] += 1; },
        [](Log& log) { log.setup.start_counts.pop_back(); },
        [](Log& log) { log.ticks[1].tick += 1; },
        [](Log& log) { log.ticks[1].adopted_step += 1; },
        [](Log& log) { log.ticks[1].tool[2].counts[2] -= 1; },
        [](Log& log) { log.ticks[1].tool[2].roll_counts += 1; },
        [](Log& log) { log.ticks[1].tool[2].jaw_counts += 1; },
        [](Log& log) { log.ticks[1].tool[2].flags ^= 2; },
        [](Log& log) { log.ticks[1].tool[2].flags ^= 4; },
        [](Log& log) { log.ticks.pop_back(); },
        [](Log& log) { log.steps[1].step += 1; },
        [](Log& log) { log.steps[1].sample_tick += 1; },
        [](Log& log) { log.steps[1].flags ^= 1; },
        [](Log& log) { log.events[0].tick += 1; },
        [](Log& log) { log.events[0].kind = tasks::EventKind::wrong_role; },
        [](Log& log) { log.events[0].tool = 2; },
        [](Log& log) { log.events[0].target = 2; },
        [](Log& log) { log.events[0].place_m.y = std::nextafter(-0.25, 0.0); },
        [](Log& log) { log.events[0].value = std::nextafter(2.5, 3.0); },
        [](Log& log) { std::swap(log.events[0], log.events[1]); },
        [](Log& log) { log.metrics[0].id += "x"; },
        [](Log& log) { log.metrics[0].version += 1; },
        [](Log& log) { log.metrics[0].value = std::nextafter(0.1, 1.0); },
        [](Log& log) { log.metrics[0].unit = "mm"; },
        [](Log& log) { log.metrics[0].lower_is_better = false; },
        [](Log& log) { log.metrics[0].felt = true; },
        [](Log& log) { log.metrics[0].first_tick += 1; },
        [](Log& log) { log.metrics[0].last_tick += 1; }};
    std::vector<std::string> seen{Log().hash()};
    for (std::size_t i = 0; i < changes.size(); ++i) {
        CAPTURE(i);
        const std::string hash = hash_after(changes[i]);
        CHECK(std::find(seen.begin(), seen.end(), hash) == seen.end());
        seen.push_back(hash);
    }
}

TEST_CASE("moving a character from one text to the next changes the log hash") {
    CHECK(hash_after([](Log& log) { log.setup.model = "ab", log.setup.coupling = "c"; }) !=
          hash_after([](Log& log) { log.setup.model = "a", log.setup.coupling = "bc"; }));
}

TEST_CASE("how ticks and steps interleave on their way to the hash does not matter") {
    const Log log;
    tasks::LogHash hash;
    hash.add(log.metrics[0]);
    hash.add(log.steps[0]);
    hash.add(log.ticks[0]);
    hash.add(log.events[0]);
    hash.add(log.ticks[1]);
    hash.add(log.events[1]);
    hash.add_setup(log.setup);
    hash.add(log.steps[1]);
    CHECK(hash.finish() == log.hash());
    CHECK(hash.finish() == log.hash()); // asking does not change it
}

TEST_CASE("an attempt read back from the logbook has the hash of the attempt that was written") {
    const samples::Folder folder;
    Log log;
    tasks::Logbook book(folder.file("station.db"));
    log.setup.session = book.add_session(samples::session());
    const std::int64_t id = book.begin_attempt(log.setup);
    book.append_chunk(id, 5, tasks::encode_chunk(log.ticks, log.steps));
    book.append_events(id, log.events);
    book.end_attempt(id, log.setup, log.metrics);

    Log back;
    back.setup = *book.attempt(id);
    const tasks::Chunk chunk = tasks::decode_chunk(book.chunks(id).at(0));
    back.ticks = chunk.ticks;
    back.steps = chunk.steps;
    back.events = book.events(id);
    back.metrics = book.metrics(id);
    CHECK(back.hash() == log.hash());
}
