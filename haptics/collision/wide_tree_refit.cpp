// Compiled once for each instruction set; which one runs is decided at the first refit.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "haptics/collision/wide_tree_refit.cpp"
#include "haptics/collision/wide_tree.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace haptics::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr int kWidth = WideTree::kWidth;
using Node = WideTree::Node;
using D = hn::CappedTag<float, kWidth>;
using V = hn::Vec<D>;

// A place: x, y, z and nothing.
#if HWY_TARGET == HWY_SCALAR
struct V4 {
    float at[4];
};
HWY_INLINE V4 load4(const float* from) {
    return {{from[0], from[1], from[2], from[3]}};
}
HWY_INLINE void store4(const V4& v, float* to) {
    std::copy(v.at, v.at + 4, to);
}
HWY_INLINE V4 set4(float x) {
    return {{x, x, x, x}};
}
HWY_INLINE V4 lower(const V4& a, const V4& b) { // b if a is not a number
    V4 out;
    for (int i = 0; i < 4; ++i)
        out.at[i] = a.at[i] < b.at[i] ? a.at[i] : b.at[i];
    return out;
}
HWY_INLINE V4 higher(const V4& a, const V4& b) {
    V4 out;
    for (int i = 0; i < 4; ++i)
        out.at[i] = a.at[i] > b.at[i] ? a.at[i] : b.at[i];
    return out;
}
HWY_INLINE void put_rows(const V4 (&place)[4], float (&row)[3][kWidth], int lane) {
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 4; ++i)
            row[axis][lane + i] = place[i].at[axis];
}
#else
using D4 = hn::FixedTag<float, 4>;
using V4 = hn::Vec<D4>;
HWY_INLINE V4 load4(const float* from) {
    return hn::LoadU(D4{}, from);
}
HWY_INLINE void store4(V4 v, float* to) {
    hn::StoreU(v, D4{}, to);
}
HWY_INLINE V4 set4(float x) {
    return hn::Set(D4{}, x);
}
HWY_INLINE V4 lower(V4 a, V4 b) { // b if a is not a number
    return hn::IfThenElse(hn::Lt(a, b), a, b);
}
HWY_INLINE V4 higher(V4 a, V4 b) {
    return hn::IfThenElse(hn::Gt(a, b), a, b);
}
// Four places side by side become a row of x, one of y, one of z.
HWY_INLINE void put_rows(const V4 (&p)[4], float (&row)[3][kWidth], int lane) {
    const D4 d;
    const V4 xy02 = hn::InterleaveLower(d, p[0], p[2]), xy13 = hn::InterleaveLower(d, p[1], p[3]);
    const V4 z02 = hn::InterleaveUpper(d, p[0], p[2]), z13 = hn::InterleaveUpper(d, p[1], p[3]);
    hn::Store(hn::InterleaveLower(d, xy02, xy13), d, row[0] + lane);
    hn::Store(hn::InterleaveUpper(d, xy02, xy13), d, row[1] + lane);
    hn::Store(hn::InterleaveLower(d, z02, z13), d, row[2] + lane);
}
#endif

struct Box {
    V4 low, high;
};

HWY_INLINE Box no_box() {
    const float far = std::numeric_limits<float>::infinity();
    return {set4(far), set4(-far)};
}

// Keeps what is there if the place is not a number.
HWY_INLINE void add(Box& box, const V4& place) {
    box.low = lower(place, box.low);
    box.high = higher(place, box.high);
}

HWY_INLINE void put(Node& node, int lane, const Box& box) {
    float low[4], high[4];
    store4(box.low, low);
    store4(box.high, high);
    for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][lane] = low[axis];
        node.high[axis][lane] = high[axis];
    }
}

HWY_INLINE Box fill_leaf(WideTree& tree, std::uint32_t at) {
    WideTree::Leaf& leaf = tree.leaf[at];
    Box box = no_box();
    for (int corner = 0; corner < 3; ++corner)
        for (int lane = 0; lane < kWidth; lane += 4) {
            V4 place[4];
            for (int i = 0; i < 4; ++i)
                place[i] = load4(tree.place[tree.place_of[at][corner][lane + i]].data());
            for (int i = 0; i < 4; ++i) {
                if (leaf.triangle[lane + i] != WideTree::kNothing)
                    add(box, place[i]);
                else
                    place[i] = set4(std::numeric_limits<float>::quiet_NaN());
            }
            put_rows(place, leaf.corner[corner], lane);
        }
    return box;
}

HWY_INLINE V load(const WideTree::Leaf& leaf, int corner, int axis, int lane) {
    return hn::Load(D{}, leaf.corner[corner][axis] + lane);
}

// The sum of the triangles' normals, each as long as twice its area; nothing if there is none.
HWY_INLINE void mean_normal(const WideTree::Leaf& leaf, float (&normal)[3]) {
    const D d;
    V sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d))) {
        V ab[3], ac[3];
        for (int axis = 0; axis < 3; ++axis) {
            const V a = load(leaf, 0, axis, lane);
            ab[axis] = hn::Sub(load(leaf, 1, axis, lane), a);
            ac[axis] = hn::Sub(load(leaf, 2, axis, lane), a);
        }
        for (int axis = 0; axis < 3; ++axis) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const V n = hn::Sub(hn::Mul(ab[u], ac[v]), hn::Mul(ab[v], ac[u]));
            sum[axis] = hn::Add(sum[axis], hn::IfThenElseZero(hn::Eq(n, n), n));
        }
    }
    for (int axis = 0; axis < 3; ++axis)
        normal[axis] = hn::GetLane(hn::SumOfLanes(d, sum[axis]));
    const float length2 = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
    const float inverse = length2 > 1e-30f ? 1.0f / std::sqrt(length2) : 0.0f;
    for (float& n : normal)
        n *= inverse;
}

HWY_INLINE void put_slab(WideTree& tree, std::uint32_t at) {
    const D d;
    const WideTree::Leaf& leaf = tree.leaf[at];
    const float far = std::numeric_limits<float>::infinity();
    float normal[3];
    mean_normal(leaf, normal);
    V low = hn::Set(d, far), high = hn::Set(d, -far);
    for (int corner = 0; corner < 3; ++corner)
        for (int lane = 0; lane < kWidth; lane += static_cast<int>(hn::Lanes(d))) {
            const V along =
                hn::MulAdd(hn::Set(d, normal[0]), load(leaf, corner, 0, lane),
                           hn::MulAdd(hn::Set(d, normal[1]), load(leaf, corner, 1, lane),
                                      hn::Mul(hn::Set(d, normal[2]), load(leaf, corner, 2, lane))));
            low = hn::IfThenElse(hn::Lt(along, low), along, low);
            high = hn::IfThenElse(hn::Gt(along, high), along, high);
        }
    const std::uint32_t in = tree.parent_lane[at];
    WideTree::Slabs& slabs = tree.slabs[in / kWidth];
    for (int axis = 0; axis < 3; ++axis)
        slabs.normal[axis][in % kWidth] = normal[axis];
    slabs.low[in % kWidth] = hn::GetLane(hn::MinOfLanes(d, low));
    slabs.high[in % kWidth] = hn::GetLane(hn::MaxOfLanes(d, high));
}

// Of all lanes; those without a child are nowhere.
HWY_INLINE void put_in_parent(WideTree& tree, const Node& node) {
    const D d;
    if (node.parent_lane == WideTree::kNothing)
        return;
    Node& parent = tree.node[node.parent_lane / kWidth];
    const auto parent_lane = node.parent_lane % kWidth;
    for (int axis = 0; axis < 3; ++axis) {
        V low = hn::Load(d, node.low[axis]), high = hn::Load(d, node.high[axis]);
        for (int lane = static_cast<int>(hn::Lanes(d)); lane < kWidth;
             lane += static_cast<int>(hn::Lanes(d))) {
            low = hn::Min(low, hn::Load(d, node.low[axis] + lane));
            high = hn::Max(high, hn::Load(d, node.high[axis] + lane));
        }
        parent.low[axis][parent_lane] = hn::GetLane(hn::MinOfLanes(d, low));
        parent.high[axis][parent_lane] = hn::GetLane(hn::MaxOfLanes(d, high));
    }
}

void put_leaf(WideTree& tree, std::uint32_t leaf, const Box& box) {
    const std::uint32_t lane = tree.parent_lane[leaf];
    put(tree.node[lane / kWidth], static_cast<int>(lane % kWidth), box);
}

// Children come after their parents: backwards, each box is there when it is needed.
void fill_nodes(WideTree& tree) {
    for (std::size_t at = tree.node.size(); at-- > 0;)
        put_in_parent(tree, tree.node[at]);
}

void fill_boxes(WideTree& tree) {
    for (std::uint32_t at = 0; at < tree.leaf.size(); ++at) {
        put_leaf(tree, at, fill_leaf(tree, at));
        put_slab(tree, at);
    }
    fill_nodes(tree);
}

// `place` is where the vertices were: boxes hold that as well. Slabs and leaves stay, they are of
// the mesh as it is.
void widen_boxes(WideTree& tree) {
    for (std::uint32_t at = 0; at < tree.leaf.size(); ++at) {
        const std::uint32_t in = tree.parent_lane[at];
        const Node& node = tree.node[in / kWidth];
        float low[4]{}, high[4]{};
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = node.low[axis][in % kWidth];
            high[axis] = node.high[axis][in % kWidth];
        }
        Box box{load4(low), load4(high)};
        for (int i = 0; i < kWidth && tree.leaf[at].triangle[i] != WideTree::kNothing; ++i)
            for (int corner = 0; corner < 3; ++corner)
                add(box, load4(tree.place[tree.place_of[at][corner][i]].data()));
        put_leaf(tree, at, box);
    }
    fill_nodes(tree);
}

} // namespace
} // namespace haptics::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace haptics::wide_detail {

HWY_EXPORT(fill_boxes);
HWY_EXPORT(widen_boxes);

void fill_boxes(WideTree& tree) noexcept {
    HWY_DYNAMIC_DISPATCH(fill_boxes)(tree);
}

void widen_boxes(WideTree& tree) noexcept {
    HWY_DYNAMIC_DISPATCH(widen_boxes)(tree);
}

} // namespace haptics::wide_detail
#endif
