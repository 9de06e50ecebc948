#include "haptics/rigid/convex_hull.h"

#include "haptics/rigid/grid_hull.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>

namespace haptics {
namespace {

using glm::dvec3;
using Polygon = std::vector<std::uint32_t>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr double kGridSteps = 268435456.0; // 2^28 to the extent

struct Extent {
    dvec3 middle{0.0};
    double half = 0.0;
};

Extent extent_of(std::span<const dvec3> point_m, std::string_view name) {
    dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};
    for (std::size_t i = 0; i < point_m.size(); ++i) {
        if (!std::isfinite(point_m[i].x + point_m[i].y + point_m[i].z))
            throw std::invalid_argument("convex hull: point " + std::to_string(i) + " of " +
                                        std::string(name) + " is not finite");
        low = glm::min(low, point_m[i]);
        high = glm::max(high, point_m[i]);
    }
    const dvec3 half = 0.5 * (high - low);
    return {low + half, std::max({half.x, half.y, half.z})};
}

std::vector<GridPoint> snapped(std::span<const dvec3> point_m, const Extent& extent) {
    std::vector<GridPoint> grid;
    for (const dvec3& p : point_m) {
        const dvec3 q = (p - extent.middle) * (0.5 * kGridSteps / extent.half);
        grid.push_back({std::llround(q.x), std::llround(q.y), std::llround(q.z)});
    }
    return grid;
}

// Outline of a set of triangles as one loop; empty if it is none (a hole, or touching itself).
Polygon outline(std::span<const GridTriangle> triangle, std::span<const std::uint32_t> region,
                std::uint32_t number, const std::map<Edge, std::uint32_t>& owner) {
    std::map<std::uint32_t, std::uint32_t> next;
    for (std::uint32_t t = 0; t < triangle.size(); ++t) {
        for (std::size_t e = 0; region[t] == number && e < 3; ++e) {
            const std::uint32_t from = triangle[t][e], to = triangle[t][(e + 1) % 3];
            if (region[owner.at({to, from})] != number && !next.emplace(from, to).second)
                return {};
        }
    }
    Polygon loop;
    if (next.empty())
        return loop;
    std::uint32_t at = next.begin()->first;
    do {
        loop.push_back(at);
        at = next.at(at);
    } while (at != loop.front() && loop.size() <= next.size());
    return loop.size() == next.size() ? loop : Polygon{};
}

// Triangles within the tolerance of the plane of the largest one become one polygon.
std::vector<Polygon> joined(std::span<const dvec3> p, std::span<const GridTriangle> triangle,
                            double tolerance) {
    constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
    std::map<Edge, std::uint32_t> owner;
    std::vector<dvec3> area(triangle.size());
    for (std::uint32_t t = 0; t < triangle.size(); ++t) {
        const auto [a, b, c] = triangle[t];
        area[t] = glm::cross(p[b] - p[a], p[c] - p[a]);
        for (std::size_t e = 0; e < 3; ++e)
            owner[{triangle[t][e], triangle[t][(e + 1) % 3]}] = t;
    }
    std::vector<std::uint32_t> order(triangle.size()), region(triangle.size(), kNone);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double large = glm::length(area[a]), small = glm::length(area[b]);
        return large != small ? large > small : a < b;
    });
    std::vector<Polygon> polygon;
    for (const std::uint32_t seed : order) {
        if (region[seed] != kNone)
            continue;
        const dvec3 normal = glm::normalize(area[seed]);
        const auto flat = [&](std::uint32_t t) {
            return std::all_of(triangle[t].begin(), triangle[t].end(), [&](std::uint32_t v) {
                return std::abs(glm::dot(normal, p[v] - p[triangle[seed][0]])) <= tolerance;
            });
        };
        std::vector<std::uint32_t> grown{seed};
        region[seed] = seed;
        for (std::size_t i = 0; i < grown.size(); ++i) {
            const GridTriangle at = triangle[grown[i]];
            for (std::size_t e = 0; e < 3; ++e) {
                const std::uint32_t next = owner.at({at[(e + 1) % 3], at[e]});
                if (region[next] == kNone && flat(next)) {
                    region[next] = seed;
                    grown.push_back(next);
                }
            }
        }
        polygon.push_back(outline(triangle, region, seed, owner));
        if (polygon.back().empty()) // rather triangles than a wrong polygon
            return {};
    }
    return polygon;
}

// Drops corners in the middle of an edge. False if what is left is no polyhedron.
bool tidy(std::vector<Polygon>& polygon, std::size_t points) {
    std::vector<int> faces_at(points, 0);
    for (const Polygon& face : polygon)
        for (const std::uint32_t v : face)
            ++faces_at[v];
    std::size_t sides = 0;
    for (Polygon& face : polygon) {
        std::erase_if(face, [&](std::uint32_t v) { return faces_at[v] < 3; });
        sides += face.size();
        if (face.size() < 3)
            return false;
    }
    const auto corners = static_cast<std::size_t>(
        std::count_if(faces_at.begin(), faces_at.end(), [](int n) { return n >= 3; }));
    return corners + polygon.size() == sides / 2 + 2; // Euler
}

void set_faces(ConvexHull& hull, std::span<const dvec3> point_m,
               const std::vector<Polygon>& polygon) {
    std::map<std::uint32_t, std::uint32_t> number;
    for (const Polygon& face : polygon)
        for (const std::uint32_t v : face)
            number.emplace(v, 0);
    for (auto& [point, vertex] : number) {
        vertex = static_cast<std::uint32_t>(hull.vertex_m.size());
        hull.vertex_m.push_back(point_m[point]);
    }
    hull.face_first.push_back(0);
    for (const Polygon& face : polygon) {
        dvec3 area{0.0};
        const dvec3 origin = point_m[face[0]];
        for (std::size_t i = 0; i < face.size(); ++i) {
            hull.face_corner.push_back(number.at(face[i]));
            area += glm::cross(point_m[face[i]] - origin,
                               point_m[face[(i + 1) % face.size()]] - origin);
        }
        hull.face_first.push_back(static_cast<std::uint32_t>(hull.face_corner.size()));
        hull.normal.push_back(glm::normalize(area));
        double offset_m = -std::numeric_limits<double>::infinity();
        for (const std::uint32_t v : face)
            offset_m = std::max(offset_m, glm::dot(hull.normal.back(), point_m[v]));
        hull.offset_m.push_back(offset_m);
    }
    hull.inner.assign(hull.normal.size(), 0);
}

void set_rings(ConvexHull& hull, std::string_view name) {
    struct Step {
        std::uint32_t face, previous;
    };
    std::map<Edge, Step> leaving; // directed edge: its face, and the corner before it
    for (std::uint32_t f = 0; f < hull.normal.size(); ++f) {
        const auto corner = hull.corners(f);
        const std::size_t n = corner.size();
        for (std::size_t i = 0; i < n; ++i)
            leaving[{corner[i], corner[(i + 1) % n]}] = {f, corner[(i + n - 1) % n]};
    }
    hull.ring_first.push_back(0);
    for (std::uint32_t v = 0; v < hull.vertex_m.size(); ++v) {
        const std::uint32_t start = leaving.lower_bound({v, 0})->first.second;
        std::uint32_t at = start;
        do {
            const Step step = leaving.at({v, at});
            hull.ring_vertex.push_back(at);
            hull.ring_face.push_back(step.face);
            at = step.previous;
        } while (at != start);
        hull.ring_first.push_back(static_cast<std::uint32_t>(hull.ring_vertex.size()));
        if (hull.neighbours(v).size() > kMostAround)
            throw std::invalid_argument("convex hull: a vertex of " + std::string(name) + " has " +
                                        std::to_string(hull.neighbours(v).size()) +
                                        " faces, more than " + std::to_string(kMostAround));
    }
}

} // namespace

ConvexHull convex_hull(std::span<const dvec3> point_m, std::string_view name) {
    const Extent extent = extent_of(point_m, name);
    std::vector<GridTriangle> triangle;
    if (extent.half > 0.0)
        triangle = grid_hull(snapped(point_m, extent), kFlatShare * kGridSteps);
    if (triangle.empty())
        throw std::invalid_argument("convex hull: the points of " + std::string(name) +
                                    " lie in one plane");
    std::vector<Polygon> polygon = joined(point_m, triangle, 4.0 * kFlatShare * extent.half);
    const bool too_wide = std::any_of(polygon.begin(), polygon.end(),
                                      [](const Polygon& f) { return f.size() > kMostAround; });
    if (polygon.empty() || too_wide || !tidy(polygon, point_m.size())) {
        polygon.clear();
        for (const GridTriangle& t : triangle)
            polygon.emplace_back(t.begin(), t.end());
    }
    ConvexHull hull;
    set_faces(hull, point_m, polygon);
    set_rings(hull, name);
    hull.centre_m = extent.middle;
    for (const dvec3& v : hull.vertex_m)
        hull.radius_m = std::max(hull.radius_m, glm::length(v - hull.centre_m));
    return hull;
}

std::uint32_t farthest_vertex(const ConvexHull& hull, const dvec3& direction,
                              std::uint32_t start) noexcept {
    std::uint32_t best = start;
    double most = glm::dot(direction, hull.vertex_m[start]);
    for (bool climbs = true; climbs;) {
        climbs = false;
        for (const std::uint32_t v : hull.neighbours(best)) {
            const double reach = glm::dot(direction, hull.vertex_m[v]);
            if (reach > most) {
                most = reach;
                best = v;
                climbs = true;
            }
        }
    }
    return best;
}

} // namespace haptics
