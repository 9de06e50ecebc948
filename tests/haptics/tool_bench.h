// tests/haptics/tool_bench.h
// Scenes for instruments: meshes that may move, tools led through them, and how near they are by
// formulas of their own.
#pragma once

#include "haptics/contact/safe_tools.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string_view>
#include <vector>

namespace tool_bench {

using glm::dvec3;

struct Scene {
    std::vector<dvec3> vertex, before;
    std::vector<haptics::Corners> triangle;
    haptics::CollisionIndex index;
    std::vector<haptics::ToolInput> in;
    haptics::ToolsState state;

    haptics::MeshView mesh() const { return {vertex, triangle, before}; }
    void quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
        const auto v = static_cast<std::uint32_t>(vertex.size());
        vertex.insert(vertex.end(), {a, b, c, d});
        triangle.insert(triangle.end(), {{v, v + 1, v + 2}, {v, v + 2, v + 3}});
        make("brute-force");
    }
    void make(std::string_view method) { index = haptics::make_index(method, mesh()); }
    haptics::ToolInput& add(const dvec3& pivot_m, const dvec3& tip_m, double tip_radius_m,
                            double shaft_radius_m) {
        in.push_back({.device_m = tip_m, .shape = {pivot_m, tip_radius_m, shaft_radius_m}});
        return in.back();
    }
    void step(int ticks = 1) {
        for (int i = 0; i < ticks; ++i)
            haptics::step_safe_tools(index, mesh(), in, state);
    }
    const haptics::ToolState& tool(int i) const { return state.tool[i]; }
};

/// n x n cells of random height up to `bump_m` over a square of half width `half_m` in z = 0.
inline Scene bumpy(std::uint64_t seed, std::uint32_t n, double half_m, double bump_m,
                   std::string_view method = "ours") {
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> height_m(0.0, bump_m);
    Scene s;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            s.vertex.push_back(
                {half_m * (2.0 * i / n - 1.0), half_m * (2.0 * j / n - 1.0), height_m(engine)});
            if (i == n || j == n)
                continue;
            const std::uint32_t a = j * (n + 1) + i;
            s.triangle.push_back({a, a + 1, a + n + 1});
            s.triangle.push_back({a + 1, a + n + 2, a + n + 1});
        }
    s.make(method);
    return s;
}

/// A small triangle far away: nothing but tools.
inline Scene empty() {
    Scene s;
    s.vertex = {{9, 9, 9}, {9.001, 9, 9}, {9, 9.001, 9}};
    s.triangle = {{0, 1, 2}};
    s.make("brute-force");
    return s;
}

/// A hand that goes from one random place of a box to the next, at a speed up to 2 m/s.
struct Wander {
    std::mt19937_64 engine;
    dvec3 low_m, high_m, place_m, goal_m{0.0};
    double step_m = 0.0;

    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    dvec3 next() {
        if (glm::length(goal_m - place_m) <= step_m || step_m == 0.0) {
            for (int k = 0; k < 3; ++k)
                goal_m[k] = between(low_m[k], high_m[k]);
            step_m = 2e-3 * between(0.02, 1.0);
        }
        const double left_m = glm::length(goal_m - place_m);
        return place_m += std::min(1.0, step_m / left_m) * (goal_m - place_m);
    }
};

/// Distance of two segments (Ericson, Real-Time Collision Detection, 5.1.9).
inline double segments_apart_m(const dvec3& p, const dvec3& p2, const dvec3& q, const dvec3& q2) {
    const dvec3 d = p2 - p, e = q2 - q, r = p - q;
    const double a = glm::dot(d, d), b = glm::dot(d, e), c = glm::dot(d, r), f = glm::dot(e, r),
                 g = glm::dot(e, e), det = a * g - b * b;
    double s = det > 0.0 ? std::clamp((b * f - c * g) / det, 0.0, 1.0) : 0.0;
    const double t = std::clamp(g > 0.0 ? (b * s + f) / g : 0.0, 0.0, 1.0);
    s = std::clamp(a > 0.0 ? (b * t - c) / a : 0.0, 0.0, 1.0);
    return glm::length(p + s * d - q - t * e);
}

/// Distance of a segment and a triangle with an area: their edges, the feet of the segment's ends,
/// or 0 if it goes through.
inline double triangle_apart_m(const haptics::TriangleCorners& c, const dvec3& p, const dvec3& q) {
    const dvec3 n = glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
    const auto over = [&](const dvec3& x) {
        for (int k = 0; k < 3; ++k)
            if (glm::dot(glm::cross(c[(k + 1) % 3] - c[k], x - c[k]), n) < 0.0)
                return false;
        return true;
    };
    double best_m = HUGE_VAL;
    for (int k = 0; k < 3; ++k)
        best_m = std::min(best_m, segments_apart_m(p, q, c[k], c[(k + 1) % 3]));
    const double hp = glm::dot(p - c[0], n), hq = glm::dot(q - c[0], n);
    if (over(p))
        best_m = std::min(best_m, std::abs(hp));
    if (over(q))
        best_m = std::min(best_m, std::abs(hq));
    if (hp * hq < 0.0 && over(p + hp / (hp - hq) * (q - p)))
        best_m = 0.0;
    return best_m;
}

/// How far the nearest triangle of all is off the surface of a tool's shaft, and of its tip.
inline double clear_m(const Scene& scene, int tool) {
    const haptics::ToolState& s = scene.tool(tool);
    const dvec3 p = s.shape.pivot_m, q = s.tip_m;
    double best_m = HUGE_VAL;
    for (std::uint32_t t = 0; t < scene.triangle.size(); ++t) {
        const haptics::TriangleCorners c = scene.mesh().corners(t);
        if (s.shape.shaft_radius_m > 0.0)
            best_m = std::min(best_m, triangle_apart_m(c, p, q) - s.shape.shaft_radius_m);
        if (haptics::sweep_ball({c, c}, q, q, 0.0).hit())
            return -1.0;
        best_m = std::min(best_m, std::sqrt(haptics::nearest_on_triangle(c, q).distance2_m2) -
                                      s.shape.tip_radius_m);
    }
    return best_m;
}

} // namespace tool_bench
