// tests/tasks/logbook_crash_test.cpp
// A recorder that is killed, and a disk that is full: children write, the parent looks at what is
// left. Linux only.
#include "tasks/logbook/sqlite.h"
#include "tests/tasks/logbook_samples.h"

#include <csignal>
#include <doctest/doctest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>

using tasks::Logbook;

namespace {

// About what a second of three tools takes; from attempt and number, so that the parent knows it.
std::vector<std::byte> chunk_bytes(std::int64_t attempt, std::int64_t number) {
    std::mt19937 random(static_cast<unsigned>(1000 * attempt + number));
    std::vector<std::byte> bytes(15'000 + random() % 5'000);
    for (std::byte& byte : bytes)
        byte = static_cast<std::byte>(random() & 0xff);
    return bytes;
}

std::int64_t begin(Logbook& book) {
    return book.begin_attempt(samples::attempt(book.add_session(samples::session())));
}

// An attempt of three chunks, ended.
std::int64_t whole_attempt(Logbook& book) {
    const std::int64_t id = begin(book);
    for (std::int64_t i = 0; i < 3; ++i)
        book.append_chunk(id, 1000 * i, chunk_bytes(id, i));
    book.append_events(id, std::vector<tasks::Event>(5));
    const std::vector<tasks::Metric> metrics{samples::metric("time", 3, "s")};
    book.end_attempt(id, samples::attempt(0), metrics);
    return id;
}

void check_whole(Logbook& book, std::int64_t id) {
    REQUIRE(book.attempt(id));
    CHECK(book.attempt(id)->ended);
    const auto chunks = book.chunks(id);
    REQUIRE(chunks.size() == 3);
    for (std::size_t i = 0; i < 3; ++i)
        CHECK(chunks[i] == chunk_bytes(id, static_cast<std::int64_t>(i)));
    CHECK(book.events(id).size() == 5);
    CHECK(book.metrics(id).size() == 1);
}

struct Report {
    std::int64_t attempt = 0, committed = 0; // chunks that append_chunk has returned from
};

// In the child: writes until killed, telling what is safe after each chunk.
[[noreturn]] void write_until_killed(const std::string& path, int pipe_end) {
    try {
        Logbook book(path);
        Report report{begin(book), 0};
        while (write(pipe_end, &report, sizeof report) == sizeof report) {
            book.append_chunk(report.attempt, 1000 * report.committed,
                              chunk_bytes(report.attempt, report.committed));
            ++report.committed;
        }
    } catch (...) {
    }
    _exit(1); // only reached if something is wrong; the parent sees that it was not killed
}

struct Killed {
    Report last;
    bool by_kill = false;
};

Killed kill_after(const std::string& path, int delay_us) {
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        close(ends[0]);
        write_until_killed(path, ends[1]);
    }
    close(ends[1]);
    Killed killed;
    REQUIRE(read(ends[0], &killed.last, sizeof killed.last) == sizeof killed.last); // it has begun
    usleep(static_cast<useconds_t>(delay_us));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    killed.by_kill = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
    while (read(ends[0], &killed.last, sizeof killed.last) == sizeof killed.last) {
    }
    close(ends[0]);
    return killed;
}

} // namespace

TEST_CASE("a recorder killed at any moment loses nothing that it reported as written") {
    const samples::Folder folder;
    const std::string path = folder.file("station.db");
    std::int64_t first = 0;
    {
        Logbook book(path);
        first = whole_attempt(book);
    }
    std::mt19937 random(20);
    std::int64_t most = 0;
    std::vector<Killed> kills;
    for (int round = 0; round < 20; ++round) {
        CAPTURE(round);
        kills.push_back(kill_after(path, static_cast<int>(random() % 60'000)));
        REQUIRE(kills.back().by_kill);

        Logbook book(path);
        check_whole(book, first);
        for (const Killed& killed : kills) { // this one and all before it
            const Report& report = killed.last;
            const auto attempt = book.attempt(report.attempt);
            REQUIRE(attempt);
            CHECK_FALSE(attempt->ended);
            CHECK_FALSE(attempt->valid);
            const auto chunks = book.chunks(report.attempt);
            const auto count = static_cast<std::int64_t>(chunks.size());
            // One more may have been written, but not yet reported.
            CHECK(count >= report.committed);
            CHECK(count <= report.committed + 1);
            for (std::int64_t i = 0; i < count; ++i)
                CHECK(chunks[static_cast<std::size_t>(i)] == chunk_bytes(report.attempt, i));
            most = std::max(most, count);
        }
        tasks::sqlite::Database raw(path);
        CHECK(raw.text("PRAGMA integrity_check", "check") == "ok");
        CHECK(raw.text("PRAGMA foreign_key_check", "check").empty());
    }
    CHECK(most > 0); // the kills did come while chunks were being written
}

TEST_CASE("a full disk is an error that names the file, and earlier attempts stay whole") {
    const samples::Folder folder;
    const std::string path = folder.file("station.db");
    std::int64_t earlier = 0;
    {
        Logbook book(path);
        earlier = whole_attempt(book);
    }
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{300'000, 300'000}; // bytes in any one file
        Report report;
        std::string message = "no error";
        try {
            Logbook book(path);
            if (setrlimit(RLIMIT_FSIZE, &limit) != 0)
                _exit(2);
            report.attempt = begin(book);
            for (; report.committed < 100; ++report.committed)
                book.append_chunk(report.attempt, 1000 * report.committed,
                                  chunk_bytes(report.attempt, report.committed));
        } catch (const tasks::LogbookError& error) {
            message = error.what();
        }
        const bool told =
            write(ends[1], &report, sizeof report) == sizeof report &&
            write(ends[1], message.data(), message.size()) == static_cast<ssize_t>(message.size());
        _exit(told ? 0 : 3);
    }
    close(ends[1]);
    Report report;
    REQUIRE(read(ends[0], &report, sizeof report) == sizeof report);
    std::string message(4096, '\0');
    const ssize_t got = read(ends[0], message.data(), message.size());
    message.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    CHECK(status == 0);
    CHECK(message.find(path + ": append chunk: ") == 0);
    MESSAGE("after " << report.committed << " chunks: " << message);

    Logbook book(path);
    check_whole(book, earlier);
    REQUIRE(book.attempt(report.attempt));
    CHECK(report.committed > 0);
    CHECK(static_cast<std::int64_t>(book.chunks(report.attempt).size()) == report.committed);
    whole_attempt(book); // with room again the logbook goes on
    CHECK(tasks::sqlite::Database(path).text("PRAGMA integrity_check", "check") == "ok");
}
