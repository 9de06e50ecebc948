// tests/tasks/schema_test.cpp
// Opening files of other versions and kinds: old ones are brought up to date whole or not at all,
// newer and foreign ones are left as they are.
#include "tasks/logbook/schema.h"

#include "tests/tasks/logbook_samples.h"

#include <doctest/doctest.h>
#include <fstream>
#include <iterator>

using tasks::LogbookError;
using tasks::sqlite::Database;

namespace {

std::string content(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

constexpr std::int32_t kKind = 0x54455354;

// A file from before versions were counted: user_version 0, but with a table and a row.
void make_v0(const std::string& path) {
    Database file(path);
    file.run("CREATE TABLE run (who TEXT, seconds REAL); INSERT INTO run VALUES ('ada', 1.5);"
             "PRAGMA application_id = 1413829460",
             "make v0");
}

constexpr tasks::Migration kGood[] = {
    {1, "ALTER TABLE run RENAME TO attempt; ALTER TABLE attempt ADD COLUMN milliseconds INTEGER"},
    {2, "UPDATE attempt SET milliseconds = CAST(seconds * 1000 AS INTEGER);"
        "ALTER TABLE attempt DROP COLUMN seconds"}};
constexpr tasks::Migration kBroken[] = {kGood[0], {2, "UPDATE attempt SET nothing_like_this = 1"}};

} // namespace

TEST_CASE("an old database is walked through every version and keeps its rows") {
    const samples::Folder folder;
    make_v0(folder.file("old.db"));
    static_assert(kKind == 1413829460);
    Database file(folder.file("old.db"));
    tasks::migrate(file, {"test file", kKind, kGood});
    CHECK(file.text("SELECT who FROM attempt", "read") == "ada");
    CHECK(file.integer("SELECT milliseconds FROM attempt", "read") == 1500);
    CHECK(file.integer("PRAGMA user_version", "read") == 2);
    CHECK(file.text("SELECT group_concat(version) FROM migration", "read") == "1,2");
    tasks::migrate(file, {"test file", kKind, kGood}); // again: nothing to do
    CHECK(file.integer("SELECT count(*) FROM migration", "read") == 2);
}

TEST_CASE("a migration may start in the middle") {
    const samples::Folder folder;
    make_v0(folder.file("old.db"));
    Database file(folder.file("old.db"));
    tasks::migrate(file, {"test file", kKind, std::span(kGood).first(1)});
    CHECK(file.integer("PRAGMA user_version", "read") == 1);
    tasks::migrate(file, {"test file", kKind, kGood});
    CHECK(file.integer("SELECT milliseconds FROM attempt", "read") == 1500);
}

TEST_CASE("a migration that fails at its second step leaves the file as it was") {
    const samples::Folder folder;
    make_v0(folder.file("old.db"));
    const std::string before = content(folder.file("old.db"));
    {
        Database file(folder.file("old.db"));
        CHECK_THROWS_WITH_AS(tasks::migrate(file, {"test file", kKind, kBroken}),
                             doctest::Contains("migrate to schema 2: no such column"),
                             LogbookError);
    }
    CHECK(content(folder.file("old.db")) == before);
}

TEST_CASE("a logbook made by a newer Trocar is refused, says so, and stays as it was") {
    const samples::Folder folder;
    const std::string path = folder.file("station.db");
    { tasks::Logbook book(path); }
    Database(path).run("PRAGMA user_version = 1000", "pretend");
    const std::string before = content(path);
    CHECK_THROWS_WITH_AS(tasks::Logbook{path},
                         doctest::Contains("made by a newer Trocar: schema 1000"), LogbookError);
    CHECK(content(path) == before);
}

TEST_CASE("a database of another program is refused and stays as it was") {
    const samples::Folder folder;
    const std::string path = folder.file("photos.db");
    Database(path).run("CREATE TABLE photo (id INTEGER)", "make");
    const std::string before = content(path);
    CHECK_THROWS_WITH_AS(tasks::Logbook{path}, doctest::Contains("not a Trocar logbook"),
                         LogbookError);
    CHECK(content(path) == before);
}

TEST_CASE("a names file is not taken for a logbook") {
    const samples::Folder folder;
    tasks::Logbook(folder.file("station.db")).add_trainee("Ada");
    CHECK_THROWS_AS(tasks::Logbook{folder.file("station.names.db")}, LogbookError);
}

TEST_CASE("a new logbook has the newest schema, keeps references and uses a write-ahead log") {
    const samples::Folder folder;
    { tasks::Logbook book(folder.file("station.db")); }
    Database file(folder.file("station.db"));
    CHECK(file.integer("PRAGMA user_version", "read") == tasks::kLogbookSchema.version());
    CHECK(file.text("PRAGMA journal_mode", "read") == "wal");
    CHECK(file.integer("PRAGMA foreign_keys", "read") == 1);
    CHECK_THROWS_AS(file.run("INSERT INTO note (attempt, tick, text) VALUES (9, 0, 'x')", "note"),
                    LogbookError);
}
