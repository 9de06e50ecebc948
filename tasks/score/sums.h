// tasks/score/sums.h
// What one tool, or all of them, did in the time that counts: the sums that the metrics are made
// of. Called by finish() only; any thread, no state.
#pragma once

#include "tasks/score/metrics.h"

namespace tasks {

inline constexpr std::uint8_t kTouching = 1, kInView = 2, kPresent = 4; // ScoreState::flags
inline constexpr double kFs_hz = 1.0 / kTick_s;
inline constexpr double kCutoff_hz = 10.0; // voluntary motion of the hand ends below

/// The samples that count: [first, first + count), as indices into the score's vectors.
struct Window {
    std::size_t first = 0, count = 0;
    std::int64_t first_tick = 0, last_tick = -1;
    bool moved = false;
};
Window window_of(const ScoreState& score, const Progress& progress);

/// Of one tool over the window; the combined ones are sums of tools.
struct Sums {
    bool present = false;
    std::size_t ticks = 0, hidden = 0, contact = 0, over = 0;
    double force_sum_n = 0.0, force_peak_n = 0.0;
    std::size_t intervals = 0, idle = 0, bends = 0; // pairs and triples of samples
    double path_m = 0.0, depth_m = 0.0, angle_rad = 0.0, roll_rad = 0.0;
    double accel_sum_mps2 = 0.0, squared_jerk_m2ps5 = 0.0, work_j = 0.0;
    double ideal_m = 0.0, retraction_m = 0.0;
    std::vector<double> ldlj, sparc; // of each sub-movement
};

/// Ticks, forces and view, unfiltered. Sets `present`.
void add_forces(Sums& sums, const ScoreState& score, std::size_t tool, const Window& window,
                double limit_n);
/// Everything of the low-passed motion. Returns the tip's speed between samples, m/s.
std::vector<double> add_motion(Sums& sums, const ScoreState& score, std::size_t tool,
                               const Window& window);
/// The ways that would have been enough for the targets touched so far.
void add_ideal(Sums& sums, const ScoreState& score, std::size_t tool, const Window& window,
               const Progress& progress, const ScoreContext& context);

Sums combined(const std::array<Sums, kTools>& tools);
std::size_t ticks_any_over(const ScoreState& score, const Window& window, double limit_n);

} // namespace tasks
