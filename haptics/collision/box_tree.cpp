#include "haptics/collision/box_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

namespace haptics {
namespace {

using glm::dvec3;
using Box = BoxTree::Box;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kLeafSize = 8;

// Ends of segments, projected places and points computed to lie on an edge are each rounded a few
// times, by half a bit of the largest coordinate.
constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();

void check(std::span<const dvec3> vertex_m,
           std::span<const std::array<std::uint32_t, 3>> triangle) {
    for (std::size_t v = 0; v < vertex_m.size(); ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            if (!std::isfinite(vertex_m[v][axis]))
                throw std::invalid_argument("box tree: vertex " + std::to_string(v) +
                                            " is not finite");
        }
    }
    for (std::size_t t = 0; t < triangle.size(); ++t) {
        for (const std::uint32_t v : triangle[t]) {
            if (v >= vertex_m.size())
                throw std::invalid_argument("box tree: triangle " + std::to_string(t) +
                                            " names vertex " + std::to_string(v) + " of " +
                                            std::to_string(vertex_m.size()));
        }
    }
}

// Appends the box of order[first, first + count) and, depth first, those in it, halving at the
// median of the longest side of the centres. Only topology: refit sets the places.
void split(BoxTree& tree, std::span<const dvec3> centre, std::span<std::uint32_t> order,
           std::uint32_t first, std::uint32_t count) {
    const std::size_t at = tree.box.size();
    tree.box.push_back({.first = first});
    if (count <= kLeafSize) {
        tree.box[at].count = static_cast<std::uint16_t>(count);
    } else {
        dvec3 low{kInfinity}, high{-kInfinity};
        for (const std::uint32_t t : order.subspan(first, count)) {
            low = glm::min(low, centre[t]);
            high = glm::max(high, centre[t]);
        }
        const dvec3 size = high - low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto begin = order.begin() + first;
        const std::uint32_t left = count / 2;
        // ties by number, so that the halves do not depend on the library
        std::nth_element(begin, begin + left, begin + count, [&](std::uint32_t a, std::uint32_t b) {
            return centre[a][axis] != centre[b][axis] ? centre[a][axis] < centre[b][axis] : a < b;
        });
        split(tree, centre, order, first, left);
        split(tree, centre, order, first + left, count - left);
    }
    tree.box[at].after = static_cast<std::uint32_t>(tree.box.size());
}

// Neighbours share vertices: a refit looks at each only once.
void list_corners(BoxTree& tree) {
    for (Box& box : tree.box) {
        box.first_corner = static_cast<std::uint32_t>(tree.corner.size());
        for (std::uint32_t i = box.first; i < box.first + box.count; ++i)
            for (const std::uint32_t v : tree.triangle[i])
                if (std::find(tree.corner.begin() + box.first_corner, tree.corner.end(), v) ==
                    tree.corner.end())
                    tree.corner.push_back(v);
        box.corners = static_cast<std::uint16_t>(tree.corner.size() - box.first_corner);
    }
}

// The segment's line seen along itself: z is the axis it is longest in, and shearing along z
// brings all of it to x = y = 0.
template <int Z> struct Line {
    static constexpr int X = (Z + 1) % 3, Y = (Z + 2) % 3;
    dvec3 from_m;
    double shear_x, shear_y;
    double low_m, high_m; // of z, from `from_m`
    double slack_m;

    dvec3 seen(const dvec3& place_m) const noexcept {
        const dvec3 p = place_m - from_m;
        return {p[X] - shear_x * p[Z], p[Y] - shear_y * p[Z], p[Z]};
    }
};

template <int Z>
Line<Z> make_line(const dvec3& from_m, const dvec3& to_m, double slack_m) noexcept {
    const dvec3 d = to_m - from_m;
    const bool point = d[Z] == 0.0; // no length: any direction will do
    return {.from_m = from_m,
            .shear_x = point ? 0.0 : d[Line<Z>::X] / d[Z],
            .shear_y = point ? 0.0 : d[Line<Z>::Y] / d[Z],
            .low_m = std::min(0.0, d[Z]) - slack_m,
            .high_m = std::max(0.0, d[Z]) + slack_m,
            .slack_m = slack_m};
}

// Twice the area of o, p, q. The sign is exact, or 0 where rounding hides it; q, p gives its
// negative to the bit.
double side(const dvec3& p, const dvec3& q) noexcept {
    return p.x * q.y - p.y * q.x;
}

// Less than this is nearer to the edge than slack.
double side_slack(const dvec3& p, const dvec3& q, double slack_m) noexcept {
    return slack_m * (std::abs(q.x - p.x) + std::abs(q.y - p.y) + slack_m);
}

struct Range {
    double low_m = kInfinity, high_m = -kInfinity;
    void add(double z_m) noexcept {
        low_m = std::min(low_m, z_m);
        high_m = std::max(high_m, z_m);
    }
};

// Adds the depths at which an edge lies within slack of the line.
void add_edge(Range& range, const dvec3& p, const dvec3& q, double slack_m) noexcept {
    const dvec3 e = q - p;
    const double square = e.x * e.x + e.y * e.y;
    const double reach_m = 2.0 * slack_m;
    const double middle = square > 0.0 ? -(p.x * e.x + p.y * e.y) / square : 0.5;
    const double nearest = std::clamp(middle, 0.0, 1.0);
    if (!(std::abs(p.x + nearest * e.x) <= reach_m && std::abs(p.y + nearest * e.y) <= reach_m))
        return;
    const double half = square > 0.0 ? reach_m / std::sqrt(square) : 1.0; // 0: along the line
    range.add(p.z + std::clamp(middle - half, 0.0, 1.0) * e.z);
    range.add(p.z + std::clamp(middle + half, 0.0, 1.0) * e.z);
}

// Whether the line passes the triangle a, b, c, as seen, between low and high.
template <int Z>
bool meets(const Line<Z>& line, const dvec3& a, const dvec3& b, const dvec3& c) noexcept {
    const double u = side(b, c), v = side(c, a), w = side(a, b);
    const double su = side_slack(b, c, line.slack_m), sv = side_slack(c, a, line.slack_m),
                 sw = side_slack(a, b, line.slack_m);
    if ((u < -su || v < -sv || w < -sw) && (u > su || v > sv || w > sw))
        return false;
    const double area = u + v + w;
    if (!(std::abs(area) < kInfinity))
        return false;
    // well inside: one depth
    const double z_m = (u * a.z + v * b.z + w * c.z) / area;
    if ((u > su && v > sv && w > sw) || (u < -su && v < -sv && w < -sw))
        return z_m >= line.low_m && z_m <= line.high_m;
    // at an edge, or the triangle is seen edge-on, or is none: all depths where it is met
    Range range;
    if (area != 0.0 && ((u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0)))
        range.add(z_m);
    add_edge(range, b, c, line.slack_m);
    add_edge(range, c, a, line.slack_m);
    add_edge(range, a, b, line.slack_m);
    return range.low_m <= line.high_m && range.high_m >= line.low_m;
}

// Slab test, with the slack put on the segment's start instead of on every box.
struct Slabs {
    dvec3 above_m, below_m; // from_m + slack, from_m - slack
    dvec3 inverse;          // of the direction, finite

    bool cross(const Box& box) const noexcept {
        const dvec3 a = (box.low_m - above_m) * inverse, b = (box.high_m - below_m) * inverse;
        const dvec3 in = glm::min(a, b), out = glm::max(a, b);
        return std::max(std::max(in.x, in.y), std::max(in.z, 0.0)) <=
               std::min(std::min(out.x, out.y), std::min(out.z, 1.0));
    }
};

Slabs make_slabs(const dvec3& from_m, const dvec3& to_m, double slack_m) noexcept {
    // a triangle is met within 2 slack of an edge; the rest is for the rounding of the slabs
    const dvec3 wide_m{4.0 * slack_m};
    const dvec3 most{std::numeric_limits<double>::max()}; // instead of infinity: 0 * most is 0
    return {.above_m = from_m + wide_m,
            .below_m = from_m - wide_m,
            .inverse = glm::clamp(1.0 / (to_m - from_m), -most, most)};
}

template <int Z>
bool any_hit(const BoxTree& tree, std::span<const dvec3> vertex_m, const dvec3& from_m,
             const dvec3& to_m, double slack_m) noexcept {
    const Slabs slabs = make_slabs(from_m, to_m, slack_m);
    const Line<Z> line = make_line<Z>(from_m, to_m, slack_m);
    const std::size_t boxes = tree.box.size();
    for (std::size_t at = 0; at < boxes;) {
        const Box& box = tree.box[at];
        if (!slabs.cross(box)) {
            at = box.after;
            continue;
        }
        for (std::uint32_t i = box.first; i < box.first + box.count; ++i) {
            const auto [a, b, c] = tree.triangle[i];
            if (meets(line, line.seen(vertex_m[a]), line.seen(vertex_m[b]), line.seen(vertex_m[c])))
                return true;
        }
        ++at; // into the box; of a leaf that is also what comes after it
    }
    return false;
}

double largest(const dvec3& v) noexcept {
    return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
}

double finite_or_zero(double x) noexcept {
    return std::isfinite(x) ? x : 0.0;
}

} // namespace

BoxTree make_box_tree(std::span<const dvec3> vertex_m,
                      std::span<const std::array<std::uint32_t, 3>> triangle) {
    check(vertex_m, triangle);
    BoxTree tree;
    if (triangle.empty())
        return tree;
    std::vector<dvec3> centre;
    for (const auto& [a, b, c] : triangle)
        centre.push_back((vertex_m[a] + vertex_m[b] + vertex_m[c]) / 3.0);
    std::vector<std::uint32_t> order(triangle.size());
    std::iota(order.begin(), order.end(), 0u);
    split(tree, centre, order, 0, static_cast<std::uint32_t>(order.size()));
    for (const std::uint32_t t : order)
        tree.triangle.push_back(triangle[t]);
    list_corners(tree);
    refit(tree, vertex_m);
    return tree;
}

void refit(BoxTree& tree, std::span<const dvec3> vertex_m) noexcept {
    for (std::size_t at = tree.box.size(); at-- > 0;) {
        Box& box = tree.box[at];
        if (box.count == 0) {
            const Box& left = tree.box[at + 1];
            const Box& right = tree.box[left.after];
            box.low_m = glm::min(left.low_m, right.low_m);
            box.high_m = glm::max(left.high_m, right.high_m);
            continue;
        }
        dvec3 low{kInfinity}, high{-kInfinity};
        for (std::uint32_t i = box.first_corner; i < box.first_corner + box.corners; ++i) {
            const dvec3& place = vertex_m[tree.corner[i]];
            low = glm::min(low, place); // keeps `low` if the place is not a number
            high = glm::max(high, place);
        }
        box.low_m = low;
        box.high_m = high;
    }
    tree.largest_m = 0.0;
    if (tree.box.empty())
        return;
    for (const dvec3& corner : {tree.box[0].low_m, tree.box[0].high_m}) {
        for (int axis = 0; axis < 3; ++axis)
            tree.largest_m = std::max(tree.largest_m, finite_or_zero(std::abs(corner[axis])));
    }
}

bool segment_hits(const BoxTree& tree, std::span<const dvec3> vertex_m, const dvec3& from_m,
                  const dvec3& to_m) noexcept {
    const dvec3 d = glm::abs(to_m - from_m);
    if (!std::isfinite(d.x + d.y + d.z))
        return false;
    const double slack_m = kRounding * std::max({tree.largest_m, largest(from_m), largest(to_m)});
    if (d.x >= d.y && d.x >= d.z)
        return any_hit<0>(tree, vertex_m, from_m, to_m, slack_m);
    if (d.y >= d.z)
        return any_hit<1>(tree, vertex_m, from_m, to_m, slack_m);
    return any_hit<2>(tree, vertex_m, from_m, to_m, slack_m);
}

} // namespace haptics
