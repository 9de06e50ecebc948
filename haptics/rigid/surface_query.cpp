#include "haptics/rigid/surface_query.h"

#include "haptics/collision/triangle.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <stdexcept>

namespace haptics {
namespace {

using glm::dvec3;

constexpr double kTurn = 6.283185307179586;

std::string triangle_of(const RigidSurface& s, std::size_t t) {
    return "surface " + s.name + ": triangle " + std::to_string(t);
}

void set_extent(RigidSurface& s) {
    dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};
    for (std::size_t v = 0; v < s.vertex_m.size(); ++v) {
        if (!std::isfinite(s.vertex_m[v].x + s.vertex_m[v].y + s.vertex_m[v].z))
            throw std::invalid_argument("surface " + s.name + ": vertex " + std::to_string(v) +
                                        " is not finite");
        low = glm::min(low, s.vertex_m[v]);
        high = glm::max(high, s.vertex_m[v]);
    }
    s.extent_m = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

void set_normals(RigidSurface& s) {
    for (std::size_t t = 0; t < s.triangle.size(); ++t) {
        for (const std::uint32_t v : s.triangle[t])
            if (v >= s.vertex_m.size())
                throw std::invalid_argument(triangle_of(s, t) + " names vertex " +
                                            std::to_string(v) + " of " +
                                            std::to_string(s.vertex_m.size()));
        const auto [a, b, c] = s.triangle[t];
        const dvec3 area = glm::cross(s.vertex_m[b] - s.vertex_m[a], s.vertex_m[c] - s.vertex_m[a]);
        if (!(glm::length(area) > 1e-14 * s.extent_m * s.extent_m))
            throw std::invalid_argument(triangle_of(s, t) + " has no area");
        s.normal.push_back(glm::normalize(area));
    }
}

void set_neighbours(RigidSurface& s) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> owner;
    const auto edge = [&](std::size_t t, std::size_t e) {
        return std::pair{s.triangle[t][e], s.triangle[t][(e + 1) % 3]};
    };
    for (std::uint32_t t = 0; t < s.triangle.size(); ++t)
        for (std::size_t e = 0; e < 3; ++e)
            if (const auto [at, fresh] = owner.emplace(edge(t, e), t); !fresh)
                throw std::invalid_argument(triangle_of(s, t) + " has an edge with triangle " +
                                            std::to_string(at->second) +
                                            " that both use in the same direction");
    s.across.resize(s.triangle.size());
    for (std::uint32_t t = 0; t < s.triangle.size(); ++t)
        for (std::size_t e = 0; e < 3; ++e) {
            const auto [from, to] = edge(t, e);
            const auto other = owner.find({to, from});
            s.across[t][e] = other == owner.end() ? kRim : other->second;
            s.closed = s.closed && other != owner.end();
        }
}

} // namespace

RigidSurface make_surface(std::string_view name, std::span<const dvec3> vertex_m,
                          std::span<const std::array<std::uint32_t, 3>> triangle) {
    RigidSurface s;
    s.name = name;
    s.vertex_m.assign(vertex_m.begin(), vertex_m.end());
    s.triangle.assign(triangle.begin(), triangle.end());
    if (triangle.empty())
        throw std::invalid_argument("surface " + s.name + ": no triangles");
    set_extent(s);
    set_normals(s);
    set_neighbours(s);
    return s;
}

double winding_number(const RigidSurface& s, const dvec3& place_m) {
    double sum = 0.0;
    for (const auto& [i, j, k] : s.triangle) {
        const dvec3 a = s.vertex_m[i] - place_m, b = s.vertex_m[j] - place_m,
                    c = s.vertex_m[k] - place_m;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        sum += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                   glm::dot(b, c) * la +
                                                                   glm::dot(c, a) * lb);
    }
    return sum / (2.0 * kTurn);
}

NearestPoint nearest_point(const RigidSurface& s, const dvec3& place_m) {
    NearestPoint best{.distance_m = std::numeric_limits<double>::infinity()};
    for (std::uint32_t t = 0; t < s.triangle.size(); ++t) {
        const auto [a, b, c] = s.triangle[t];
        const TrianglePoint q =
            nearest_on_triangle({s.vertex_m[a], s.vertex_m[b], s.vertex_m[c]}, place_m);
        if (const double distance_m = std::sqrt(q.distance2_m2); distance_m < best.distance_m)
            best = {q.place_m, distance_m, t};
    }
    return best;
}

} // namespace haptics
