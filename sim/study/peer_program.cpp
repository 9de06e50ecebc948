#include "sim/study/peer_program.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace sim {
namespace {

std::string all_of(int from) {
    std::string out;
    std::array<char, 4096> buffer{};
    for (;;) {
        const ssize_t n = read(from, buffer.data(), buffer.size());
        if (n > 0)
            out.append(buffer.data(), static_cast<std::size_t>(n));
        else if (n == 0 || errno != EINTR)
            return out;
    }
}

int exit_code_of(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace

std::filesystem::path peer_dir() {
    const char* set = std::getenv("TROCAR_PEERS");
    return set != nullptr && *set != '\0' ? set : TROCAR_PEERS;
}

PeerOutput run_peer_program(const std::filesystem::path& program,
                            const std::vector<std::string>& arguments) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(program, error))
        return {"", fmt::format("{} is not there: its library was missing when this was built, "
                                "the target was not built, or its setup in tests/bench not run",
                                program.string())};
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0)
        return {"", fmt::format("no pipe: {}", std::strerror(errno))};
    std::vector<std::string> words{program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& w : words)
        argv.push_back(w.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addclose(&actions, ends[1]);
    pid_t child = 0;
    const int failed =
        posix_spawn(&child, words[0].c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    PeerOutput out;
    if (failed != 0)
        out.gap = fmt::format("{} does not start: {}", program.string(), std::strerror(failed));
    else
        out.text = all_of(ends[0]);
    close(ends[0]);
    if (failed == 0)
        if (const int code = exit_code_of(child); code != 0)
            out.gap = fmt::format("{} ended with {}", program.string(), code);
    return out;
}

} // namespace sim
