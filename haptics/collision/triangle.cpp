#include "haptics/collision/triangle.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace haptics {
namespace {

using glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const dvec3 kAnywhere{0.0}; // outside of all edges, for all one knows
// Of a triangle whose height is less than this share of its length, weights lose digits; squared.
constexpr double kSliver = 1e-2;

double square(const dvec3& v) noexcept {
    return glm::dot(v, v);
}

/// Sets place and distance from the weights. From the corners as seen from the place, whose
/// differences are small where it matters, not from coordinates that may be a thousand metres.
void put(TrianglePoint& out, const TriangleCorners& seen, const dvec3& place) noexcept {
    const dvec3 offset = out.weight.x * seen[0] + out.weight.y * seen[1] + out.weight.z * seen[2];
    out.distance2_m2 = square(offset);
    out.place_m = place + offset;
}

/// Of the edges that the place is outside of, as the weights of their opposite corners say.
TrianglePoint on_nearest_edge(const TriangleCorners& seen, const dvec3& outside,
                              const dvec3& place) noexcept {
    TrianglePoint best{.distance2_m2 = kInfinity};
    for (int from = 0; from < 3; ++from) {
        const int to = (from + 1) % 3;
        if (outside[(from + 2) % 3] > 0.0)
            continue;
        const dvec3 edge = seen[to] - seen[from];
        const double length2 = square(edge), on = -glm::dot(seen[from], edge);
        const double s = !(on > 0.0) ? 0.0 : on >= length2 ? 1.0 : on / length2;
        const dvec3 offset = s == 1.0 ? seen[to] : seen[from] + s * edge;
        const double distance2 = square(offset);
        if (!(distance2 < best.distance2_m2))
            continue;
        best = {.place_m = place + offset, .distance2_m2 = distance2};
        best.weight[from] = 1.0 - s;
        best.weight[to] = s;
    }
    return best;
}

TrianglePoint on_corner(const TriangleCorners& corner, const TriangleCorners& seen,
                        int k) noexcept {
    TrianglePoint out{.place_m = corner[k], .distance2_m2 = square(seen[k])};
    out.weight[k] = 1.0;
    return out;
}

/// The foot of the perpendicular in a base along the longest edge and square to it (twice, or the
/// edge's own rounding outweighs the height of a sliver): off by roundings of the place only.
/// Weights may be negative.
dvec3 sliver_weights(const TriangleCorners& seen, int from) noexcept {
    const int to = (from + 1) % 3, tip = (from + 2) % 3;
    const dvec3 edge = seen[to] - seen[from], side = seen[tip] - seen[from];
    const double length = std::sqrt(square(edge));
    const dvec3 x = edge / length;
    dvec3 across = side - x * glm::dot(side, x);
    across -= x * glm::dot(across, x);
    const double up = -glm::dot(seen[from], across) / square(across);
    const double on = (-glm::dot(seen[from], x) - up * glm::dot(side, x)) / length;
    dvec3 weight;
    weight[from] = 1.0 - on - up;
    weight[to] = on;
    weight[tip] = up;
    return weight;
}

/// The nearest points of two lines, as a place along the first segment; 2: they are parallel.
/// By cross products: the squares of Ericson 5.1.9 lose twice as many digits if they nearly are.
double crossing_along(const dvec3& p, const dvec3& d, const dvec3& q, const dvec3& e) noexcept {
    const dvec3 c = glm::cross(d, e);
    const double c2 = square(c);
    return c2 > 0.0 ? std::clamp(glm::dot(glm::cross(q - p, e), c) / c2, 0.0, 1.0) : 2.0;
}

} // namespace

TriangleCorners MovingTriangle::at(double time) const noexcept {
    TriangleCorners out;
    for (int k = 0; k < 3; ++k)
        out[k] = before[k] + time * (after[k] - before[k]);
    return out;
}

TrianglePoint nearest_on_triangle(const TriangleCorners& corner, const dvec3& place_m) noexcept {
    const TriangleCorners seen{corner[0] - place_m, corner[1] - place_m, corner[2] - place_m};
    const dvec3 ab = corner[1] - corner[0], bc = corner[2] - corner[1], ca = corner[0] - corner[2];
    // before a corner: the cheapest case, and a frequent one
    for (int k = 0; k < 3; ++k) {
        const dvec3& next = k == 0 ? ab : k == 1 ? bc : ca;
        const dvec3& last = k == 0 ? ca : k == 1 ? ab : bc;
        if (glm::dot(seen[k], next) >= 0.0 && glm::dot(seen[k], last) <= 0.0)
            return on_corner(corner, seen, k);
    }
    const dvec3 n = glm::cross(ab, -ca);
    const double n2 = square(n);
    if (!(n2 < kInfinity))
        return {.distance2_m2 = kInfinity}; // a corner is not finite
    if (n2 == 0.0)
        return on_nearest_edge(seen, kAnywhere, place_m);
    const double ab2 = square(ab), bc2 = square(bc), ca2 = square(ca);
    const double longest2 = std::max({ab2, bc2, ca2});
    const bool sliver = n2 < kSliver * longest2 * longest2;
    TrianglePoint out;
    if (sliver) {
        out.weight = sliver_weights(seen, longest2 == ab2 ? 0 : longest2 == bc2 ? 1 : 2);
    } else {
        // areas seen from the foot: with an edge as second factor, so that a far place costs
        // digits once and not twice
        out.weight = {glm::dot(n, glm::cross(seen[1], bc)), glm::dot(n, glm::cross(seen[2], ca)),
                      glm::dot(n, glm::cross(seen[0], ab))};
        out.weight /= out.weight.x + out.weight.y + out.weight.z;
    }
    if (!(out.weight.x >= 0.0 && out.weight.y >= 0.0 && out.weight.z >= 0.0))
        return on_nearest_edge(seen, sliver ? kAnywhere : out.weight, place_m);
    put(out, seen, place_m);
    if (!sliver && std::isfinite(out.distance2_m2))
        return out;
    const TrianglePoint edge = on_nearest_edge(seen, kAnywhere, place_m);
    return out.distance2_m2 <= edge.distance2_m2 ? out : edge;
}

SegmentPair nearest_to_segment(const TriangleCorners& corner, const dvec3& from_m,
                               const dvec3& to_m) noexcept {
    const dvec3 d = to_m - from_m;
    SegmentPair best{nearest_on_triangle(corner, from_m), 0.0, from_m};
    const auto try_along = [&](double s) {
        const dvec3 place = s == 1.0 ? to_m : from_m + s * d;
        const TrianglePoint on = nearest_on_triangle(corner, place);
        if (on.distance2_m2 < best.on_triangle.distance2_m2)
            best = {on, s, place};
    };
    try_along(1.0);
    const dvec3 n = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double above = glm::dot(n, from_m - corner[0]), below = glm::dot(n, to_m - corner[0]);
    if ((above > 0.0 && below < 0.0) || (above < 0.0 && below > 0.0)) {
        double s = std::clamp(above / (above - below), 0.0, 1.0), last2 = kInfinity;
        try_along(s);
        // where a sliver is crossed its normal says only roughly: again, from the place found
        while (best.along == s && best.on_triangle.distance2_m2 < 0.25 * last2) {
            last2 = best.on_triangle.distance2_m2;
            s -= glm::dot(n, best.place_m - best.on_triangle.place_m) / (below - above);
            try_along(std::clamp(s, 0.0, 1.0));
        }
    }
    const double d2 = square(d);
    if (!(d2 > 0.0))
        return best;
    for (int k = 0; k < 3; ++k) {
        try_along(std::clamp(glm::dot(corner[k] - from_m, d) / d2, 0.0, 1.0));
        const dvec3 edge = corner[(k + 1) % 3] - corner[k];
        if (const double s = crossing_along(from_m, d, corner[k], edge); s <= 1.0)
            try_along(s);
    }
    return best;
}

} // namespace haptics
