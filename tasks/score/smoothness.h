// tasks/score/smoothness.h
// A recorded motion cut into sub-movements, for the smoothness metrics. Called by finish() and by
// `trocar measure`; any thread, no state. LDLJ stands in metrics.h.
#pragma once

#include <glm/vec3.hpp>
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

/// Spectral arc length of a speed sampled at fs (Balasubramanian et al. 2015): minus the length of
/// the curve (f / bandwidth, |V(f)| / max |V|) over the bandwidth, which reaches from the first to
/// the last bin up to 10 Hz that is 0.05 or more; spectrum of the speed padded with zeros to 2^4
/// times the next power of two. Nothing for rest or if fewer than two bins remain.
std::optional<double> sparc(std::span<const double> speed_mps, double fs_hz);

/// integral |p'''|^2 dt of a path sampled at fs, m^2/s^5, by third differences; 0 below 4 samples.
double squared_jerk_m2ps5(std::span<const glm::dvec3> path_m, double fs_hz);

/// sqrt( T^5/(2 L^2) * integral |p'''|^2 dt ) of a motion of duration T and length L. Nothing for
/// less than a millimetre, where the number is all noise.
std::optional<double> jerk_norm(double duration_s, double length_m, double squared_jerk_m2ps5);

/// Pearson correlation of two speeds over the samples where both are kMoving_mps or faster.
/// Nothing if one of them is steady to 1 um/s there (or there are fewer than two samples).
std::optional<double> speed_correlation(std::span<const double> one_mps,
                                        std::span<const double> other_mps);

} // namespace tasks
