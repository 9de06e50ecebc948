// haptics/rigid/surface_query.h
// Inside or outside of a triangle surface, and how far from it. Load time: convex_pieces and
// voxel_map ask it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptics {

/// Triangles counter-clockwise seen from outside, vertices shared between neighbours.
struct RigidSurface {
    std::string name;
    std::vector<glm::dvec3> vertex_m;
    std::vector<std::array<std::uint32_t, 3>> triangle;
    std::vector<std::array<std::uint32_t, 3>> across; // beyond edge i, i + 1; kRim: none
    std::vector<glm::dvec3> normal;                   // unit
    bool closed = true;
    double extent_m = 0.0; // longest side of the bounding box
};
inline constexpr std::uint32_t kRim = 0xffffffff;

/// Throws std::invalid_argument naming the surface and the triangle or vertex: an index out of
/// range, a vertex that is not finite, a triangle without area, an edge used twice in the same
/// direction (by triangles turned against each other, or more than two triangles). Empty surfaces
/// throw too.
RigidSurface make_surface(std::string_view name, std::span<const glm::dvec3> vertex_m,
                          std::span<const std::array<std::uint32_t, 3>> triangle);

/// How often the surface winds round a point: 1 inside, 0 outside of a closed one (solid angles,
/// van Oosterom and Strackee 1983). Linear in the triangles.
double winding_number(const RigidSurface& surface, const glm::dvec3& place_m);

/// Nearest point of the surface. Linear in the triangles.
struct NearestPoint {
    glm::dvec3 place_m{0.0};
    double distance_m = 0.0;
    std::uint32_t triangle = 0;
};
NearestPoint nearest_point(const RigidSurface& surface, const glm::dvec3& place_m);

} // namespace haptics
