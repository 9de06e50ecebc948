// tests/bench/peer.h
// What the peers' programs share: the command line, the run over a built-in contact workload, and
// the one JSON object at its end. A peer only says how to make, move and ask its own structure.
// Single-threaded. Metres.
#pragma once

#include "sim/study/contact_workload.h"
#include "sim/study/tick_times.h"

#include <functional>
#include <nlohmann/json.hpp>

namespace bench {

/// Of: PROGRAM organ:10k [--seconds S] [--seed N] [--radius MM] [--reach MM] [--breathe MM]
/// [--wave radial|travelling] [--cold] [--cold-every N]
struct PeerOptions {
    std::string mesh;
    double seconds = 10.0;
    std::uint64_t seed = 1;
    double radius_m = 0.002; // of the ball
    double reach_m = 0.010;  // initial radius of a closest-point query
    sim::Breathing breathing;
    bool cold = false;
    int cold_every = 20; // of the contact ticks
};

/// Throws std::invalid_argument saying what is accepted.
PeerOptions peer_options(int argc, char** argv);

/// What a peer answers to one question. `distance_m`: from the place to the skin that it found.
struct PeerAnswer {
    bool hit = false;
    double distance_m = 0.0;
};

struct Peer {
    std::string name;
    bool closest = true; // its question is the closest point, so that its distances can be compared
    std::function<void(const haptics::MeshView&)> take; // new places into its own form; not timed
    std::function<void()> refit;                        // to what it took
    std::function<PeerAnswer(const glm::dvec3&)> ask;   // what is timed
};

/// Runs the path once, hot; and once more with the caches evicted before every `cold_every`th
/// contact tick if asked. A contact tick is one in which the centre is within or beyond the skin,
/// or within the ball's radius of it. `distance_sum_m` over the contact ticks, of closest points:
/// two programs that did the same work agree on it. `missed`: contact ticks without an answer.
nlohmann::ordered_json run_peer(const PeerOptions& options, const sim::ContactWorkload& work,
                                const std::function<Peer(const haptics::MeshView&)>& make);

/// main() of a peer: options, work, the object that `json` makes of them; 2 on bad input.
int peer_main(int argc, char** argv,
              const std::function<nlohmann::ordered_json(const PeerOptions&,
                                                         const sim::ContactWorkload&)>& json);

} // namespace bench
