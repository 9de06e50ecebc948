#include "haptics/rigid/separation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace haptics {
namespace {

using glm::dvec3;

constexpr int kMostSteps = 100;
constexpr double kExact = 1e-10;      // of the squared distance
constexpr double kFlatHeight = 1e-10; // of the size
constexpr double kTouching = 1e-11;   // of the size of the pieces

struct Corner {
    dvec3 way_m, on_a_m; // a - b, and its part on a
};

struct Simplex {
    std::array<Corner, 4> corner;
    std::array<double, 4> weight{};
    int count = 0;
};

// One corner of the simplex, two or three, with the weights of the point nearest to the origin.
using Subset = Simplex;

dvec3 nearest_of(const Simplex& s) noexcept {
    dvec3 v{0.0};
    for (int i = 0; i < s.count; ++i)
        v += s.weight[i] * s.corner[i].way_m;
    return v;
}

Subset on_corner(const Corner& a) noexcept {
    return {{a}, {1.0}, 1};
}

Subset on_edge(const Corner& a, const Corner& b) noexcept {
    const dvec3 ab = b.way_m - a.way_m;
    const double square = glm::dot(ab, ab), along = -glm::dot(a.way_m, ab);
    if (!(along > 0.0))
        return on_corner(a);
    if (!(along < square))
        return on_corner(b);
    return {{a, b}, {1.0 - along / square, along / square}, 2};
}

Subset nearer(const Subset& x, const Subset& y) noexcept {
    const dvec3 p = nearest_of(x), q = nearest_of(y);
    return glm::dot(q, q) < glm::dot(p, p) ? y : x;
}

Subset on_triangle(const Corner& a, const Corner& b, const Corner& c) noexcept {
    const dvec3 n = glm::cross(b.way_m - a.way_m, c.way_m - a.way_m);
    const double u = glm::dot(n, glm::cross(b.way_m, c.way_m));
    const double v = glm::dot(n, glm::cross(c.way_m, a.way_m));
    const double w = glm::dot(n, glm::cross(a.way_m, b.way_m));
    const double sum = u + v + w;
    if (u > 0.0 && v > 0.0 && w > 0.0 && sum > 0.0)
        return {{a, b, c}, {u / sum, v / sum, w / sum}, 3};
    return nearer(nearer(on_edge(a, b), on_edge(b, c)), on_edge(c, a));
}

// Whether the origin lies beyond the plane of a, b, c, seen from d. A tetrahedron so flat that
// rounding decides has it beyond every side.
bool beyond(const Corner& a, const Corner& b, const Corner& c, const Corner& d) noexcept {
    const dvec3 n = glm::cross(b.way_m - a.way_m, c.way_m - a.way_m);
    const double height = glm::dot(n, a.way_m - d.way_m); // times the length of n
    const double size_m = std::max(glm::length(a.way_m), glm::length(d.way_m));
    return !(glm::dot(n, a.way_m) * height > 0.0) ||
           !(std::abs(height) > kFlatHeight * glm::length(n) * size_m);
}

// False if the origin is inside.
bool reduce(Simplex& s) noexcept {
    const auto& [a, b, c, d] = s.corner;
    if (s.count == 2) {
        s = on_edge(a, b);
    } else if (s.count == 3) {
        s = on_triangle(a, b, c);
    } else if (s.count == 4) {
        constexpr std::array<std::array<int, 4>, 4> kSides{
            {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}}};
        Subset best;
        for (const auto& [i, j, k, l] : kSides) {
            const auto& q = s.corner;
            if (!beyond(q[i], q[j], q[k], q[l]))
                continue;
            const Subset side = on_triangle(q[i], q[j], q[k]);
            best = best.count == 0 ? side : nearer(best, side);
        }
        if (best.count == 0)
            return false;
        s = best;
    }
    return true;
}

bool has(const Simplex& s, const dvec3& way_m) noexcept {
    return std::any_of(s.corner.begin(), s.corner.begin() + s.count,
                       [&](const Corner& c) { return c.way_m == way_m; });
}

} // namespace

Separation separation(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a,
                      const dvec3& guess, double beyond_m) noexcept {
    const glm::dmat3 to_b = glm::transpose(b_in_a.rotation);
    std::uint32_t va = 0, vb = 0;
    const auto support = [&](const dvec3& n) -> Corner {
        va = farthest_vertex(a, n, va);
        vb = farthest_vertex(b, to_b * -n, vb);
        return {a.vertex_m[va] - to_world(b_in_a, b.vertex_m[vb]), a.vertex_m[va]};
    };
    const double touching_m = kTouching * (a.radius_m + b.radius_m);
    Simplex simplex;
    simplex.corner[0] = support(glm::dot(guess, guess) > 0.0 ? guess : dvec3{0.0, 0.0, 1.0});
    simplex.weight[0] = 1.0;
    simplex.count = 1;
    Separation result;
    double last_square = std::numeric_limits<double>::infinity();
    for (; result.steps < kMostSteps; ++result.steps) {
        const dvec3 v = nearest_of(simplex);
        const double square = glm::dot(v, v);
        if (square <= touching_m * touching_m)
            return result;
        const Corner next = support(-v);
        const double bound = glm::dot(v, next.way_m); // |v| times a lower bound of the distance
        const double length_m = std::sqrt(square);
        result.normal = -v / length_m;
        result.distance_m = length_m;
        if (bound > beyond_m * length_m) {
            result.apart = true;
            result.distance_m = bound / length_m;
            break;
        }
        // near enough, or as near as rounding lets it come: apart if that plane is between them
        if (square - bound <= kExact * square || has(simplex, next.way_m) ||
            square >= last_square || result.steps + 1 == kMostSteps) {
            result.apart = bound > 0.0;
            break;
        }
        last_square = square;
        simplex.corner[simplex.count++] = next;
        if (!reduce(simplex))
            return result;
    }
    for (int i = 0; i < simplex.count; ++i)
        result.on_a_m += simplex.weight[i] * simplex.corner[i].on_a_m;
    result.on_b_m = result.on_a_m + result.normal * result.distance_m;
    return result;
}

} // namespace haptics
