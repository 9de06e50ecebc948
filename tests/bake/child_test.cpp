#include "assets/bake/child.h"

#include <chrono>
#include <csignal>
#include <doctest/doctest.h>
#include <stdexcept>
#include <thread>
#include <unistd.h>

TEST_CASE("child: what the work returns arrives whole") {
    std::vector<std::byte> sent(3'000'000);
    for (std::size_t i = 0; i < sent.size(); ++i) {
        sent[i] = static_cast<std::byte>(i * 7 & 0xFF);
    }
    const auto answer = bake::run_in_child([&] { return sent; }, 60.0);
    CHECK(answer.done);
    CHECK(answer.bytes == sent);
}

TEST_CASE("child: an exception is the reason") {
    const auto answer = bake::run_in_child(
        []() -> std::vector<std::byte> { throw std::runtime_error("too thin"); }, 60.0);
    CHECK_FALSE(answer.done);
    CHECK(answer.reason == "too thin");
}

TEST_CASE("child: a crash is reported with its signal and leaves the parent alive") {
    const auto answer = bake::run_in_child(
        []() -> std::vector<std::byte> {
            std::signal(SIGABRT, SIG_DFL);
            raise(SIGKILL);
            return {};
        },
        60.0);
    CHECK_FALSE(answer.done);
    CHECK(answer.reason == "crashed with signal 9");
}

TEST_CASE("child: an exit without an answer is reported") {
    const auto answer = bake::run_in_child([]() -> std::vector<std::byte> { _exit(3); }, 60.0);
    CHECK_FALSE(answer.done);
    CHECK(answer.reason == "ended without an answer, exit code 3");
}

TEST_CASE("child: work that hangs is killed at its time limit") {
    const auto answer = bake::run_in_child(
        []() -> std::vector<std::byte> {
            for (;;) {
                std::this_thread::sleep_for(std::chrono::seconds(1));
            }
        },
        0.2);
    CHECK_FALSE(answer.done);
    CHECK(answer.reason == "not done within 0.2 s");
    CHECK(answer.seconds >= 0.2);
    CHECK(answer.seconds < 20.0); // it does not wait for the work
}

TEST_CASE("child: what the work changes does not reach the parent") {
    int value = 1;
    bake::run_in_child(
        [&] {
            value = 2;
            return std::vector<std::byte>{};
        },
        60.0);
    CHECK(value == 1);
}
