// tests/sim/command_fixture.h
// The trocar program as a script sees it: what it was told, its exit code, what it printed.
#pragma once

#include <array>
#include <cstdio>
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <string>
#include <sys/wait.h>

namespace command_tests {

struct Answer {
    int exit_code = -1;
    std::string text;
};

/// Both streams, or only the first.
inline Answer trocar(const std::string& arguments, const char* errors = "2>&1") {
    const std::string command = std::string(TROCAR_BINARY) + " " + arguments + " " + errors;
    FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    Answer out;
    std::array<char, 4096> buffer{};
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
        out.text.append(buffer.data(), n);
    const int status = pclose(pipe);
    REQUIRE(WIFEXITED(status));
    out.exit_code = WEXITSTATUS(status);
    return out;
}

/// Of a command with --json that must succeed.
inline nlohmann::json json_of(const std::string& arguments) {
    const Answer answer = trocar(arguments, "");
    CAPTURE(arguments);
    REQUIRE(answer.exit_code == 0);
    return nlohmann::json::parse(answer.text);
}

} // namespace command_tests
