// haptics/collision/wide_tree_lanes.h
// Eight triangles, eight boxes, eight children of a node at once: the SIMD arithmetic of the wide
// tree. Included once for each instruction set, by wide_tree_query.cpp and near_leaves.cpp only,
// after highway.h.
#if defined(TROCAR_WIDE_TREE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef TROCAR_WIDE_TREE_LANES
#undef TROCAR_WIDE_TREE_LANES
#else
#define TROCAR_WIDE_TREE_LANES
#endif

#include "haptics/collision/wide_tree.h"

#include <hwy/highway.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace haptics::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr int kWidth = WideTree::kWidth;
using D = hn::CappedTag<float, kWidth>; // four lanes at a time where there are no eight
using V = hn::Vec<D>;
constexpr float kFar = std::numeric_limits<float>::infinity();

struct Vec3 {
    V x, y, z;
};

HWY_INLINE Vec3 operator-(const Vec3& a, const Vec3& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V dot(const Vec3& a, const Vec3& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
    return {hn::NegMulAdd(a.z, b.y, hn::Mul(a.y, b.z)), hn::NegMulAdd(a.x, b.z, hn::Mul(a.z, b.x)),
            hn::NegMulAdd(a.y, b.x, hn::Mul(a.x, b.y))};
}

// Square of the distance to the segment from p's foot: p given relative to the segment's start.
HWY_INLINE V edge_distance2(const Vec3& p, const Vec3& edge, V length2) {
    const D d;
    const V tiny = hn::Set(d, std::numeric_limits<float>::min());
    const V along = hn::Div(dot(p, edge), hn::Max(length2, tiny));
    const V s = hn::Min(hn::Max(along, hn::Zero(d)), hn::Set(d, 1.0f));
    const Vec3 r{hn::NegMulAdd(s, edge.x, p.x), hn::NegMulAdd(s, edge.y, p.y),
                 hn::NegMulAdd(s, edge.z, p.z)};
    return dot(r, r);
}

// Squares of the distances to a leaf's triangles; returns the least. In a triangle with an angle
// below 6 degrees rounding turns the plane too far: it gets a bound, the distance to its edges less
// its height, and counts with the edges.
HWY_INLINE float leaf_distance2(const WideTree::Leaf& leaf, const float* place, float* out) {
    const D d;
    V known = hn::Set(d, kFar);
    const Vec3 p{hn::Set(d, place[0]), hn::Set(d, place[1]), hn::Set(d, place[2])};
    for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d))) {
        const auto corner = [&](int k) {
            return Vec3{hn::Load(d, leaf.corner[k][0] + lane),
                        hn::Load(d, leaf.corner[k][1] + lane),
                        hn::Load(d, leaf.corner[k][2] + lane)};
        };
        const Vec3 a = corner(0), b = corner(1), c = corner(2);
        const Vec3 ab = b - a, ac = c - a, bc = c - b, ap = p - a, bp = p - b;
        const V ab2 = dot(ab, ab), ac2 = dot(ac, ac);
        const V edges = hn::Min(hn::Min(edge_distance2(ap, ab, ab2), edge_distance2(ap, ac, ac2)),
                                edge_distance2(bp, bc, dot(bc, bc)));
        const Vec3 n = cross(ab, ac);
        const V n2 = dot(n, n);
        const V beside_b = dot(n, cross(ap, ac)), beside_c = dot(n, cross(ab, ap));
        const V beside_a = hn::Sub(hn::Sub(n2, beside_b), beside_c);
        const auto inside =
            hn::And(hn::And(hn::Ge(beside_a, hn::Zero(d)), hn::Ge(beside_b, hn::Zero(d))),
                    hn::And(hn::Ge(beside_c, hn::Zero(d)), hn::Gt(n2, hn::Zero(d))));
        const V height = dot(n, ap);
        V nearest = hn::IfThenElse(inside, hn::Div(hn::Mul(height, height), n2), edges);
        const auto sliver = hn::Le(n2, hn::Mul(hn::Set(d, 0.01f), hn::Mul(ab2, ac2)));
        const V sure = hn::IfThenElse(sliver, edges, nearest);
        known = hn::Min(known, hn::IfThenElse(hn::Eq(sure, sure), sure, known));
        if (HWY_UNLIKELY(!hn::AllFalse(d, sliver))) {
            const V longest2 = hn::Max(hn::Max(ab2, ac2), hn::Set(d, 1e-36f));
            const V less = hn::Sub(hn::Sqrt(edges), hn::Sqrt(hn::Div(n2, longest2)));
            const V bound = hn::Max(less, hn::Zero(d));
            nearest = hn::IfThenElse(sliver, hn::Min(nearest, hn::Mul(bound, bound)), nearest);
        }
        // a triangle that is not finite, or none, is infinitely far
        hn::Store(hn::IfThenElse(hn::Eq(nearest, nearest), nearest, hn::Set(d, kFar)), d,
                  out + lane);
    }
    return hn::GetLane(hn::MinOfLanes(d, known));
}

HWY_INLINE V box_distance2(const Vec3& low, const Vec3& high, const Vec3& p) {
    const D d;
    const V zero = hn::Zero(d);
    const V x = hn::Max(hn::Max(hn::Sub(low.x, p.x), hn::Sub(p.x, high.x)), zero);
    const V y = hn::Max(hn::Max(hn::Sub(low.y, p.y), hn::Sub(p.y, high.y)), zero);
    const V z = hn::Max(hn::Max(hn::Sub(low.z, p.z), hn::Sub(p.z, high.z)), zero);
    return hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
}

// A leaf lies in its slab and in the ball around its box: square of the distance to that disc.
HWY_INLINE V disc_distance2(const Vec3& low, const Vec3& high, const Vec3& normal, V slab_low,
                            V slab_high, const Vec3& p) {
    const D d;
    const V half = hn::Set(d, 0.5f), zero = hn::Zero(d);
    const Vec3 size = high - low;
    const Vec3 from_centre{hn::NegMulAdd(half, hn::Add(low.x, high.x), p.x),
                           hn::NegMulAdd(half, hn::Add(low.y, high.y), p.y),
                           hn::NegMulAdd(half, hn::Add(low.z, high.z), p.z)};
    const V radius = hn::Mul(half, hn::Sqrt(dot(size, size)));
    const V height = dot(normal, from_centre), z = dot(normal, p);
    const V beside2 = hn::Max(hn::NegMulAdd(height, height, dot(from_centre, from_centre)), zero);
    const V beside = hn::Max(hn::Sub(hn::Sqrt(beside2), radius), zero);
    const V above = hn::Max(hn::Max(hn::Sub(slab_low, z), hn::Sub(z, slab_high)), zero);
    return hn::MulAdd(beside, beside, hn::Mul(above, above));
}

// Rows of the eight children of a node, and of eight leaves of a ring: the same questions.
struct NodeRows {
    const WideTree::Node& node;
    const WideTree::Slabs& slabs;
    const float* operator()(int row) const {
        return row < 3    ? node.low[row]
               : row < 6  ? node.high[row - 3]
               : row < 9  ? slabs.normal[row - 6]
               : row == 9 ? slabs.low
                          : slabs.high;
    }
};
struct RingRows {
    const WideRing& ring;
    int eight;
    const float* operator()(int row) const { return ring.eight[eight].row[row].data(); }
};

struct AroundRows {
    const WideRing& ring;
    const float* operator()(int row) const { return ring.around[row % 6].data(); }
};

// Squares of distances below which nothing of a child can be; slabs only where a box is within
// `limit2`, and only if the children are leaves.
template <class Rows>
HWY_INLINE void child_distance2(const Rows& rows, bool leaves, const float* place, float limit2,
                                float* out) {
    const D d;
    const Vec3 p{hn::Set(d, place[0]), hn::Set(d, place[1]), hn::Set(d, place[2])};
    for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d))) {
        const auto row = [&](int k) { return hn::LoadU(d, rows(k) + lane); };
        const Vec3 low{row(0), row(1), row(2)}, high{row(3), row(4), row(5)};
        V nearest = box_distance2(low, high, p);
        if (leaves && !hn::AllFalse(d, hn::Le(nearest, hn::Set(d, limit2))))
            nearest = hn::Max(
                nearest, disc_distance2(low, high, {row(6), row(7), row(8)}, row(9), row(10), p));
        hn::Store(nearest, d, out + lane);
    }
}

bool has_leaves(const WideTree::Node& node) {
    return (node.child[0] & WideTree::kLeafBit) != 0;
}

// Bit by bit, which of eight are no more than `limit`.
HWY_INLINE std::uint32_t bits_within(const float* eight, float limit) {
    const D d;
    std::uint32_t out = 0;
    for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d))) {
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, hn::Le(hn::Load(d, eight + lane), hn::Set(d, limit)), bits);
        out |= static_cast<std::uint32_t>(bits[0]) << lane;
    }
    return out;
}

} // namespace
} // namespace haptics::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
