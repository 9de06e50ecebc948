// haptics/rigid/convex_hull.h
// Convex hull of points with its faces as polygons and the ring of neighbours round each vertex,
// which is what a walk on the Gauss map needs. Built at load, read at 1 kHz.
//
// Quickhull (Barber, Dobkin, Huhdanpaa 1996) on a grid of 2^-28 of the extent, so that every
// side-of-plane test is an exact integer; afterwards triangles in one plane are joined to
// polygons. All tolerances are shares of the extent: micrometres, metres and a set of points far
// from the origin give the same hull.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string_view>
#include <vector>

namespace haptics {

/// Points nearer than this share of the extent to a face lie in it.
inline constexpr double kFlatShare = 1e-6;

/// Most faces round one vertex, and most corners of one face: walks keep them on the stack.
inline constexpr std::uint32_t kMostAround = 128;

/// Frame and unit of the points given. Lists of variable length stand one after the other:
/// those of item i are [first[i], first[i + 1]).
struct ConvexHull {
    std::vector<glm::dvec3> vertex_m; // corners only
    std::vector<glm::dvec3> normal;   // of each face, outward, unit
    std::vector<double> offset_m;     // normal . x <= offset for every point
    std::vector<std::uint8_t> inner;  // face inside the solid that the hull is a piece of
    std::vector<std::uint32_t> face_first, face_corner; // counter-clockwise from outside
    /// Round each vertex, counter-clockwise from outside: neighbour i, then the face between
    /// neighbours i and i + 1.
    std::vector<std::uint32_t> ring_first, ring_vertex, ring_face;
    glm::dvec3 centre_m{0.0}; // of the bounding sphere: middle of the bounding box
    double radius_m = 0.0;

    std::span<const std::uint32_t> corners(std::size_t face) const noexcept {
        return std::span(face_corner)
            .subspan(face_first[face], face_first[face + 1] - face_first[face]);
    }
    std::span<const std::uint32_t> neighbours(std::size_t vertex) const noexcept {
        return std::span(ring_vertex)
            .subspan(ring_first[vertex], ring_first[vertex + 1] - ring_first[vertex]);
    }
    std::span<const std::uint32_t> faces_round(std::size_t vertex) const noexcept {
        return std::span(ring_face).subspan(ring_first[vertex],
                                            ring_first[vertex + 1] - ring_first[vertex]);
    }
};

/// Load time: allocates. Throws std::invalid_argument naming `name` and the point if one is not
/// finite, naming `name` if all points lie in one plane (within kFlatShare of the extent) or a
/// vertex has more than kMostAround faces. The same points give the same hull.
ConvexHull convex_hull(std::span<const glm::dvec3> point_m, std::string_view name);

/// The vertex farthest along a direction (any length but 0), by climbing from `start`: exact, as a
/// vertex of a convex body without a better neighbour is the best. Real-time safe.
std::uint32_t farthest_vertex(const ConvexHull& hull, const glm::dvec3& direction,
                              std::uint32_t start) noexcept;

} // namespace haptics
