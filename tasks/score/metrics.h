// tasks/score/metrics.h
// Kinematic and force metrics as one fold: observe() keeps what is needed, finish() filters and
// computes. Definitions carry an id and a version; a change of formula is a new version.
#pragma once

#include "tasks/exercise/progress.h"

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

/// A metric as its definition has it. Throws std::logic_error for an id without one.
Metric defined_metric(std::string id, double value, bool forces_on, std::int64_t first_tick,
                      std::int64_t last_tick);

/// 61 bytes per tool and tick, 32 beside: 130 MB for ten minutes of three tools, and up to twice
/// that while the vectors grow.
struct ScoreState {
    std::array<std::vector<glm::dvec3>, kTools> tip_m;     // 1 kHz
    std::array<std::vector<glm::vec3>, kTools> shaft;      // unit, handle to tip
    std::array<std::vector<float>, kTools> insertion_m;    // along the shaft
    std::array<std::vector<float>, kTools> roll_rad;       // about the shaft
    std::array<std::vector<glm::vec3>, kTools> force_on_n; // on the tip
    std::array<std::vector<float>, kTools> force_n;        // its length
    std::array<std::vector<std::uint8_t>, kTools> flags;   // 1 touching, 2 in view, 4 present
    std::vector<glm::dvec3> eye_m;  // of the endoscope; empty if the picture is fixed
    std::vector<float> horizon_rad; // as long
    std::vector<float> stress_pa;   // largest in the tissue
    std::int64_t first_tick = 0, last_tick = -1;
};
/// One millisecond. Ticks follow each other: a paused attempt's ticks stand still. Pure, resumable.
void observe(ScoreState& score, const Observation& seen);

struct ScoreContext {
    double force_limit_n = 2.0;
    std::array<Role, kTools> role{Role::left, Role::right, Role::assist};
    // Where a tip has to be for each target of the exercise, in order, at rest, and which role
    // goes there: the surface place plus the tip's radius along the normal.
    std::vector<glm::dvec3> ideal_path_m;
    std::vector<Role> ideal_role;
    double target_radius_m = 3e-3; // tolerance ball about each place
    bool forces_on = true;
};

/// All metrics, over first movement .. completion (or the last sample), each as definition.h has
/// it. Derivatives are of the 10 Hz low-passed motion. Version 1 of:
///   time                    s; 0 if nothing moved
///   path_length*            m
///   economy*                ideal / path_length, 0..1; ideal = shortest tour from the tip's place
///                           at the first movement through the balls of the targets touched so
///                           far, straight through obstacles; 0 if nothing was touched
///   retraction_length*      retraction_tour_m (ideal_path.h) of the same / path_length; may
///                           exceed 1; 0 if nothing was touched
///   depth_length*           m, sum of |changes of insertion|
///   angular_path*, roll_path*   rad, sums of changes of the shaft's direction, of the roll
///   speed_mean*, accel_mean*, idle*   m/s; m/s2; share of time below 2 mm/s (combined: mean of
///                           the tools)
///   ldlj*, sparc*           median over sub-movements (smoothness.h); absent without any
///   jerk_norm*              smoothness.h, over the whole time (combined: lengths and integrals
///                           added); absent below a millimetre of path
///   bimanual                correlation of left and right tip speed while both move at 2 mm/s or
///                           more; absent if that is not defined
///   out_of_view*            share of tool ticks
///   force_mean*, force_peak*, impulse*   N, N, N s over contact ticks; 0 without contact
///   work*                   J, integral of max(0, F . v) over contact ticks; F on the tissue
///   over_force*             s above the limit (combined: any tool above it), unfiltered
///   path_length.scope       m, of the endoscope's eye; with the next two absent if it is fixed
///   horizon_rms             rad, of the picture's turn against a level one
///   horizon_over            share of time above 15 degrees
///   stress_peak             Pa, largest von Mises stress in any element of any organ
///   over_force_episodes, errors, errors.KIND for every kind of error   counts, from the events
/// * also per role, as id.left, id.right, id.assist, for tools that were present.
std::vector<Metric> finish(const ScoreState& score, const Progress& progress,
                           const ScoreContext& context);

/// Log dimensionless jerk of a speed-defining path sampled at fs, unfiltered:
/// -ln( T^3 / v_peak^2 * integral (d2v/dt2)^2 dt ), T = N/fs (Balasubramanian et al. 2015).
/// Nothing for fewer than 3 samples, rest, or motion without any jerk.
std::optional<double> ldlj(std::span<const double> speed_mps, double fs_hz);

/// Zero-phase second-order Butterworth low pass (forward and backward: gain 1/2 at the cut-off),
/// reflected through the end points, so that rest and straight uniform motion pass unchanged.
/// Same length as the path; a cut-off of half the rate or more returns the path itself.
std::vector<glm::dvec3> low_pass(std::span<const glm::dvec3> path_m, double fs_hz,
                                 double cutoff_hz);

} // namespace tasks
