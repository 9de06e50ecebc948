// Compiled once for each instruction set; which one runs is decided at the first question.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "haptics/collision/wide_tree_query.cpp"
#include "haptics/collision/wide_tree.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

#include "haptics/collision/wide_tree_lanes.h"

#include <algorithm>
#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace haptics::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

float distance(const std::array<float, 3>& a, const std::array<float, 3>& b) noexcept {
    const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return std::sqrt(x * x + y * y + z * z);
}

std::array<float, 3> to_float(const glm::dvec3& p) noexcept {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

// What one question has seen so far: leaves, and how far their triangles are in float.
struct Seen {
    static constexpr int kRoom = 72;

    const WideTree& tree;
    std::array<float, 3> place;
    float slack;
    float best2;         // float distance of the nearest so far; at first the radius asked for
    float limit, limit2; // a box or triangle farther than this cannot hold the nearest
    int leaves = 0;
    bool full = false;
    std::array<std::uint32_t, kRoom> leaf;
    alignas(32) std::array<std::array<float, kWidth>, kRoom> distance2;

    Seen(const WideTree& t, const glm::dvec3& p, double radius) noexcept
        : tree(t), place(to_float(p)), slack(static_cast<float>(wide_detail::slack(p))) {
        const float r = static_cast<float>(std::min(radius, 1e18));
        best2 = r * r;
        set_limit();
    }
    void set_limit() noexcept {
        limit = std::sqrt(best2) + 2.0f * slack;
        limit2 = limit * limit;
    }
    void make_room() noexcept {
        int kept = 0;
        for (int i = 0; i < leaves; ++i)
            if (bits_within(distance2[i].data(), limit2) != 0) {
                leaf[kept] = leaf[i];
                distance2[kept++] = distance2[i];
            }
        leaves = kept;
        full = leaves == kRoom;
    }
    void look(std::uint32_t at) noexcept {
        if (leaves == kRoom)
            make_room();
        if (full)
            return;
        float* out = distance2[leaves].data();
        const float nearest = leaf_distance2(tree.leaf[at], place.data(), out);
        if (bits_within(out, limit2) == 0)
            return;
        leaf[leaves++] = at;
        if (nearest < best2) {
            best2 = nearest;
            set_limit();
        }
    }
};

// From the root, the nearer boxes first. Leaves `seen.full` set if far too many are equally near.
void search(Seen& seen) noexcept {
    struct Open {
        float distance2;
        std::uint32_t at;
    };
    std::array<Open, wide_detail::kMostDepth * kWidth> stack;
    int top = 0;
    stack[top++] = {0.0f, 0};
    alignas(32) std::array<float, kWidth> distance2;
    while (top > 0) {
        const Open open = stack[--top];
        if (open.distance2 > seen.limit2)
            continue;
        if ((open.at & WideTree::kLeafBit) != 0) {
            seen.look(open.at & ~WideTree::kLeafBit);
            continue;
        }
        const WideTree::Node& node = seen.tree.node[open.at];
        child_distance2(NodeRows{node, seen.tree.slabs[open.at]}, has_leaves(node),
                        seen.place.data(), seen.limit2, distance2.data());
        const int first = top;
        for (int lane = 0; lane < kWidth; ++lane) {
            if (!(distance2[lane] <= seen.limit2))
                continue;
            int at = top++;
            for (; at > first && stack[at - 1].distance2 < distance2[lane]; --at)
                stack[at] = stack[at - 1];
            stack[at] = {distance2[lane], node.child[lane]};
        }
    }
}

// The farther third leaves the ring. Returns its new reach.
float shrink(WideRing& ring, std::array<float, WideRing::kRoom + kWidth>& distance2) noexcept {
    std::array<float, WideRing::kRoom + kWidth> order = distance2;
    const auto last = order.begin() + 2 * WideRing::kRoom / 3;
    std::nth_element(order.begin(), last, order.begin() + ring.leaves);
    const float reach = std::min(std::sqrt(*last), std::nextafter(ring.reach, 0.0f));
    int kept = 0;
    for (int i = 0; i < ring.leaves; ++i) {
        if (distance2[i] > reach * reach)
            continue;
        for (auto& row : ring.row)
            row[kept] = row[i];
        ring.leaf[kept] = ring.leaf[i];
        distance2[kept++] = distance2[i];
    }
    ring.leaves = kept;
    return ring.reach = reach;
}

// The square of the radius of the next ring's disc of skin, for the ring to be well filled.
float next_disc2(const WideRing& ring, float height) noexcept {
    const float well = 0.7f * WideRing::kRoom / static_cast<float>(std::max(ring.leaves, 1));
    const float disc2 = std::max(ring.reach * ring.reach - height * height, 1e-12f);
    return std::min(std::min(well, 8.0f) * disc2, 1.0f);
}

// Children of a node that are leaves and within the ring's reach join it.
void join(WideRing& ring, std::array<float, WideRing::kRoom + kWidth>& ring_distance2,
          const NodeRows& rows, const float* distance2) noexcept {
    const D d;
    const hn::RebindToUnsigned<D> du;
    for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d))) {
        const V far2 = hn::Load(d, distance2 + lane);
        const auto child = hn::LoadU(du, rows.node.child + lane);
        const hn::RebindToSigned<D> di; // the sign is the leaf bit
        const auto leaf =
            hn::And(hn::RebindMask(d, hn::Lt(hn::BitCast(di, child), hn::Zero(di))),
                    hn::RebindMask(d, hn::Ne(child, hn::Set(du, WideTree::kNothing))));
        const auto mask = hn::And(leaf, hn::Le(far2, hn::Set(d, ring.reach * ring.reach)));
        if (hn::AllFalse(d, mask))
            continue;
        // compressed in a register: straight to memory is microcode on some CPUs
        for (int k = 0; k < WideRing::kRows; ++k)
            hn::StoreU(hn::Compress(hn::LoadU(d, rows(k) + lane), mask), d,
                       ring.row[k].data() + ring.leaves);
        hn::StoreU(hn::Compress(far2, mask), d, ring_distance2.data() + ring.leaves);
        hn::StoreU(hn::Compress(hn::AndNot(hn::Set(du, WideTree::kLeafBit), child),
                                hn::RebindMask(du, mask)),
                   du, ring.leaf.data() + ring.leaves);
        ring.leaves += static_cast<int>(hn::CountTrue(d, mask));
    }
}

// Centre and reach of a ring for a place whose nearest is at `bound`; returns h. A larger ball with
// its centre farther from the skin touches no more of it, but holds the balls around places beside
// this one for longer; and a place that moves gets its ring ahead of it.
//
//      h: centre to skin, s: radius of the disc of skin inside, t: place to centre
//      R^2 = h^2 + s^2, h = bound + t; a place x beside stays in it while x^2 + t^2 < (R - bound)^2
float place_ring(WideRing& ring, const Seen& seen, float bound) noexcept {
    std::array<float, 3> up, ahead;
    float along = 0.0f, beside = 0.0f;
    const float from_skin = distance(seen.place, ring.last_foot);
    const bool knows_up = from_skin > 4.0f * seen.slack;
    for (int axis = 0; axis < 3; ++axis) {
        up[axis] = knows_up ? (seen.place[axis] - ring.last_foot[axis]) / from_skin : 0.0f;
        ahead[axis] = seen.place[axis] - ring.last_place[axis];
        along += ahead[axis] * up[axis];
    }
    for (int axis = 0; axis < 3; ++axis) {
        ahead[axis] -= along * up[axis];
        beside += ahead[axis] * ahead[axis];
    }
    const float t = knows_up ? std::sqrt(ring.disc2) : 0.0f;
    const float h = bound + t;
    ring.reach = std::max(std::sqrt(h * h + ring.disc2), h + 8.0f * seen.slack);
    const float room2 = (ring.reach - bound) * (ring.reach - bound) - t * t;
    const float lead = beside > 0.0f && beside < room2 ? 0.6f * std::sqrt(room2 / beside) : 0.0f;
    for (int axis = 0; axis < 3; ++axis)
        ring.centre[axis] = seen.place[axis] + t * up[axis] + lead * ahead[axis];
    return h;
}

// All leaves in a ball around the nearest, as large as there is room for. False: no room even
// for the nearest alone.
bool make_ring(WideRing& ring, const Seen& seen, float bound) noexcept {
    const WideTree& tree = seen.tree;
    std::array<float, WideRing::kRoom + kWidth> ring_distance2;
    ring.version = tree.version;
    ring.leaves = 0;
    const float height = place_ring(ring, seen, bound);
    const float least_reach = bound + distance(seen.place, ring.centre) + 8.0f * seen.slack;
    ++ring.made;

    std::array<std::uint32_t, wide_detail::kMostDepth * kWidth> stack;
    int top = 0;
    stack[top++] = 0;
    alignas(64) std::array<float, kWidth> distance2;
    while (top > 0) {
        const std::uint32_t at = stack[--top];
        const NodeRows rows{tree.node[at], tree.slabs[at]};
        child_distance2(rows, has_leaves(rows.node), ring.centre.data(), ring.reach * ring.reach,
                        distance2.data());
        for (std::uint32_t met = bits_within(distance2.data(), ring.reach * ring.reach); met != 0;
             met &= met - 1) {
            const std::uint32_t child = rows.node.child[std::countr_zero(met)];
            if ((child & WideTree::kLeafBit) == 0)
                stack[top++] = child;
        }
        join(ring, ring_distance2, rows, distance2.data());
        while (ring.leaves > WideRing::kRoom - kWidth)
            if (!(shrink(ring, ring_distance2) > least_reach)) {
                ring.reach = 0.0f;
                ring.disc2 *= 0.1f;
                return false;
            }
    }
    ring.disc2 = next_disc2(ring, height);
    for (int first = 0; first < ring.leaves; first += kWidth)
        ring.nearest[first / kWidth] = std::sqrt(
            *std::min_element(ring_distance2.begin() + first,
                              ring_distance2.begin() + std::min(first + kWidth, ring.leaves)));
    return true;
}

void look_through(const WideRing& ring, float moved, Seen& seen) noexcept {
    alignas(64) std::array<float, kWidth> distance2;
    for (int first = 0; first < ring.leaves; first += kWidth) {
        if (ring.nearest[first / kWidth] - moved > seen.limit)
            continue;
        child_distance2(RingRows{ring, first}, true, seen.place.data(), seen.limit2,
                        distance2.data());
        std::uint32_t met = bits_within(distance2.data(), seen.limit2);
        if (ring.leaves - first < kWidth)
            met &= (1u << (ring.leaves - first)) - 1u;
        for (; met != 0; met &= met - 1) {
            const int lane = std::countr_zero(met);
            if (distance2[lane] <= seen.limit2 && ring.leaf[first + lane] != ring.last_leaf)
                seen.look(ring.leaf[first + lane]);
        }
    }
}

// The last word, in double, among all that may be the nearest.
SurfaceHit decide(const Seen& seen, const MeshView& mesh, const glm::dvec3& place_m,
                  double radius_m, std::uint32_t& nearest_leaf) noexcept {
    SurfaceHit best;
    double best2 = radius_m * radius_m;
    for (int i = 0; i < seen.leaves; ++i) {
        for (std::uint32_t near_enough = bits_within(seen.distance2[i].data(), seen.limit2);
             near_enough != 0; near_enough &= near_enough - 1) {
            const int lane = std::countr_zero(near_enough);
            const WideTree::Members& members = seen.tree.member[seen.leaf[i]];
            const std::uint32_t t = members.triangle[lane];
            const auto [a, b, c] = members.vertex[lane];
            const TrianglePoint near = nearest_on_triangle(
                {mesh.vertex_m[a], mesh.vertex_m[b], mesh.vertex_m[c]}, place_m);
            if (!(near.distance2_m2 < best2 || (near.distance2_m2 == best2 && t < best.triangle)))
                continue;
            best2 = near.distance2_m2;
            best = {.triangle = t, .weight = near.weight, .place_m = near.place_m};
            nearest_leaf = seen.leaf[i];
        }
    }
    best.distance_m = std::sqrt(best2);
    return best;
}

SurfaceHit closest(const WideTree& tree, const MeshView& mesh, WideRing& ring,
                   const glm::dvec3& place_m, double radius_m) {
    const glm::dvec3 p = tree.to_tree(place_m);
    if (tree.node.empty() || !(radius_m >= 0.0) ||
        !(std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < 1e18))
        return {};
    ++ring.asked;
    const double radius = radius_m * tree.scale_pm;
    Seen seen{tree, p, radius};
    const bool known = ring.last_leaf < tree.leaf.size();
    if (known)
        seen.look(ring.last_leaf);

    for (int attempt = 0; attempt < 2; ++attempt) {
        if (attempt > 0) {
            seen.leaves = 0;
            if (known)
                seen.look(ring.last_leaf);
            if (!make_ring(ring, seen, std::sqrt(seen.best2)))
                break;
        }
        if (ring.version != tree.version || !(ring.reach > 0.0f))
            continue;
        const float moved = distance(seen.place, ring.centre) + 2.0f * seen.slack;
        const float certain = ring.reach - moved - 2.0f * seen.slack;
        if (!(certain > 0.0f))
            continue;
        look_through(ring, moved, seen);
        std::uint32_t leaf = ring.last_leaf;
        if (seen.full)
            break;
        if (!(seen.best2 <= certain * certain))
            continue;
        const SurfaceHit hit = decide(seen, mesh, place_m, radius_m, leaf);
        ring.last_leaf = leaf;
        ring.last_place = seen.place;
        if (hit.hit())
            ring.last_foot = to_float(tree.to_tree(hit.place_m));
        return hit;
    }
    Seen all{tree, p, radius};
    search(all);
    if (all.full)
        return haptics::closest_within<WideTree>(tree, mesh, place_m, radius_m);
    return decide(all, mesh, place_m, radius_m, ring.last_leaf);
}

SurfaceHit closest_from_root(const WideTree& tree, const MeshView& mesh, const glm::dvec3& place_m,
                             double radius_m) {
    const glm::dvec3 p = tree.to_tree(place_m);
    if (tree.node.empty() || !(radius_m >= 0.0) ||
        !(std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < 1e18))
        return {};
    Seen seen{tree, p, radius_m * tree.scale_pm};
    search(seen);
    std::uint32_t leaf = 0;
    return seen.full ? haptics::closest_within<WideTree>(tree, mesh, place_m, radius_m)
                     : decide(seen, mesh, place_m, radius_m, leaf);
}

const char* instructions() {
    return hwy::TargetName(HWY_TARGET);
}

} // namespace
} // namespace haptics::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace haptics {

HWY_EXPORT(closest);
HWY_EXPORT(closest_from_root);
HWY_EXPORT(instructions);

SurfaceHit closest_within(const WideTree& tree, const MeshView& mesh, WideRing& ring,
                          const glm::dvec3& place_m, double radius_m) noexcept {
    return HWY_DYNAMIC_DISPATCH(closest)(tree, mesh, ring, place_m, radius_m);
}

SurfaceHit closest_within(const WideTree& tree, const MeshView& mesh, const glm::dvec3& place_m,
                          double radius_m) noexcept {
    return HWY_DYNAMIC_DISPATCH(closest_from_root)(tree, mesh, place_m, radius_m);
}

const char* wide_tree_instructions() noexcept {
    return HWY_DYNAMIC_DISPATCH(instructions)();
}

} // namespace haptics
#endif
