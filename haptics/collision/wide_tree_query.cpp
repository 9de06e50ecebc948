// Compiled once for each instruction set; which one runs is decided at the first question.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "haptics/collision/wide_tree_query.cpp"
#include "haptics/collision/wide_tree.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

#include "haptics/collision/wide_tree_ring.h"

#include <algorithm>
#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace haptics::HWY_NAMESPACE {
namespace {

// What one question has seen so far: leaves, and how far their triangles are in float.
struct Seen : Asked {
    static constexpr int kRoom = 72;

    float best2;         // float distance of the nearest so far; at first the radius asked for
    float limit, limit2; // a box or triangle farther than this cannot hold the nearest
    int leaves = 0;
    bool full = false;
    std::array<std::uint32_t, kRoom> leaf;
    alignas(32) std::array<std::array<float, kWidth>, kRoom> distance2;

    Seen(const WideTree& t, const glm::dvec3& p, double radius) noexcept : Asked(t, p) {
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

void look_through(const WideRing& ring, Seen& seen) noexcept {
    alignas(64) std::array<float, kWidth> distance2;
    for (std::uint32_t eights = eights_within(ring, seen.place.data(), seen.limit2); eights != 0;
         eights &= eights - 1) {
        const int eight = std::countr_zero(eights);
        for (std::uint32_t met =
                 leaves_within(ring, eight, seen.place.data(), seen.limit2, distance2.data());
             met != 0; met &= met - 1) {
            const int lane = std::countr_zero(met);
            const std::uint32_t leaf = ring.eight[eight].leaf[lane];
            if (distance2[lane] <= seen.limit2 && leaf != ring.last_leaf)
                seen.look(leaf);
        }
    }
}

bool askable(const glm::dvec3& p) noexcept {
    return std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < 1e18;
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
            const WideTree::Leaf& leaf = seen.tree.leaf[seen.leaf[i]];
            const std::uint32_t t = leaf.triangle[lane];
            const auto [a, b, c] = leaf.vertex[lane];
            const TrianglePoint near = nearest_on_triangle(
                {mesh.vertex_m[a], mesh.vertex_m[b], mesh.vertex_m[c]}, place_m);
            if (!(near.distance2_m2 < best2 || (near.distance2_m2 == best2 && t < best.triangle)))
                continue;
            best2 = near.distance2_m2;
            best = {.triangle = t, .weight = near.weight, .place_m = near.place_m};
            nearest_leaf = seen.leaf[i];
        }
    }
    best.distance_m = best.hit() ? std::sqrt(best2) : 0.0;
    return best;
}

SurfaceHit closest(const WideTree& tree, const MeshView& mesh, WideRing& ring,
                   const glm::dvec3& place_m, double radius_m) {
    const glm::dvec3 p = tree.to_tree(place_m);
    if (tree.node.empty() || !(radius_m >= 0.0) || !askable(p))
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
        look_through(ring, seen);
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
    if (tree.node.empty() || !(radius_m >= 0.0) || !askable(p))
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
