// tests/sim/kill_test.cpp
// kill -9 at random moments of a real-time attempt: the logbook opens, earlier attempts are whole,
// and at most the last second of the running one is missing.
#include "tasks/logbook/logbook.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <random>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace {

using Clock = std::chrono::steady_clock;

pid_t start(const char* exercise, const std::string& log) {
    const pid_t child = fork();
    if (child != 0)
        return child;
    if (!std::freopen("/dev/null", "w", stdout))
        _exit(3);
    execl(TROCAR_BINARY, TROCAR_BINARY, "run", exercise, "--realtime", "--seconds", "60", "--log",
          log.c_str(), static_cast<char*>(nullptr));
    _exit(4);
}

std::size_t recorded_ticks(tasks::Logbook& logbook, std::int64_t attempt) {
    std::size_t ticks = 0;
    for (const auto& bytes : logbook.chunks(attempt)) {
        ticks += tasks::decode_chunk(bytes).ticks.size();
    }
    return ticks;
}

} // namespace

TEST_CASE("kill -9: at 20 random moments nothing but the last second is lost") {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("trocar_kill_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::string log = (folder / "station.db").string();
    tasks::Logbook watcher(log); // the station's reader, open all the time
    std::mt19937_64 random(7);
    std::vector<std::size_t> whole; // ticks of each earlier attempt, as first seen
    for (int round = 0; round < 20; ++round) {
        constexpr const char* kExercises[] = {"touch-points", "follow-path", "find-tubes"};
        const pid_t child = start(kExercises[round % 3], log);
        REQUIRE(child > 0);
        const auto patience = Clock::now() + std::chrono::seconds(60);
        while (watcher.attempts().size() == whole.size() && Clock::now() < patience) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        const auto begun = Clock::now();
        REQUIRE(watcher.attempts().size() == whole.size() + 1);
        std::this_thread::sleep_for(std::chrono::milliseconds(100 + random() % 2500));
        REQUIRE(kill(child, SIGKILL) == 0);
        const double ran_s = std::chrono::duration<double>(Clock::now() - begun).count();
        waitpid(child, nullptr, 0);

        tasks::Logbook logbook(log); // as the next start of the station opens it
        const auto attempts = logbook.attempts();
        for (std::size_t i = 0; i < whole.size(); ++i) {
            CHECK(recorded_ticks(logbook, attempts[i].id) == whole[i]);
        }
        CHECK_FALSE(attempts.back().ended);
        const std::size_t ticks = recorded_ticks(logbook, attempts.back().id);
        // one second of ticks may wait for its chunk; threads start, discs and schedulers dawdle
        constexpr double kSlack_s = 0.5;
        CHECK(1e-3 * static_cast<double>(ticks) > ran_s - 1.0 - kSlack_s);
        whole.push_back(ticks);
    }
    CHECK(whole.size() == 20);
    std::filesystem::remove_all(folder);
}
