// tests/tasks/logbook_test.cpp
// Sessions, attempts, events, metrics and notes: what goes in comes out, and what may not go in is
// refused with file, action and reason.
#include "tests/tasks/logbook_samples.h"

#include <doctest/doctest.h>
#include <fstream>
#include <limits>

using tasks::Logbook;
using tasks::LogbookError;

namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
    const auto view = std::as_bytes(std::span(text.data(), text.size()));
    return {view.begin(), view.end()};
}

void check_same_beginning(const tasks::AttemptRow& a, const tasks::AttemptRow& b) {
    CHECK(a.session == b.session);
    CHECK(a.trainee == b.trainee);
    CHECK(a.exercise == b.exercise);
    CHECK(a.exercise_text == b.exercise_text);
    CHECK(a.scene_text == b.scene_text);
    CHECK(a.scene_hash == b.scene_hash);
    CHECK(a.model == b.model);
    CHECK(a.coupling == b.coupling);
    CHECK(a.hands == b.hands);
    CHECK(a.seed == b.seed);
    CHECK(a.fem_hz == b.fem_hz);
    CHECK(a.realtime == b.realtime);
    CHECK(a.forces_on == b.forces_on);
    CHECK(a.started_utc == b.started_utc);
    CHECK(a.start_counts == b.start_counts);
}

} // namespace

TEST_CASE("an attempt comes back complete, with its result only after it has ended") {
    const samples::Folder folder;
    const std::string path = folder.file("station.db");
    tasks::AttemptRow row;
    std::int64_t id = 0;
    {
        Logbook book(path);
        row = samples::attempt(book.add_session(samples::session()));
        row.trainee = book.add_trainee("Ada");
        row.forces_on = false;
        row.realtime = true;
        id = book.begin_attempt(row);
        const auto running = book.attempt(id);
        REQUIRE(running);
        check_same_beginning(*running, row);
        CHECK_FALSE(running->ended);
        CHECK_FALSE(running->valid);
        CHECK(running->log_sha256.empty());

        row.completed = true;
        row.valid = true;
        row.log_sha256 = "abc";
        row.rig.tick_us_p9999 = 321.5;
        row.rig.missed = 3;
        row.rig.energy_min_j = -1.25e-4;
        row.rig.faults = {"device 2: silent for 7 ms"};
        book.end_attempt(id, row, {});
    }
    Logbook book(path);
    const auto ended = book.attempt(id);
    REQUIRE(ended);
    check_same_beginning(*ended, row);
    CHECK(ended->id == id);
    CHECK(ended->ended);
    CHECK(ended->completed);
    CHECK(ended->valid);
    CHECK(ended->log_sha256 == "abc");
    CHECK(ended->rig.tick_us_p9999 == 321.5);
    CHECK(ended->rig.missed == 3);
    CHECK(ended->rig.energy_min_j == -1.25e-4);
    CHECK(ended->rig.faults == row.rig.faults);
    CHECK(book.attempts().size() == 1);
    CHECK(book.session(row.session)->dispatch == "AVX2");
    CHECK_FALSE(book.attempt(id + 1));
    CHECK_FALSE(book.session(row.session + 1));
}

TEST_CASE("chunks come back in the order of their ticks, byte for byte") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    const auto id = book.begin_attempt(samples::attempt(book.add_session(samples::session())));
    book.append_chunk(id, 1000, bytes_of(std::string_view("b\0\xff", 3)));
    book.append_chunk(id, 0, bytes_of("a"));
    book.append_chunk(id, 2000, {});
    CHECK(book.chunks(id) == std::vector<std::vector<std::byte>>{
                                 bytes_of("a"), bytes_of(std::string_view("b\0\xff", 3)), {}});
    CHECK_THROWS_AS(book.append_chunk(id, 1000, bytes_of("again")), LogbookError);
    CHECK(book.chunks(id).size() == 3);
    CHECK(book.chunks(id + 1).empty());
}

TEST_CASE("events and metrics come back in their order, to the last bit, NaN as NaN") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    const auto row = samples::attempt(book.add_session(samples::session()));
    const auto id = book.begin_attempt(row);
    const double third = 1.0 / 3.0;
    const std::vector<tasks::Event> events{
        {30, tasks::EventKind::contact_end, 2, 15, {third, -1e-300, 1e300}, third},
        {20,
         tasks::EventKind::rig_fault,
         -1,
         -1,
         {0, 0, 0},
         std::numeric_limits<double>::quiet_NaN()}};
    book.append_events(id, std::span(events).first(1));
    book.append_events(id, std::span(events).last(1));
    const std::vector<tasks::Metric> metrics{
        samples::metric("time", third, "s"),
        samples::metric("ldlj", std::numeric_limits<double>::infinity(), "1"),
        samples::metric("bimanual", std::numeric_limits<double>::quiet_NaN(), "1")};
    book.end_attempt(id, row, metrics);

    const auto events_back = book.events(id);
    REQUIRE(events_back.size() == 2);
    CHECK(events_back[0].tick == 30);
    CHECK(events_back[0].kind == tasks::EventKind::contact_end);
    CHECK(events_back[0].tool == 2);
    CHECK(events_back[0].target == 15);
    CHECK(events_back[0].place_m == events[0].place_m);
    CHECK(events_back[0].value == third);
    CHECK(events_back[1].tool == -1);
    CHECK(std::isnan(events_back[1].value));

    const auto metrics_back = book.metrics(id);
    REQUIRE(metrics_back.size() == 3);
    CHECK(metrics_back[0].id == "time");
    CHECK(metrics_back[0].value == third);
    CHECK(metrics_back[0].unit == "s");
    CHECK(metrics_back[0].last_tick == 999);
    CHECK(std::isinf(metrics_back[1].value));
    CHECK(std::isnan(metrics_back[2].value));
}

TEST_CASE("an attempt that has ended is closed, and one that never began does not exist") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    const auto row = samples::attempt(book.add_session(samples::session()));
    const auto id = book.begin_attempt(row);
    book.end_attempt(id, row, {});
    const std::vector<tasks::Event> one(1);
    for (const std::int64_t closed : {id, id + 7}) {
        CHECK_THROWS_AS(book.append_chunk(closed, 0, {}), LogbookError);
        CHECK_THROWS_AS(book.append_events(closed, one), LogbookError);
        CHECK_THROWS_AS(book.end_attempt(closed, row, {}), LogbookError);
    }
    CHECK_THROWS_AS(book.add_note(id + 7, 0, "?"), LogbookError);
}

TEST_CASE("an end that fails in the middle leaves the attempt running and no metric behind") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    const auto row = samples::attempt(book.add_session(samples::session()));
    const auto id = book.begin_attempt(row);
    const std::vector<tasks::Metric> twice{samples::metric("time", 1, "s"),
                                           samples::metric("time", 2, "s")};
    CHECK_THROWS_AS(book.end_attempt(id, row, twice), LogbookError);
    CHECK(book.metrics(id).empty());
    CHECK_FALSE(book.attempt(id)->ended);
    book.end_attempt(id, row, std::span(twice).first(1)); // and the logbook still works
    CHECK(book.metrics(id).size() == 1);
}

TEST_CASE("an error names the file, the action and the reason of the database") {
    const samples::Folder folder;
    const std::string path = folder.file("station.db");
    Logbook book(path);
    CHECK_THROWS_WITH_AS(
        book.begin_attempt(samples::attempt(12345)),
        (path + ": begin attempt: FOREIGN KEY constraint failed (SQLite 787)").c_str(),
        LogbookError);
    auto session = samples::session();
    session.input_class = "trackball";
    CHECK_THROWS_WITH_AS(book.add_session(session), doctest::Contains("input_class"), LogbookError);
    const std::string nowhere = folder.file("missing/station.db");
    CHECK_THROWS_WITH_AS(Logbook{nowhere}, doctest::Contains(nowhere.c_str()), LogbookError);
}

TEST_CASE("a file that is not a database is refused by name") {
    const samples::Folder folder;
    const std::string path = folder.file("letter.txt");
    std::ofstream(path) << std::string(5000, 'x');
    CHECK_THROWS_WITH_AS(Logbook{path}, doctest::Contains("not a database"), LogbookError);
}

TEST_CASE("a name cannot slip into the logbook as a trainee") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    auto row = samples::attempt(book.add_session(samples::session()));
    row.trainee = "Ada Lovelace";
    CHECK_THROWS_WITH_AS(book.begin_attempt(row), doctest::Contains("by id"), LogbookError);
    CHECK(book.attempts().empty());
}

TEST_CASE("notes are listed by tick with the time they were written") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    const auto id = book.begin_attempt(samples::attempt(book.add_session(samples::session())));
    book.add_note(id, 2000, "late");
    const auto first = book.add_note(id, 10, "early; '); DROP TABLE note; --");
    const auto notes = book.notes(id);
    REQUIRE(notes.size() == 2);
    CHECK(notes[0].id == first);
    CHECK(notes[0].attempt == id);
    CHECK(notes[0].tick == 10);
    CHECK(notes[0].text == "early; '); DROP TABLE note; --");
    CHECK(notes[0].written_utc.size() == std::string("2026-01-02T03:04:05Z").size());
    CHECK(notes[1].text == "late");
}

TEST_CASE("a reader sees a running attempt while the recorder writes it") {
    const samples::Folder folder;
    Logbook recorder(folder.file("station.db"));
    Logbook reader(folder.file("station.db"));
    const auto id =
        recorder.begin_attempt(samples::attempt(recorder.add_session(samples::session())));
    recorder.append_chunk(id, 0, bytes_of("x"));
    CHECK(reader.chunks(id).size() == 1);
}

TEST_CASE("a logbook can be moved") {
    const samples::Folder folder;
    Logbook first(folder.file("station.db"));
    Logbook second(std::move(first));
    CHECK(second.attempts().empty());
}
