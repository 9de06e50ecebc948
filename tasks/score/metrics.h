// tasks/score/metrics.h
// Kinematic and force metrics as one fold: observe() keeps what is needed, finish() filters and
// computes. Definitions carry an id and a version; a change of formula is a new version.
#pragma once

#include "tasks/exercise/touch_points.h"

#include <optional>
#include <span>

namespace tasks {

struct Metric {
    std::string id; // "path_length", "path_length.left", "errors.over_force"
    int version = 1;
    double value = 0.0;
    std::string unit; // SI
    bool lower_is_better = true;
    bool felt = true;                           // false: forces were off, the number was not felt
    std::int64_t first_tick = 0, last_tick = 0; // samples it rests on
};

struct ScoreState {
    std::array<std::vector<glm::dvec3>, kTools> tip_m;   // 1 kHz
    std::array<std::vector<float>, kTools> force_n;      // length of the tip force
    std::array<std::vector<std::uint8_t>, kTools> flags; // 1 touching, 2 in view
    std::int64_t first_tick = 0, last_tick = -1;
};
void observe(ScoreState& score, const Observation& seen);

struct ScoreContext {
    double force_limit_n = 2.0;
    std::array<Role, kTools> role{Role::left, Role::right, Role::assist};
    std::vector<glm::dvec3> ideal_path_m; // per tool visits: targets in order, by role
    std::vector<Role> ideal_role;
    double target_radius_m = 3e-3;
    bool forces_on = true;
};

/// time, path_length, economy, ldlj, out_of_view, force_mean, force_peak, over_force, errors (and
/// by kind), combined and per role where metrics.md says so.
std::vector<Metric> finish(const ScoreState& score, const TouchProgress& progress,
                           const ScoreContext& context);

/// Log dimensionless jerk of a speed-defining path sampled at fs, unfiltered:
/// -ln( T^3 / v_peak^2 * integral (d2v/dt2)^2 dt ), T = N/fs (Balasubramanian et al. 2015).
std::optional<double> ldlj(std::span<const double> speed_mps, double fs_hz);

/// Zero-phase second-order Butterworth low pass (forward and backward), edges reflected.
std::vector<glm::dvec3> low_pass(std::span<const glm::dvec3> path_m, double fs_hz,
                                 double cutoff_hz);

} // namespace tasks
