// haptics/contact/surface_walk.h
// Carries a point along a triangulated surface: from triangle to triangle, never through it.
// Used on the 1 kHz patch, and by sim/bridge on the whole surface in the tissue loop; `Surface`
// is anything with
//   glm::dvec3 position(int triangle, int corner) const;   // as deformed now
//   int neighbour(int triangle, int corner) const;         // across the edge opposite; -1: rim
// so that vertices are evaluated only where the point goes. Real-time safe if these are.
// Triangles must be wound alike. The path is the straightest one: at an edge what is left of the
// offset is unfolded, turned about the edge into the next triangle's plane, so its length stays.
#pragma once

#include "haptics/contact/local_model.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace haptics {

inline constexpr int kMaxWalkTriangles = 64;

struct WalkResult {
    SurfacePoint point;
    bool at_rim = false; // wanted to leave the surface; clamped to its edge
};

namespace walk_detail {

using WalkCorners = std::array<glm::dvec3, 3>;

inline glm::dvec3 mix(const WalkCorners& p, const glm::dvec3& w) noexcept {
    return w.x * p[0] + w.y * p[1] + w.z * p[2];
}

/// Normal of the triangle; zero if its area is lost in rounding (a sliver without a plane).
inline glm::dvec3 plane_normal(const WalkCorners& p) noexcept {
    const glm::dvec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double longest2 =
        std::max({glm::dot(p[1] - p[0], p[1] - p[0]), glm::dot(p[2] - p[1], p[2] - p[1]),
                  glm::dot(p[0] - p[2], p[0] - p[2])});
    const double length = glm::length(n);
    return length > 1e-12 * longest2 ? n / length : glm::dvec3{0.0};
}

/// How the barycentric weights change along `d`, which lies in the triangle's plane.
inline glm::dvec3 weight_change(const WalkCorners& p, const glm::dvec3& n,
                                const glm::dvec3& d) noexcept {
    const double twice_area = glm::dot(n, glm::cross(p[1] - p[0], p[2] - p[0]));
    const double w0 = glm::dot(n, glm::cross(p[2] - p[1], d)) / twice_area;
    const double w1 = glm::dot(n, glm::cross(p[0] - p[2], d)) / twice_area;
    return {w0, w1, -w0 - w1};
}

inline glm::dvec3 unit_or_zero(const glm::dvec3& v) noexcept {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : glm::dvec3{0.0};
}

/// Turns `d` about the edge opposite corner `entry` into the plane with normal `n`, inwards.
inline glm::dvec3 unfold(const WalkCorners& p, int entry, const glm::dvec3& n,
                         const glm::dvec3& d) noexcept {
    const glm::dvec3 edge = unit_or_zero(p[(entry + 2) % 3] - p[(entry + 1) % 3]);
    const glm::dvec3 along = edge * glm::dot(edge, d);
    const glm::dvec3 inwards = unit_or_zero(glm::cross(n, edge));
    return along + inwards * glm::length(d - along);
}

/// Closest point of the edge opposite corner k to x, as weights.
inline glm::dvec3 edge_weights(const WalkCorners& p, int k, const glm::dvec3& x) noexcept {
    const glm::dvec3 edge = p[(k + 2) % 3] - p[(k + 1) % 3];
    const double length2 = glm::dot(edge, edge);
    const double at = length2 > 0.0 ? glm::dot(edge, x - p[(k + 1) % 3]) / length2 : 0.0;
    glm::dvec3 w{0.0};
    w[(k + 2) % 3] = std::clamp(at, 0.0, 1.0);
    w[(k + 1) % 3] = 1.0 - w[(k + 2) % 3];
    return w;
}

} // namespace walk_detail

/// Moves `from` by `offset_m` (its part along the surface), at most kMaxWalkTriangles triangles.
/// At the rim the point slides along the edge as far as the offset's part along it goes.
/// Slivers are crossed where they stand. What is not finite, or an offset of a kilometre, leaves
/// the point where it was and says at_rim.
template <typename Surface>
WalkResult walk(const Surface& surface, SurfacePoint from, glm::dvec3 offset_m) noexcept {
    using namespace walk_detail;
    WalkResult result{from, false};
    if (from.triangle == kNoTriangle || !(glm::dot(offset_m, offset_m) < 1e6))
        return {from, true};
    int& triangle = result.point.triangle;
    glm::dvec3& weight = result.point.weight;
    const auto corners_of = [&surface](int t) {
        return WalkCorners{surface.position(t, 0), surface.position(t, 1), surface.position(t, 2)};
    };

    // only the part along the surface counts
    WalkCorners p = corners_of(triangle);
    glm::dvec3 n = plane_normal(p);
    glm::dvec3 left_m = offset_m - n * glm::dot(n, offset_m);
    int entry = -1; // corner opposite the edge just crossed: the way back is closed

    for (int visited = 0; visited < kMaxWalkTriangles; ++visited) {
        // which edge does the rest of the offset reach first?
        int exit = -1;
        if (n == glm::dvec3{0.0}) {
            const glm::dvec3 here = mix(p, weight);
            double nearest2 = 0.0;
            for (int k = 0; k < 3; ++k) {
                if (k == entry)
                    continue;
                const glm::dvec3 away = mix(p, edge_weights(p, k, here)) - here;
                if (exit < 0 || glm::dot(away, away) < nearest2) {
                    exit = k;
                    nearest2 = glm::dot(away, away);
                }
            }
            weight = edge_weights(p, exit, here);
        } else {
            glm::dvec3 change = weight_change(p, n, left_m);
            if (entry >= 0)
                change[entry] = std::max(0.0, change[entry]);
            double share = 1.0;
            for (int k = 0; k < 3; ++k)
                if (change[k] < 0.0 && weight[k] < -change[k] * share) {
                    share = weight[k] / -change[k];
                    exit = k;
                }
            weight = glm::max(weight + share * change, glm::dvec3{0.0});
            if (exit >= 0)
                weight[exit] = 0.0;
            weight /= weight.x + weight.y + weight.z;
            left_m *= 1.0 - share;
        }
        if (exit < 0 || left_m == glm::dvec3{0.0})
            break;

        const int next = surface.neighbour(triangle, exit);
        int opposite = -1; // corner of `next` that the shared edge lies opposite of
        for (int k = 0; next >= 0 && k < 3; ++k)
            if (surface.neighbour(next, k) == triangle &&
                (opposite < 0 || surface.position(next, (k + 1) % 3) == p[(exit + 2) % 3]))
                opposite = k;
        if (opposite < 0) {
            // the rim: only what runs along the edge is left
            const glm::dvec3 edge = unit_or_zero(p[(exit + 2) % 3] - p[(exit + 1) % 3]);
            left_m = edge * glm::dot(edge, left_m);
            entry = exit;
            result.at_rim = true;
            if (n == glm::dvec3{0.0})
                break;
            continue;
        }

        // the same point and the same direction, seen from the next triangle
        glm::dvec3 carried{0.0};
        carried[(opposite + 1) % 3] = weight[(exit + 2) % 3];
        carried[(opposite + 2) % 3] = weight[(exit + 1) % 3];
        triangle = next;
        weight = carried;
        entry = opposite;
        p = corners_of(triangle);
        n = plane_normal(p);
        if (n != glm::dvec3{0.0})
            left_m = unfold(p, entry, n, left_m);
    }
    const bool sound = weight.x >= 0.0 && weight.y >= 0.0 && weight.z >= 0.0;
    return sound ? result : WalkResult{from, true};
}

} // namespace haptics
