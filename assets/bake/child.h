// assets/bake/child.h
// Runs work in a child process with a time limit: the work may hang, crash or call exit, and the
// parent goes on. POSIX only. Called by tetrahedralise and by import_main, from the main thread.
#pragma once

#include <csignal>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace bake {

struct ChildAnswer {
    bool done = false;
    bool crashed = false;
    std::vector<std::byte> bytes; // what the work returned, if done
    std::string reason;           // why not, if not
    double seconds = 0.0;
};

/// `work` returns bytes, or throws std::exception whose text becomes the reason. It must not touch
/// files or threads of the parent. The child dies with its parent.
/// `stop`: ends the child when a signal handler has set it (looked at five times a second); the
/// child and its own children are then a process group of their own, and all of it ends.
ChildAnswer run_in_child(const std::function<std::vector<std::byte>()>& work, double limit_s,
                         const volatile std::sig_atomic_t* stop = nullptr);

} // namespace bake
