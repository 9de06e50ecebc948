// tasks/score/smoothness.h
// A recorded motion cut into sub-movements, for the smoothness metrics. Called by finish() and by
// `trocar measure`; any thread, no state.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace tasks {

inline constexpr double kMoving_mps = 2e-3;      // slower is rest (`idle` uses the same mark)
inline constexpr double kSubMovementMin_s = 0.1; // shorter is no movement anybody planned

/// Longest runs of speed above kMoving_mps that last kSubMovementMin_s or more, in order. A run is
/// not cut at a slow passage above the mark: hesitation inside a movement counts as roughness.
std::vector<std::span<const double>> sub_movements(std::span<const double> speed_mps, double fs_hz);

/// Middle value (mean of the two middle ones); nothing for no values.
std::optional<double> median(std::vector<double> values);

} // namespace tasks
