#include "haptics/rigid/rigid_shape.h"

#include "haptics/rigid/separation.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace haptics {
namespace {

using glm::dvec3;

std::uint32_t build(RigidShape& shape, std::span<std::uint32_t> order) {
    const auto at = static_cast<std::uint32_t>(shape.node.size());
    shape.node.emplace_back();
    if (order.size() == 1) {
        shape.node[at].hull = shape.piece[order[0]];
        shape.node[at].piece = order[0];
        return at;
    }
    std::vector<dvec3> point_m;
    dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};
    for (const std::uint32_t p : order) {
        const ConvexHull& piece = shape.piece[p];
        point_m.insert(point_m.end(), piece.vertex_m.begin(), piece.vertex_m.end());
        low = glm::min(low, piece.centre_m);
        high = glm::max(high, piece.centre_m);
    }
    shape.node[at].hull = convex_hull(point_m, shape.name);
    const dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::sort(order.begin(), order.end(), [&](std::uint32_t p, std::uint32_t q) {
        const double x = shape.piece[p].centre_m[axis], y = shape.piece[q].centre_m[axis];
        return x != y ? x < y : p < q;
    });
    const std::uint32_t left = build(shape, order.first(order.size() / 2));
    const std::uint32_t right = build(shape, order.subspan(order.size() / 2));
    shape.node[at].left = left;
    shape.node[at].right = right;
    return at;
}

bool near(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a,
          double margin_m) noexcept {
    const dvec3 way_m = to_world(b_in_a, b.centre_m) - a.centre_m;
    if (glm::length(way_m) > a.radius_m + b.radius_m + margin_m)
        return false;
    const Separation s = separation(a, b, b_in_a, way_m, margin_m);
    return !s.apart || s.distance_m <= margin_m;
}

} // namespace

RigidShape make_shape(std::string_view name, std::vector<ConvexHull> piece) {
    RigidShape shape;
    shape.name = name;
    shape.piece = std::move(piece);
    std::vector<std::uint32_t> order(shape.piece.size());
    std::iota(order.begin(), order.end(), 0u);
    if (!order.empty())
        build(shape, order);
    return shape;
}

void close_pairs(const RigidShape& a, const RigidShape& b, const RigidPose& b_in_a, double margin_m,
                 PairList& out) noexcept {
    out.count = out.dropped = 0;
    if (a.node.empty() || b.node.empty())
        return;
    Bounded<PiecePair, 128> open; // of nodes; each level leaves at most one behind
    open.add({0, 0});
    while (open.count > 0) {
        const PiecePair at = open.item[--open.count];
        const RigidShape::Node& p = a.node[at.a];
        const RigidShape::Node& q = b.node[at.b];
        if (!near(p.hull, q.hull, b_in_a, margin_m))
            continue;
        if (p.left == 0 && q.left == 0) {
            out.add({p.piece, q.piece});
        } else if (q.left == 0 || (p.left != 0 && p.hull.radius_m >= q.hull.radius_m)) {
            open.add({p.right, at.b});
            open.add({p.left, at.b});
        } else {
            open.add({at.a, q.right});
            open.add({at.a, q.left});
        }
    }
    out.dropped += open.dropped;
}

} // namespace haptics
