// haptics/collision/wide_tree_ring.h
// Making the ring of leaves around a place: which ball of leaves holds the balls of this place and
// of those that will be asked about next. Included once for each instruction set, by
// wide_tree_query.cpp and near_leaves.cpp only.
#if defined(TROCAR_WIDE_TREE_RING) == defined(HWY_TARGET_TOGGLE)
#ifdef TROCAR_WIDE_TREE_RING
#undef TROCAR_WIDE_TREE_RING
#else
#define TROCAR_WIDE_TREE_RING
#endif

#include "haptics/collision/wide_tree_lanes.h"

#include <algorithm>
#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace haptics::HWY_NAMESPACE {
namespace {

float distance(const std::array<float, 3>& a, const std::array<float, 3>& b) noexcept {
    const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return std::sqrt(x * x + y * y + z * z);
}

std::array<float, 3> to_float(const glm::dvec3& p) noexcept {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

// A place in a tree's frame, and how far float is believed there.
struct Asked {
    const WideTree& tree;
    std::array<float, 3> place;
    float slack;

    Asked(const WideTree& t, const glm::dvec3& p) noexcept
        : tree(t), place(to_float(p)), slack(static_cast<float>(wide_detail::slack(p))) {}
};

// The leaves of a ring while it is made: packed as they come, each row of all of them together.
struct Making {
    static constexpr int kRoom = WideRing::kRoom + kWidth;
    int leaves = 0;
    std::array<std::array<float, kRoom>, WideRing::kRows> row;
    std::array<std::uint32_t, kRoom> leaf;
    std::array<float, kRoom> distance2;
};

// The farther third leaves the ring. Returns its new reach.
float shrink(WideRing& ring, Making& making) noexcept {
    std::array<float, Making::kRoom> order = making.distance2;
    const auto last = order.begin() + 2 * WideRing::kRoom / 3;
    std::nth_element(order.begin(), last, order.begin() + making.leaves);
    const float reach = std::min(std::sqrt(*last), std::nextafter(ring.reach, 0.0f));
    int kept = 0;
    for (int i = 0; i < making.leaves; ++i) {
        if (making.distance2[i] > reach * reach)
            continue;
        for (auto& row : making.row)
            row[kept] = row[i];
        making.leaf[kept] = making.leaf[i];
        making.distance2[kept++] = making.distance2[i];
    }
    making.leaves = kept;
    return ring.reach = reach;
}

// The square of the radius of the next ring's disc of skin, for the ring to be well filled.
float next_disc2(const WideRing& ring, float height) noexcept {
    const float well = 0.7f * WideRing::kRoom / static_cast<float>(std::max(ring.leaves, 1));
    const float disc2 = std::max(ring.reach * ring.reach - height * height, 1e-12f);
    return std::min(std::min(well, 8.0f) * disc2, 1.0f);
}

// Children of a node that are leaves and within the ring's reach join it.
void join(float reach, const NodeRows& rows, const float* distance2, Making& making) noexcept {
    const D d;
    const hn::RebindToUnsigned<D> du;
    for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d))) {
        const V far2 = hn::Load(d, distance2 + lane);
        const auto child = hn::LoadU(du, rows.node.child + lane);
        const hn::RebindToSigned<D> di; // the sign is the leaf bit
        const auto leaf =
            hn::And(hn::RebindMask(d, hn::Lt(hn::BitCast(di, child), hn::Zero(di))),
                    hn::RebindMask(d, hn::Ne(child, hn::Set(du, WideTree::kNothing))));
        const auto mask = hn::And(leaf, hn::Le(far2, hn::Set(d, reach * reach)));
        if (hn::AllFalse(d, mask))
            continue;
        // compressed in a register: straight to memory is microcode on some CPUs
        for (int k = 0; k < WideRing::kRows; ++k)
            hn::StoreU(hn::Compress(hn::LoadU(d, rows(k) + lane), mask), d,
                       making.row[k].data() + making.leaves);
        hn::StoreU(hn::Compress(far2, mask), d, making.distance2.data() + making.leaves);
        hn::StoreU(hn::Compress(hn::AndNot(hn::Set(du, WideTree::kLeafBit), child),
                                hn::RebindMask(du, mask)),
                   du, making.leaf.data() + making.leaves);
        making.leaves += static_cast<int>(hn::CountTrue(d, mask));
    }
}

// Centre and reach of a ring for a place whose nearest is at `bound`; returns h. A larger ball with
// its centre farther from the skin touches no more of it, but holds the balls around places beside
// this one for longer; and a place that moves gets its ring ahead of it.
//
//      h: centre to skin, s: radius of the disc of skin inside, t: place to centre
//      R^2 = h^2 + s^2, h = bound + t; a place x beside stays in it while x^2 + t^2 < (R - bound)^2
float place_ring(WideRing& ring, const Asked& asked, float bound) noexcept {
    std::array<float, 3> up, ahead;
    float along = 0.0f, beside = 0.0f;
    const float from_skin = distance(asked.place, ring.last_foot);
    const bool knows_up = from_skin > 4.0f * asked.slack;
    for (int axis = 0; axis < 3; ++axis) {
        up[axis] = knows_up ? (asked.place[axis] - ring.last_foot[axis]) / from_skin : 0.0f;
        ahead[axis] = asked.place[axis] - ring.last_place[axis];
        along += ahead[axis] * up[axis];
    }
    for (int axis = 0; axis < 3; ++axis) {
        ahead[axis] -= along * up[axis];
        beside += ahead[axis] * ahead[axis];
    }
    const float t = knows_up ? std::sqrt(ring.disc2) : 0.0f;
    const float h = bound + t;
    ring.reach = std::max(std::sqrt(h * h + ring.disc2), h + 8.0f * asked.slack);
    const float room2 = (ring.reach - bound) * (ring.reach - bound) - t * t;
    // what is left of a way straight up is rounding, and leads anywhere
    const bool leads = beside > 1e-6f * along * along && beside < room2;
    const float lead = leads ? 0.6f * std::sqrt(room2 / beside) : 0.0f;
    for (int axis = 0; axis < 3; ++axis)
        ring.centre[axis] = asked.place[axis] + t * up[axis] + lead * ahead[axis];
    return h;
}

// Eight by eight, with a box around each eight; where there are none, one that is never met.
void lay_out(const Making& making, WideRing& ring) noexcept {
    ring.leaves = making.leaves;
    for (int eight = 0; eight < WideRing::kEights; ++eight) {
        const int first = eight * kWidth, many = std::clamp(ring.leaves - first, 0, kWidth);
        WideRing::Eight& out = ring.eight[eight];
        std::copy_n(making.leaf.begin() + first, many, out.leaf.begin());
        for (int row = 0; row < WideRing::kRows; ++row)
            std::copy_n(making.row[row].begin() + first, many, out.row[row].begin());
        for (int row = 0; row < 6; ++row) {
            const auto begin = out.row[row].begin(), end = begin + many;
            ring.around[row][eight] = many == 0 ? (row < 3 ? kFar : -kFar)
                                      : row < 3 ? *std::min_element(begin, end)
                                                : *std::max_element(begin, end);
        }
    }
}

// Which eights of a ring come within the root of `limit2`.
HWY_INLINE std::uint32_t eights_within(const WideRing& ring, const float* place, float limit2) {
    alignas(64) std::array<float, kWidth> distance2;
    child_distance2(AroundRows{ring}, false, place, limit2, distance2.data());
    return bits_within(distance2.data(), limit2);
}

// Of the leaves of one eight, those that do; what comes from them is put in `distance2`.
HWY_INLINE std::uint32_t leaves_within(const WideRing& ring, int eight, const float* place,
                                       float limit2, float* distance2) {
    child_distance2(RingRows{ring, eight}, true, place, limit2, distance2);
    const int behind = kWidth - std::min(kWidth, ring.leaves - eight * kWidth);
    return bits_within(distance2, limit2) & (0xffu >> behind);
}

// All leaves in a ball around the nearest, as large as there is room for. False: no room even
// for the nearest alone.
HWY_NOINLINE bool make_ring(WideRing& ring, const Asked& asked, float bound) noexcept {
    const WideTree& tree = asked.tree;
    Making making;
    ring.version = tree.version;
    const float height = place_ring(ring, asked, bound);
    const float least_reach = bound + distance(asked.place, ring.centre) + 8.0f * asked.slack;
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
        join(ring.reach, rows, distance2.data(), making);
        while (making.leaves > WideRing::kRoom - kWidth)
            if (!(shrink(ring, making) > least_reach)) {
                ring.reach = 0.0f;
                ring.disc2 *= 0.1f;
                return false;
            }
    }
    lay_out(making, ring);
    ring.disc2 = next_disc2(ring, height);
    return true;
}

} // namespace
} // namespace haptics::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
