// tests/haptics/convex_pieces.h
// Convex pieces, random and by hand, and the penetration depth of a pair by trying every face and
// every pair of edges of the Minkowski difference.
#pragma once

#include "haptics/rigid/convex_hull.h"
#include "haptics/rigid/rigid_pose.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

inline std::vector<glm::dvec3> box_points(const glm::dvec3& half_m, const glm::dvec3& at_m = {}) {
    std::vector<glm::dvec3> p;
    for (int i = 0; i < 8; ++i)
        p.push_back(at_m + half_m * glm::dvec3{i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
    return p;
}

inline haptics::ConvexHull box(const glm::dvec3& half_m, const glm::dvec3& at_m = {}) {
    return haptics::convex_hull(box_points(half_m, at_m), "box");
}

inline glm::dmat3 turn(const glm::dvec3& axis, double angle) {
    const glm::dvec3 u = glm::normalize(axis);
    const double c = std::cos(angle), s = std::sin(angle);
    const glm::dmat3 skew{0.0, u.z, -u.y, -u.z, 0.0, u.x, u.y, -u.x, 0.0};
    return glm::dmat3(c) + s * skew + (1.0 - c) * glm::outerProduct(u, u);
}

class RandomPieces {
  public:
    explicit RandomPieces(unsigned seed) : random_(seed) {}

    double number(double low, double high) {
        // not std::uniform_real_distribution: the same cases with every library
        return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
    }
    glm::dvec3 in_ball() {
        for (;;) {
            const glm::dvec3 p{number(-1, 1), number(-1, 1), number(-1, 1)};
            if (glm::dot(p, p) <= 1.0 && glm::dot(p, p) > 1e-6)
                return p;
        }
    }
    glm::dmat3 rotation() { return turn(in_ball(), number(0.0, 6.28)); }

    /// Box, prism or scattered points, up to 10 times as long as wide; some 10 mm.
    std::vector<glm::dvec3> points() {
        const glm::dvec3 half{10e-3 * number(0.1, 1), 10e-3 * number(0.1, 1), 10e-3};
        const double kind = number(0.0, 1.0);
        if (kind < 0.25)
            return box_points(half);
        std::vector<glm::dvec3> p;
        const int n = static_cast<int>(number(4, 30));
        for (int i = 0; i < n; ++i) {
            const glm::dvec3 q = in_ball();
            if (kind < 0.45)
                for (const double z : {-1.0, 1.0})
                    p.push_back(half *
                                glm::dvec3{std::cos(6.28 * i / n), std::sin(6.28 * i / n), z});
            else
                p.push_back(half * (kind < 0.7 ? glm::normalize(q) : q));
        }
        return p;
    }

  private:
    std::mt19937 random_;
};

/// h(n) of the Minkowski difference, by trying all vertices.
inline double support_distance(const haptics::ConvexHull& a, const haptics::ConvexHull& b,
                               const haptics::RigidPose& b_in_a, const glm::dvec3& n) {
    double far_a = -1e300, near_b = 1e300;
    for (const glm::dvec3& p : a.vertex_m)
        far_a = std::max(far_a, glm::dot(n, p));
    for (const glm::dvec3& p : b.vertex_m)
        near_b = std::min(near_b, glm::dot(n, haptics::to_world(b_in_a, p)));
    return far_a - near_b;
}

inline std::vector<glm::dvec3> edge_ways(const haptics::ConvexHull& hull,
                                         const glm::dmat3& turned) {
    std::vector<glm::dvec3> way;
    for (std::uint32_t v = 0; v < hull.vertex_m.size(); ++v)
        for (const std::uint32_t u : hull.neighbours(v))
            if (u > v)
                way.push_back(turned * glm::normalize(hull.vertex_m[u] - hull.vertex_m[v]));
    return way;
}

/// Smallest h over all face normals and all crossings of edges.
inline double brute_depth(const haptics::ConvexHull& a, const haptics::ConvexHull& b,
                          const haptics::RigidPose& b_in_a) {
    double least = 1e300;
    const auto look = [&](const glm::dvec3& n) {
        least = std::min(least, support_distance(a, b, b_in_a, n));
    };
    for (const glm::dvec3& n : a.normal)
        look(n);
    for (const glm::dvec3& n : b.normal)
        look(-(b_in_a.rotation * n));
    for (const glm::dvec3& e : edge_ways(a, glm::dmat3(1.0)))
        for (const glm::dvec3& f : edge_ways(b, b_in_a.rotation)) {
            const glm::dvec3 n = glm::cross(e, f);
            if (glm::length(n) < 1e-9)
                continue;
            look(glm::normalize(n));
            look(-glm::normalize(n));
        }
    return least;
}
