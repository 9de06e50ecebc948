#include "haptics/contact/path_planes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace haptics {
using glm::dvec3;

void look_around(const CollisionIndex& index, const MeshView& mesh, const dvec3& centre_m,
                 double reach_m, double least_m, WideRing& ring, NearLeaves& out) noexcept {
    for (int attempt = 0; attempt < 12; ++attempt) {
        if (find_near(index, mesh, centre_m, reach_m, ring, out) || reach_m <= least_m)
            return;
        reach_m = std::max(least_m, attempt < 10 ? 0.5 * (reach_m + least_m) : least_m);
    }
}

void HoldingPlanes::add(std::uint32_t triangle, const TriangleCorners& corner,
                        const TrianglePoint& nearest, const dvec3& centre_m,
                        double radius_m) noexcept {
    constexpr double kBeside = 1e-5; // of the distance: an edge's plane leans by 1/4 degree there
    const double distance = std::sqrt(nearest.distance2_m2);
    if (!(distance > 0.0) || count == kRoom)
        return;
    dvec3 n = (centre_m - nearest.place_m) / distance;
    const dvec3 face = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double height = glm::dot(face, centre_m - nearest.place_m), area = glm::length(face);
    if (std::abs(height) > (1.0 - kBeside) * distance * area)
        n = (height < 0.0 ? -1.0 : 1.0) / area * face;
    const Plane made{n, glm::dot(n, nearest.place_m) + radius_m};
    for (int i = 0; i < count; ++i)
        if (plane[i].normal == made.normal && plane[i].offset_m >= made.offset_m)
            return;
    plane[count] = made;
    from[count++] = {triangle, nearest.weight};
}

double hover_of(const MeshView& mesh, const ProxyInput& in) noexcept {
    double edge_m = 0.0, coordinate_m = in.radius_m;
    const auto first = static_cast<std::uint32_t>(std::min<std::size_t>(64, mesh.triangle.size()));
    for (std::uint32_t t = 0; t < first; ++t) {
        const TriangleCorners c = mesh.corners(t);
        for (int k = 0; k < 3; ++k) {
            const double length_m = glm::length(c[(k + 1) % 3] - c[k]);
            edge_m = std::max(edge_m, std::isfinite(length_m) ? length_m : 0.0);
        }
    }
    for (int axis = 0; axis < 3; ++axis)
        coordinate_m = std::max(coordinate_m, std::abs(in.device_m[axis]));
    return 4.0 * kSweepGap * (in.radius_m > 0.0 ? in.radius_m : 0.1 * edge_m) +
           1024.0 * std::numeric_limits<double>::epsilon() * coordinate_m;
}

} // namespace haptics
