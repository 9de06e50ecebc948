// tests/tissue/cylinders.h
// Ten-node tetrahedra in rings around the axis, or around a thin straight hole for it, which a test
// holds there: what that changes goes with the square of its radius. For punches, layers, tubes and
// twisted rods.
#pragma once

#include "tissue/mesh/quadratic_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <vector>

namespace cylinders {

/// Ascending, from 0 without a hole; around the axis `segments` to `arc_rad`, a whole turn is
/// closed.
struct Rings {
    std::vector<double> radius_m{}, z_m{};
    int segments = 4;
    double arc_rad = std::numbers::pi / 2;
    bool round = true; // false: many-cornered, all edges straight
};

inline double radius_m(const glm::dvec3& x) {
    return std::hypot(x.x, x.y);
}

/// Where two rings meet at a seam, one node serves both; what the axis makes flat is left out.
inline tissue::TetMesh welded(const tissue::TetMesh& mesh) {
    tissue::TetMesh out;
    std::map<std::array<long long, 3>, std::uint32_t> place;
    std::vector<std::uint32_t> of_node;
    for (const glm::dvec3& x : mesh.rest_m) {
        const std::array<long long, 3> key{std::llround(x.x * 1e9), std::llround(x.y * 1e9),
                                           std::llround(x.z * 1e9)};
        const auto [at, fresh] = place.try_emplace(key, static_cast<std::uint32_t>(place.size()));
        if (fresh)
            out.rest_m.push_back(x);
        of_node.push_back(at->second);
    }
    for (tissue::Tet t : mesh.tets) {
        for (auto& node : t)
            node = of_node[node];
        tissue::Tet sorted = t;
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end())
            out.tets.push_back(t);
    }
    return out;
}

/// Edge nodes lie at the mean radius and angle of their corners if rings are round.
inline tissue::QuadraticMesh mesh(const Rings& rings) {
    const auto count = [](const std::vector<double>& v) { return static_cast<int>(v.size()) - 1; };
    const std::array<int, 3> cells{count(rings.radius_m), rings.segments, count(rings.z_m)};
    auto corners = tissue::box_mesh({cells[0], cells[1], cells[2]}, cells);
    for (glm::dvec3& x : corners.rest_m) {
        const double r = rings.radius_m[static_cast<std::size_t>(std::lround(x.x))];
        const double angle = rings.arc_rad * x.y / rings.segments;
        x = {r * std::cos(angle), r * std::sin(angle),
             rings.z_m[static_cast<std::size_t>(std::lround(x.z))]};
    }
    auto out = tissue::quadratic_mesh(welded(corners));
    if (!rings.round)
        return out;
    for (const tissue::Tet10& t : out.tets) {
        for (std::size_t k = 0; k < tissue::kEdge.size(); ++k) {
            const glm::dvec3 a = out.rest_m[t[tissue::kEdge[k][0]]];
            const glm::dvec3 b = out.rest_m[t[tissue::kEdge[k][1]]];
            if (!(std::min(radius_m(a), radius_m(b)) > 0.0))
                continue; // from the axis outward: straight
            const glm::dvec3 between = a / radius_m(a) + b / radius_m(b);
            const double r = 0.5 * (radius_m(a) + radius_m(b)) / radius_m(between);
            out.rest_m[t[4 + k]] = {r * between.x, r * between.y, 0.5 * (a.z + b.z)};
        }
    }
    return out;
}

/// From `from` to `to` in lengths that grow by `growth` and begin with about `first`.
inline void add_growing(std::vector<double>& v, double to, double first, double growth) {
    const double from = v.back(), length = to - from;
    const int n = std::max(1, static_cast<int>(std::lround(
                                  std::log1p(length * (growth - 1) / first) / std::log(growth))));
    const double scale = length / (std::pow(growth, n) - 1);
    for (int i = 1; i <= n; ++i)
        v.push_back(from + scale * (std::pow(growth, i) - 1));
}

} // namespace cylinders
