#include "assets/bake/child.h"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bake {
namespace {

using Clock = std::chrono::steady_clock;

enum : unsigned char { kDone = 1, kThrew = 2 };

void write_all(int fd, const void* data, std::size_t size) {
    const char* at = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t n = write(fd, at, size);
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n <= 0) {
            _exit(1); // the parent has gone
        }
        at += n;
        size -= static_cast<std::size_t>(n);
    }
}

[[noreturn]] void child_main(const std::function<std::vector<std::byte>()>& work, int fd) {
    // what the work prints is not the parent's output; no core files
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0) {
        dup2(nowhere, STDOUT_FILENO);
    }
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    try {
        const auto bytes = work();
        const unsigned char tag = kDone;
        write_all(fd, &tag, 1);
        write_all(fd, bytes.data(), bytes.size());
    } catch (const std::exception& e) {
        const unsigned char tag = kThrew;
        write_all(fd, &tag, 1);
        write_all(fd, e.what(), std::strlen(e.what()));
    }
    _exit(0); // no destructors, no exit handlers: they are the parent's
}

/// Reads until the child closes its end; false when the time is up or `stop` is set.
bool read_until(int fd, Clock::time_point end, const volatile std::sig_atomic_t* stop,
                std::vector<std::byte>& bytes) {
    constexpr double kLookAtStop_ms = 200.0;
    const double longest_ms = stop != nullptr ? kLookAtStop_ms : 1e6;
    for (;;) {
        const double left_s = std::chrono::duration<double>(end - Clock::now()).count();
        if (left_s <= 0.0 || (stop != nullptr && *stop != 0)) {
            return false;
        }
        pollfd wait{fd, POLLIN, 0};
        const int ready =
            poll(&wait, 1, static_cast<int>(std::min(std::ceil(left_s * 1e3), longest_ms)));
        if (ready <= 0) {
            continue; // time is looked at above; EINTR comes here too
        }
        std::byte buffer[1 << 16];
        const ssize_t n = read(fd, buffer, sizeof buffer);
        if (n > 0) {
            bytes.insert(bytes.end(), buffer, buffer + n);
        } else if (n == 0 || errno != EINTR) {
            return true;
        }
    }
}

} // namespace

ChildAnswer run_in_child(const std::function<std::vector<std::byte>()>& work, double limit_s,
                         const volatile std::sig_atomic_t* stop) {
    ChildAnswer answer;
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) {
        answer.reason = fmt::format("no pipe: {}", std::strerror(errno));
        return answer;
    }
    const auto start = Clock::now();
    const pid_t parent = getpid(), child = fork();
    if (child == 0) {
        close(ends[0]);
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != parent) {
            _exit(1); // it ended in between
        }
        if (stop != nullptr) {
            setpgid(0, 0);
        }
        child_main(work, ends[1]);
    }
    close(ends[1]);
    if (child < 0) {
        close(ends[0]);
        answer.reason = fmt::format("no child process: {}", std::strerror(errno));
        return answer;
    }

    const auto end =
        start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s));
    if (stop != nullptr) {
        setpgid(child, child); // here too: whoever comes first
    }
    const bool in_time = read_until(ends[0], end, stop, answer.bytes);
    if (!in_time) {
        kill(stop != nullptr ? -child : child, SIGKILL);
    }
    close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    answer.seconds = std::chrono::duration<double>(Clock::now() - start).count();

    answer.crashed = in_time && WIFSIGNALED(status);
    if (!in_time && stop != nullptr && *stop != 0) {
        answer.reason = "interrupted";
    } else if (!in_time) {
        answer.reason = fmt::format("not done within {} s", limit_s);
    } else if (WIFSIGNALED(status)) {
        answer.reason = fmt::format("crashed with signal {}", WTERMSIG(status));
    } else if (answer.bytes.empty()) {
        answer.reason = fmt::format("ended without an answer, exit code {}", WEXITSTATUS(status));
    } else if (answer.bytes.front() == std::byte{kThrew}) {
        answer.reason.assign(reinterpret_cast<const char*>(answer.bytes.data()) + 1,
                             answer.bytes.size() - 1);
    } else {
        answer.done = true;
        answer.bytes.erase(answer.bytes.begin());
    }
    if (!answer.done) {
        answer.bytes.clear();
    }
    return answer;
}

} // namespace bake
