// haptics/collision/near_leaves_lanes.h
// Eight triangles as seen from a place close by, and planes that they are behind. Included once for
// each instruction set, by near_leaves.cpp only.
#if defined(TROCAR_NEAR_LEAVES_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef TROCAR_NEAR_LEAVES_LANES
#undef TROCAR_NEAR_LEAVES_LANES
#else
#define TROCAR_NEAR_LEAVES_LANES
#endif

#include "haptics/collision/near_leaves.h"
#include "haptics/collision/wide_tree_ring.h"

#include <glm/geometric.hpp>

HWY_BEFORE_NAMESPACE();
namespace haptics::HWY_NAMESPACE {
namespace {

// Where everything is seen from: the centre, in the leaves' scale, as a float and what is left of
// it.
struct View {
    Vec3 high, low;
    V rounding; // a corner is right to half an ulp of the tree's frame
};

HWY_INLINE Vec3 same(const glm::dvec3& v) {
    const D d;
    return {hn::Set(d, static_cast<float>(v.x)), hn::Set(d, static_cast<float>(v.y)),
            hn::Set(d, static_cast<float>(v.z))};
}

HWY_INLINE View view_from(const NearLeaves& near) {
    const glm::dvec3 centre = (near.centre_m - near.origin_m) * near.scale_pm;
    const std::array<float, 3> high = to_float(centre);
    return {same(centre), same(centre - glm::dvec3{high[0], high[1], high[2]}),
            hn::Set(D{}, static_cast<float>(0x1p-24 * glm::length(centre)))};
}

struct Eight {
    Vec3 a, b, c;
    V rounding; // of a distance along any direction
};

HWY_INLINE V length(const Vec3& v) {
    return hn::Sqrt(dot(v, v));
}

// Each operation rounds by 2^-24 of its numbers, of which some 16 follow one another.
constexpr float kRounding = 16.0f * 0x1p-24f;

HWY_INLINE Eight eight_of(const WideTree::Leaf& leaf, int lane, const View& view) {
    const D d;
    const auto corner = [&](int k) {
        const Vec3 at{hn::Load(d, leaf.corner[k][0] + lane), hn::Load(d, leaf.corner[k][1] + lane),
                      hn::Load(d, leaf.corner[k][2] + lane)};
        return (at - view.high) - view.low;
    };
    Eight t{corner(0), corner(1), corner(2), {}};
    // the sum, not the largest: it tells if anything is not a number
    const V far2 = hn::Add(dot(t.a, t.a), hn::Add(dot(t.b, t.b), dot(t.c, t.c)));
    t.rounding = hn::MulAdd(hn::Sqrt(far2), hn::Set(d, kRounding), view.rounding);
    return t;
}

// From the segment to the point: what is left of p, given from the segment's start.
HWY_INLINE Vec3 off_edge(const Vec3& p, const Vec3& edge) {
    const D d;
    const V along = hn::Mul(dot(p, edge), hn::ApproximateReciprocal(dot(edge, edge)));
    const V s = hn::Min(hn::Max(along, hn::Zero(d)), hn::Set(d, 1.0f));
    return {hn::NegMulAdd(s, edge.x, p.x), hn::NegMulAdd(s, edge.y, p.y),
            hn::NegMulAdd(s, edge.z, p.z)};
}

HWY_INLINE Vec3 choose(hn::Mask<D> mask, const Vec3& yes, const Vec3& no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
            hn::IfThenElse(mask, yes.z, no.z)};
}

// From the triangles to a place, roughly: any direction will do.
HWY_INLINE Vec3 offset(const Eight& t, const Vec3& p) {
    const D d;
    const Vec3 ab = t.b - t.a, ac = t.c - t.a, bc = t.c - t.b;
    const Vec3 ap = p - t.a, bp = p - t.b, n = cross(ab, ac);
    Vec3 best = off_edge(ap, ab);
    const Vec3 second = off_edge(ap, ac), third = off_edge(bp, bc);
    V best2 = dot(best, best);
    const V second2 = dot(second, second), third2 = dot(third, third);
    best = choose(hn::Lt(second2, best2), second, best);
    best2 = hn::Min(second2, best2);
    best = choose(hn::Lt(third2, best2), third, best);
    const V n2 = dot(n, n);
    const V beside_b = dot(n, cross(ap, ac)), beside_c = dot(n, cross(ab, ap));
    const V beside_a = hn::Sub(hn::Sub(n2, beside_b), beside_c);
    const auto inside = hn::And(hn::Ge(hn::Min(beside_a, hn::Min(beside_b, beside_c)), hn::Zero(d)),
                                hn::Gt(n2, hn::Zero(d)));
    const V height = hn::Mul(dot(n, ap), hn::ApproximateReciprocal(n2));
    return choose(inside, {hn::Mul(n.x, height), hn::Mul(n.y, height), hn::Mul(n.z, height)}, best);
}

// Of the corners, along a direction.
HWY_INLINE V farthest(const Eight& t, const Vec3& n) {
    return hn::Max(dot(n, t.a), hn::Max(dot(n, t.b), dot(n, t.c)));
}

} // namespace
} // namespace haptics::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
