// Compiled once for each instruction set; which one runs is decided at the first question.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "haptics/collision/near_leaves.cpp"
#include "haptics/collision/near_leaves.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

#include "haptics/collision/near_leaves_lanes.h"
#include "haptics/collision/wide_tree_ring.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

HWY_BEFORE_NAMESPACE();
namespace haptics::HWY_NAMESPACE {
namespace {

// True: the ring is of this tree and holds all that is within the radius.
bool holds(const WideRing& ring, const Asked& asked, float radius) noexcept {
    return ring.version == asked.tree.version && ring.reach > 0.0f &&
           radius <= ring.reach - distance(asked.place, ring.centre) - 4.0f * asked.slack;
}

// Which of eight are met goes either way: a branch for each would be guessed wrong too often, so
// numbers are packed side by side without any.
HWY_INLINE int pack(hn::Mask<D> mask, const std::uint32_t* number, std::uint32_t* out) {
    const hn::RebindToUnsigned<D> du;
    hn::StoreU(hn::Compress(hn::LoadU(du, number), hn::RebindMask(du, mask)), du, out);
    return static_cast<int>(hn::CountTrue(D{}, mask));
}

using Leaves = std::array<std::uint32_t, WideRing::kRoom + kWidth>;

// The leaves of the ring that come within `reach`.
int leaves_of_ring(const WideRing& ring, const Asked& asked, float reach, Leaves& out) {
    const D d;
    const float reach2 = reach * reach;
    alignas(64) std::array<float, kWidth> distance2;
    int count = 0;
    for (std::uint32_t eights = eights_within(ring, asked.place.data(), reach2); eights != 0;
         eights &= eights - 1) {
        const int eight = std::countr_zero(eights), first = eight * kWidth;
        child_distance2(RingRows{ring, eight}, true, asked.place.data(), reach2, distance2.data());
        for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d))) {
            const auto met = hn::Le(hn::Load(d, distance2.data() + lane), hn::Set(d, reach2));
            count += pack(hn::And(met, hn::FirstN(d, std::max(0, ring.leaves - first - lane))),
                          ring.eight[eight].leaf.data() + lane, out.data() + count);
        }
    }
    return count;
}

// Calls look(leaf) for the leaves of the tree that come within `reach`.
template <class Look> void search_within(const Asked& asked, float reach, Look&& look) {
    std::array<std::uint32_t, wide_detail::kMostDepth * kWidth> stack;
    int top = 0;
    stack[top++] = 0;
    alignas(64) std::array<float, kWidth> distance2;
    while (top > 0) {
        const std::uint32_t at = stack[--top];
        const WideTree::Node& node = asked.tree.node[at];
        child_distance2(NodeRows{node, asked.tree.slabs[at]}, has_leaves(node), asked.place.data(),
                        reach * reach, distance2.data());
        for (std::uint32_t met = bits_within(distance2.data(), reach * reach); met != 0;
             met &= met - 1) {
            const std::uint32_t child = node.child[std::countr_zero(met)];
            if ((child & WideTree::kLeafBit) != 0)
                look(child & ~WideTree::kLeafBit);
            else
                stack[top++] = child;
        }
    }
}

// A plane for each triangle of the leaf; the nearest to the centre.
HWY_INLINE float make_planes(const WideTree::Leaf& leaf, const View& view,
                             std::array<std::array<float, kWidth>, 4>& plane) {
    const D d;
    const Vec3 centre = same(glm::dvec3{0.0});
    V nearest = hn::Set(d, kFar);
    for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d))) {
        const Eight t = eight_of(leaf, lane, view);
        const Vec3 away = offset(t, centre);
        const V one = hn::Div(hn::Set(d, 1.0f), length(away));
        const Vec3 n{hn::Mul(away.x, one), hn::Mul(away.y, one), hn::Mul(away.z, one)};
        const V far = hn::Add(farthest(t, n), t.rounding);
        // where no direction is found it may be as near as can be
        const V known = hn::IfThenElse(hn::Lt(far, hn::Set(d, kFar)), far, hn::Set(d, kFar));
        const auto finite = hn::Lt(t.rounding, hn::Set(d, kFar)); // there is a triangle
        const V offset = hn::IfThenElse(finite, known, hn::Set(d, -kFar));
        hn::Store(n.x, d, plane[0].data() + lane);
        hn::Store(n.y, d, plane[1].data() + lane);
        hn::Store(n.z, d, plane[2].data() + lane);
        hn::Store(offset, d, plane[3].data() + lane);
        nearest = hn::Min(nearest, hn::Sub(hn::Zero(d), offset));
    }
    return std::max(0.0f, hn::GetLane(hn::MinOfLanes(d, nearest)));
}

// Puts a leaf among those near if it is. False: no room for it.
HWY_INLINE bool put(const WideTree::Leaf& leaf, const View& view, float reach, NearLeaves& out) {
    if (out.count == NearLeaves::kRoom)
        return false;
    const float least = make_planes(leaf, view, out.plane[out.count]);
    out.leaf[out.count] = &leaf;
    out.least_of_leaf[out.count] = least;
    out.count += least <= reach; // it could go either way: a branch would be guessed wrong often
    return true;
}

bool near_of_tree(const WideTree& tree, const glm::dvec3& centre_m, double reach_m, WideRing& ring,
                  NearLeaves& out) {
    const glm::dvec3 p = tree.to_tree(centre_m);
    const double radius = reach_m * tree.scale_pm;
    if (tree.node.empty() || !(std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < 1e18) ||
        !(radius >= 0.0 && radius < 1e18))
        return true;
    ++ring.asked;
    const Asked asked{tree, p};
    const float reach = static_cast<float>(radius) + 2.0f * asked.slack;
    const View view = view_from(out);
    bool room = true;
    const auto look = [&](std::uint32_t at) {
        room = room && put(tree.leaf[at], view, reach, out);
    };
    if (holds(ring, asked, reach) || (make_ring(ring, asked, reach) && holds(ring, asked, reach))) {
        Leaves leaf;
        const int count = leaves_of_ring(ring, asked, reach, leaf);
        for (int i = 0; i < count; ++i)
            look(leaf[i]);
        ring.last_place = asked.place;
    } else {
        search_within(asked, reach, look);
    }
    return room;
}

// Of leaves that were made around the centre: they are few, and all near.
void put_made(int made, NearLeaves& out) {
    const View view = view_from(out);
    for (int i = 0; i < made; ++i)
        put(out.made[i], view, kFar, out);
}

// The two ends of a path, and what is to be kept off it.
struct Path {
    Vec3 from, to;
    V radius; // and the rounding of both
};

// Both ends are in front of a plane across `out` that has all corners behind it.
HWY_INLINE hn::Mask<D> parts(const Eight& t, const Path& path, const Vec3& out) {
    const V ahead = hn::Min(dot(out, path.from), dot(out, path.to));
    const V apart = hn::Add(path.radius, t.rounding);
    return hn::Ge(hn::Sub(ahead, farthest(t, out)), hn::Mul(apart, length(out)));
}

// Both are in front of the plane that is known. (No triangle: infinity is more than anything.)
HWY_INLINE hn::Mask<D> known_to_part(const NearLeaves& near, int leaf, int lane, const Path& path) {
    const D d;
    const auto row = [&](int k) { return hn::Load(d, near.plane[leaf][k].data() + lane); };
    const Vec3 n{row(0), row(1), row(2)};
    const V ahead = hn::Min(dot(n, path.from), dot(n, path.to)), offset = row(3);
    return hn::Or(hn::Ge(hn::Sub(ahead, offset), path.radius), hn::Eq(offset, hn::Set(d, -kFar)));
}

constexpr auto kPlaceOf = [] {
    std::array<std::uint32_t, NearLeaves::kPlaces> out{};
    for (std::uint32_t i = 0; i < out.size(); ++i)
        out[i] = i;
    return out;
}();

int paths_meet(const NearLeaves& near, const glm::dvec3& from_m, const glm::dvec3& to_m,
               double radius_m, std::uint32_t* found) {
    const D d;
    const glm::dvec3 from = (from_m - near.centre_m) * near.scale_pm,
                     to = (to_m - near.centre_m) * near.scale_pm;
    const double off = std::max(glm::length(from), glm::length(to));
    const double radius = radius_m * near.scale_pm;
    const float thick = static_cast<float>(radius + kRounding * (off + radius));
    const View view = view_from(near);
    const Path path{same(from), same(to), hn::Set(d, thick)};
    const float bound = thick + static_cast<float>(off);
    std::array<std::uint32_t, NearLeaves::kRoom> open; // leaves whose planes do not say
    int opens = 0;
    for (int i = 0; i < near.count; ++i) {
        bool known = true;
        for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d)))
            known = known && hn::AllTrue(d, known_to_part(near, i, lane, path));
        open[opens] = static_cast<std::uint32_t>(i);
        opens += !known && near.least_of_leaf[i] <= bound;
    }
    const bool moved = from != glm::dvec3{0.0} && from != to; // from where the planes are of
    int count = 0;
    for (int k = 0; k < opens; ++k)
        for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d))) {
            const int i = static_cast<int>(open[k]);
            const Eight t = eight_of(*near.leaf[i], lane, view);
            auto parted =
                hn::Or(known_to_part(near, i, lane, path), parts(t, path, offset(t, path.to)));
            if (moved)
                parted = hn::Or(parted, parts(t, path, offset(t, path.from)));
            count += pack(hn::Not(parted), kPlaceOf.data() + i * kWidth + lane, found + count);
        }
    return count;
}

// Those whose planes do not say that they are farther than `bound` from the centre.
int touch(const NearLeaves& near, float bound, std::uint32_t* found) {
    const D d;
    int count = 0;
    for (int i = 0; i < near.count; ++i)
        for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d))) {
            const V offset = hn::Load(d, near.plane[i][3].data() + lane);
            count += pack(hn::Ge(offset, hn::Set(d, -bound)), kPlaceOf.data() + i * kWidth + lane,
                          found + count);
        }
    return count;
}

} // namespace
} // namespace haptics::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace haptics {

HWY_EXPORT(near_of_tree);
HWY_EXPORT(put_made);
HWY_EXPORT(touch);
HWY_EXPORT(paths_meet);

namespace {

// Any method but ours: boxes say who may be near, the triangles themselves who is.
template <class Method>
bool make_leaves(const Method& method, const MeshView& mesh, const glm::dvec3& centre_m,
                 double reach_m, NearLeaves& out) noexcept {
    int found = 0;
    double far_m = 0.0; // of what is left of the triangles
    bool room = true;
    Reach reach{centre_m, centre_m, reach_m};
    visit(method, reach, [&](std::uint32_t t) {
        for (int i = 0; i < found; ++i)
            if (out.made[i / NearLeaves::kWidth].triangle[i % NearLeaves::kWidth] == t)
                return; // a method may visit a triangle twice
        const TriangleCorners corner = mesh.corners(t);
        if (!(nearest_on_triangle(corner, centre_m).distance2_m2 <= reach_m * reach_m))
            return;
        if (found == NearLeaves::kMade * NearLeaves::kWidth) {
            room = false;
            return;
        }
        WideTree::Leaf& of = out.made[found / NearLeaves::kWidth];
        if (found % NearLeaves::kWidth == 0)
            of.triangle.fill(WideTree::kNothing);
        of.triangle[found % NearLeaves::kWidth] = t;
        of.vertex[found % NearLeaves::kWidth] = mesh.triangle[t];
        ++found;
        for (const glm::dvec3& c : corner)
            far_m = std::max(far_m, glm::length(c - centre_m));
    });
    // a power of two, for the same answers in any unit
    out.scale_pm = far_m > 0.0 ? std::exp2(-std::ceil(std::log2(far_m))) : 1.0;
    out.origin_m = centre_m;
    for (int i = 0; i < found; ++i) {
        WideTree::Leaf& leaf = out.made[i / NearLeaves::kWidth];
        const int lane = i % NearLeaves::kWidth;
        if (lane == 0)
            std::fill_n(&leaf.corner[0][0][0], 9 * NearLeaves::kWidth,
                        std::numeric_limits<float>::quiet_NaN());
        const TriangleCorners corner = mesh.corners(leaf.triangle[lane]);
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                leaf.corner[k][axis][lane] =
                    static_cast<float>((corner[k][axis] - centre_m[axis]) * out.scale_pm);
    }
    HWY_DYNAMIC_DISPATCH(put_made)((found + NearLeaves::kWidth - 1) / NearLeaves::kWidth, out);
    return room;
}

} // namespace

bool find_near(const CollisionIndex& index, const MeshView& mesh, const glm::dvec3& centre_m,
               double reach_m, WideRing& ring, NearLeaves& out) noexcept {
    out.count = 0;
    out.centre_m = centre_m;
    out.reach_m = reach_m;
    out.mesh = mesh;
    if (const auto* tree = std::get_if<WideTree>(&index)) {
        out.origin_m = tree->origin_m;
        out.scale_pm = tree->scale_pm;
        return HWY_DYNAMIC_DISPATCH(near_of_tree)(*tree, centre_m, reach_m, ring, out);
    }
    return std::visit(
        [&](const auto& method) { return make_leaves(method, mesh, centre_m, reach_m, out); },
        index);
}

int may_meet(const NearLeaves& near, const glm::dvec3& from_m, const glm::dvec3& to_m,
             double radius_m, Places& out) noexcept {
    return HWY_DYNAMIC_DISPATCH(paths_meet)(near, from_m, to_m, radius_m, out.data());
}

int may_touch(const NearLeaves& near, double radius_m, Places& out) noexcept {
    return HWY_DYNAMIC_DISPATCH(touch)(near, near.bound(radius_m), out.data());
}

int nearest_place(const NearLeaves& near) noexcept {
    int nearest = -1;
    float least = std::numeric_limits<float>::infinity();
    for (int i = 0; i < near.count; ++i)
        for (int lane = 0; lane < NearLeaves::kWidth && near.least_of_leaf[i] < least; ++lane)
            if (const int place = i * NearLeaves::kWidth + lane; near.least(place) < least) {
                least = near.least(place);
                nearest = place;
            }
    return nearest;
}

} // namespace haptics
#endif
