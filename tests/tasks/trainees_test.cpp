// tests/tasks/trainees_test.cpp
// Names stand in their own file, under random ids, and leave no trace when deleted.
#include "tasks/logbook/uuid.h"
#include "tests/tasks/logbook_samples.h"

#include <doctest/doctest.h>
#include <fstream>
#include <iterator>
#include <set>

using tasks::Logbook;
using tasks::LogbookError;

namespace {

const std::string kName = "Zaphod Quetzalcoatl";

// True if any file of the folder holds the text.
bool on_disk(const samples::Folder& folder, const std::string& text) {
    for (const auto& entry : std::filesystem::directory_iterator(folder.file(""))) {
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        if (bytes.find(text) != std::string::npos)
            return true;
    }
    return false;
}

std::int64_t begin(Logbook& book, const std::string& trainee) {
    auto row = samples::attempt(book.add_session(samples::session()));
    row.trainee = trainee;
    return book.begin_attempt(row);
}

} // namespace

TEST_CASE("a trainee is a name in one file and an id in the other") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    const std::string id = book.add_trainee(kName);
    begin(book, id);
    begin(book, id);
    begin(book, "");
    book.add_trainee("Ada");
    const auto list = book.trainees();
    REQUIRE(list.size() == 2);
    CHECK(list[0].name == "Ada");
    CHECK(list[0].attempts == 0);
    CHECK(list[1].name == kName);
    CHECK(list[1].id == id);
    CHECK(list[1].attempts == 2);
    CHECK(std::filesystem::exists(folder.file("station.names.db")));
    std::filesystem::remove(folder.file("station.names.db"));
    CHECK_FALSE(on_disk(folder, kName));
}

TEST_CASE("a logbook without names is read without making a names file") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    begin(book, "");
    CHECK(book.attempts().size() == 1);
    CHECK_FALSE(std::filesystem::exists(folder.file("station.names.db")));
}

TEST_CASE("a deleted name is in no file any more and its attempts stay under the pseudonym") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    const std::string id = book.add_trainee(kName);
    const std::int64_t attempt = begin(book, id);
    CHECK(on_disk(folder, kName));
    CHECK(book.delete_trainee(kName, false));
    CHECK_FALSE(on_disk(folder, kName)); // while the logbook is still open
    CHECK(book.trainees().empty());
    CHECK(book.attempt(attempt)->trainee == id);
    CHECK_FALSE(book.delete_trainee(kName, false));
    CHECK_FALSE(book.delete_trainee(id, false));
}

TEST_CASE("deleting with attempts removes what the person did, and nobody else's") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    const std::string gone = book.add_trainee(kName);
    const std::string stays = book.add_trainee("Ada");
    const std::int64_t lost = begin(book, gone);
    const std::int64_t kept = begin(book, stays);
    const std::string motion = "recognisable motion";
    book.append_chunk(lost, 0, std::as_bytes(std::span(motion)));
    book.append_events(lost, std::vector<tasks::Event>(3));
    book.add_note(lost, 5, "recognisable note");
    CHECK(on_disk(folder, motion));

    CHECK(book.delete_trainee(gone, true));
    CHECK_FALSE(book.attempt(lost));
    CHECK(book.chunks(lost).empty());
    CHECK(book.events(lost).empty());
    CHECK(book.notes(lost).empty());
    CHECK_FALSE(on_disk(folder, motion));
    CHECK_FALSE(on_disk(folder, "recognisable note"));
    CHECK(book.attempt(kept));
    CHECK(begin(book, stays) > kept); // and no id comes again
}

TEST_CASE("attempts of a forgotten name can still be deleted by id") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    const std::string id = book.add_trainee(kName);
    begin(book, id);
    CHECK(book.delete_trainee(id, false));
    CHECK(book.delete_trainee(id, true));
    CHECK(book.attempts().empty());
}

TEST_CASE("names must tell people apart, from ids too, and stand on one line") {
    const samples::Folder folder;
    Logbook book(folder.file("station.db"));
    const std::string id = book.add_trainee(kName);
    CHECK_THROWS_WITH_AS(book.add_trainee(kName), doctest::Contains(id.c_str()), LogbookError);
    CHECK_THROWS_AS(book.add_trainee(""), LogbookError);
    CHECK_THROWS_AS(book.add_trainee(id), LogbookError);
    CHECK_THROWS_AS(book.add_trainee("red\x1b[31m"), LogbookError);
    CHECK_THROWS_AS(book.add_trainee("two\nlines"), LogbookError);
    CHECK(book.trainees().size() == 1);
    CHECK(tasks::is_uuid(book.add_trainee("O'Brien; DROP TABLE trainee")));
    CHECK(book.trainees().size() == 2);
}

TEST_CASE("ids are random UUIDs of version 4 and do not repeat") {
    std::set<std::string> seen;
    for (int i = 0; i < 1000; ++i) {
        const std::string id = tasks::random_uuid();
        CHECK(tasks::is_uuid(id));
        CHECK(id[14] == '4');
        CHECK(std::string("89ab").find(id[19]) != std::string::npos);
        seen.insert(id);
    }
    CHECK(seen.size() == 1000);
    CHECK_FALSE(tasks::is_uuid("00000000-0000-4000-8000-00000000000G"));
    CHECK_FALSE(tasks::is_uuid("00000000-0000-4000-8000-0000000000000"));
    CHECK_FALSE(tasks::is_uuid("000000000000-4000-8000-0000-000000000"));
}
