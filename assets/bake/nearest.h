// assets/bake/nearest.h
// Nearest point on a triangle surface, through a uniform grid. Called by remeshing (to stay on
// the shape), by fitting, and for the Hausdorff distances of the report.
#pragma once

#include "assets/bake/surface.h"

#include <array>

namespace bake {

struct NearestPoint {
    std::uint32_t triangle = 0;
    glm::dvec3 weight{0.0}; // barycentric
    glm::dvec3 point_m{0.0};
    double distance_m = 0.0;
};

/// Nearest point of one triangle (Ericson 2005, section 5.1.5), as barycentric weights.
glm::dvec3 nearest_weights(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                           const glm::dvec3& c);

/// Refers to `surface`, which must outlive it and not move.
class NearestOnSurface {
  public:
    explicit NearestOnSurface(const Surface& surface);
    [[nodiscard]] NearestPoint operator()(const glm::dvec3& p) const;

  private:
    [[nodiscard]] std::array<int, 3> cell_of(const glm::dvec3& p) const;
    void look_into(std::size_t cell, const glm::dvec3& p, NearestPoint& best) const;

    const Surface& surface_;
    glm::dvec3 low_m_{0.0};
    double cell_m_ = 0.0;
    std::array<int, 3> count_{};
    std::vector<std::uint32_t> start_, triangle_; // of each cell, compressed
};

/// Largest distance from `from` to `to`, sampled at the corners, edge middles and centre of every
/// triangle of `from`.
double sampled_hausdorff_m(const Surface& from, const NearestOnSurface& to);

} // namespace bake
