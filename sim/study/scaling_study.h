// sim/study/scaling_study.h
// trocar study scaling: what a contact query and a whole contact tick cost as the mesh grows, ours
// and the peers' side by side. Everybody does the same work, in turn, round after round, so that a
// busy or throttled machine hits all alike; what counts is the ratio within a round. Absolute times
// are this machine's.
#pragma once

#include "sim/study/contact_workload.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace sim {

/// All collision methods but brute force, which is there to be tested against.
std::vector<std::string> scaling_methods();

struct ScalingOptions {
    std::string shape = "organ"; // organ, sheet
    std::vector<std::string> sizes{"1k", "10k", "100k", "1M"};
    std::vector<std::string> methods = scaling_methods();
    std::vector<std::string> contacts{"ours"};          // whole ticks, besides the query alone
    std::vector<std::string> peers{"embree", "bullet"}; // programs PEER_peer
    std::filesystem::path peer_dir;
    int rounds = 3;
    double seconds = 10.0;
    std::uint64_t seed = 1;
    double radius_m = 0.002, reach_m = 0.010;
    Breathing breathing;
    int cold_every = 20; // of the contact ticks; 0: no cold times
};

/// Of contact ticks, hot unless said.
struct ScalingTimes {
    double mean_ns = 0.0, p50_ns = 0.0, p99_ns = 0.0;
    double cold_mean_ns = 0.0, cold_p50_ns = 0.0, cold_p99_ns = 0.0;
    double refit_ms = 0.0, build_ms = 0.0;
};

struct ScalingRow {
    std::string size, name; // name: METHOD, METHOD+CONTACT, or the peer's own
    int round = 0;
    std::size_t triangles = 0, contact_ticks = 0;
    ScalingTimes times;
    double distance_sum_m = 0.0; // of queries: the same work gives the same sum; 0: whole ticks
};

struct ScalingStudy {
    std::vector<ScalingRow> row; // in the order in which they were measured
    std::vector<std::pair<std::string, std::string>> gap; // peer, why it is missing; each once
    double clock_overhead_ns = 0.0;
    /// Names in the order of the first round.
    std::vector<std::string> names() const;
};

/// `progress` hears of each row. Throws std::invalid_argument on unknown names and bad numbers.
ScalingStudy run_scaling_study(const ScalingOptions& options,
                               const std::function<void(const ScalingRow&)>& progress);

/// Medians over the rounds, of one name at one size; all 0 if it has none.
ScalingTimes median_times(const ScalingStudy& study, const std::string& size,
                          const std::string& name);
/// The median over the rounds of this round's figure over the other's in the same round; 0: none.
ScalingTimes median_ratios(const ScalingStudy& study, const std::string& size,
                           const std::string& name, const std::string& over);
/// Whether all queries at a size, peers' included, found the same distances to 1e-5 (peers work in
/// float).
bool answers_agree(const ScalingStudy& study, const std::string& size);

/// Names and texts of scaling.csv (every row), scaling.svg (log-log) and scaling.md (tables of
/// medians, parameters, machine, gaps).
std::vector<std::pair<std::string, std::string>> scaling_files(const ScalingOptions& options,
                                                               const ScalingStudy& study);

} // namespace sim
