// sim/study/peer_program.h
// Starts a peer's program (tests/bench) and takes what it prints. A peer that is not there is a gap
// with a reason, no error: its library may be missing. Called by studies.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sim {

/// $TROCAR_PEERS, or where the build puts them.
std::filesystem::path peer_dir();

struct PeerOutput {
    std::string text; // its standard output
    std::string gap;  // not empty: why there is none
};

/// Waits until the program ends. Its complaints go to this program's.
PeerOutput run_peer_program(const std::filesystem::path& program,
                            const std::vector<std::string>& arguments);

} // namespace sim
