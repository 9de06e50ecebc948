// tasks/exercise/path_curve.h
// The curve of a path through its points: centripetal Catmull-Rom (Yuksel et al. 2011), which
// passes every point, has no loops, and is drawn and measured as short straight pieces. `u` counts
// points: 2.5 is half the parameter between the third and the fourth. Called by the fold, the hands
// and the window.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace tasks {

inline constexpr int kPiecesPerPoint = 8;

glm::dvec3 curve_at(std::span<const glm::dvec3> point_m, double u) noexcept;

/// Way along the pieces from the first point to u.
double curve_length_m(std::span<const glm::dvec3> point_m, double u) noexcept;

/// u at `way_m` along the curve from `from_u`, clamped to its ends.
double curve_step(std::span<const glm::dvec3> point_m, double from_u, double way_m) noexcept;

/// The place of the curve between u `first` and `last` that is nearest to the segment a-b.
struct NearCurve {
    double u = 0.0;
    double distance_m = 0.0;
};
NearCurve nearest_on_curve(std::span<const glm::dvec3> point_m, const glm::dvec3& a,
                           const glm::dvec3& b, double first, double last) noexcept;

} // namespace tasks
