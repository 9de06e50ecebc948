// Compiled once for each instruction set; which one runs is decided at the first call.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/solver/block_vectors.cpp"
#include "tissue/solver/block_vectors.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr int kLanes = SingleFactor::kLanes;
constexpr hn::CappedTag<float, kLanes> kTag;
using V = hn::Vec<hn::CappedTag<float, kLanes>>;

V load(const ColumnLine& line, int k) noexcept {
    return hn::Load(kTag, &line.lane[k]);
}
void store(V v, ColumnLine& line, int k) noexcept {
    hn::Store(v, kTag, &line.lane[k]);
}
int step() noexcept {
    return static_cast<int>(hn::Lanes(kTag));
}

// M v, M column by column: m[3 column + row]
void times(const float* m, const V* v, V* out) noexcept {
    for (int r = 0; r < 3; ++r)
        out[r] = hn::MulAdd(
            hn::Set(kTag, m[6 + r]), v[2],
            hn::MulAdd(hn::Set(kTag, m[3 + r]), v[1], hn::Mul(hn::Set(kTag, m[r]), v[0])));
}

} // namespace

// Four sums that do not wait for each other.
void sum_products(const ColumnLine* a, const ColumnLine* b, std::size_t size, double* out) {
    for (int k = 0; k < kLanes; k += step()) {
        V s[4] = {hn::Zero(kTag), hn::Zero(kTag), hn::Zero(kTag), hn::Zero(kTag)};
        std::size_t i = 0;
        for (; i + 3 < size; i += 4) {
            for (std::size_t t = 0; t < 4; ++t)
                s[t] = hn::MulAdd(load(a[i + t], k), load(b[i + t], k), s[t]);
        }
        for (; i < size; ++i)
            s[0] = hn::MulAdd(load(a[i], k), load(b[i], k), s[0]);
        ColumnLine sum;
        store(hn::Add(hn::Add(s[0], s[1]), hn::Add(s[2], s[3])), sum, 0);
        for (int j = 0; j < step(); ++j)
            out[k + j] = sum.lane[j];
    }
}

void add_lines(const ColumnLine& factor, const ColumnLine* x, ColumnLine* y, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
        for (int k = 0; k < kLanes; k += step())
            store(hn::MulAdd(load(factor, k), load(x[i], k), load(y[i], k)), y[i], k);
    }
}

void scale_lines(const ColumnLine& factor, const ColumnLine* x, ColumnLine* y, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
        for (int k = 0; k < kLanes; k += step())
            store(hn::MulAdd(load(factor, k), load(y[i], k), load(x[i], k)), y[i], k);
    }
}

void nodes_to_order(const NodeOrder& nodes, const ColumnLine* v, ColumnLine* ordered) {
    for (std::size_t i = 0; i < nodes.dof.size(); ++i) {
        if (nodes.dof[i] < 0)
            continue;
        const glm::mat3 W = glm::transpose(nodes.warp[i]);
        const std::int32_t* at = &nodes.order[nodes.dof[i]];
        for (int k = 0; k < kLanes; k += step()) {
            const V from[3] = {load(v[3 * i], k), load(v[3 * i + 1], k), load(v[3 * i + 2], k)};
            V to[3];
            times(&W[0][0], from, to);
            for (int c = 0; c < 3; ++c)
                store(to[c], ordered[at[c]], k);
        }
    }
}

void order_to_nodes(const NodeOrder& nodes, const ColumnLine* ordered, ColumnLine* v) {
    for (std::size_t i = 0; i < nodes.dof.size(); ++i) {
        if (nodes.dof[i] < 0)
            continue;
        const std::int32_t* at = &nodes.order[nodes.dof[i]];
        for (int k = 0; k < kLanes; k += step()) {
            const V from[3] = {load(ordered[at[0]], k), load(ordered[at[1]], k),
                               load(ordered[at[2]], k)};
            V to[3];
            times(&nodes.warp[i][0][0], from, to);
            for (std::size_t c = 0; c < 3; ++c)
                store(to[c], v[3 * i + c], k);
        }
    }
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(sum_products);
HWY_EXPORT(add_lines);
HWY_EXPORT(scale_lines);
HWY_EXPORT(nodes_to_order);
HWY_EXPORT(order_to_nodes);

namespace {

ColumnLine in_single(const ColumnScalars& factor) noexcept {
    ColumnLine line;
    for (std::size_t j = 0; j < factor.size(); ++j)
        line.lane[j] = static_cast<float>(factor[j]);
    return line;
}

} // namespace

ColumnScalars products_of(std::span<const ColumnLine> a, std::span<const ColumnLine> b) noexcept {
    ColumnScalars out;
    HWY_DYNAMIC_DISPATCH(sum_products)(a.data(), b.data(), a.size(), out.data());
    return out;
}

void add_scaled(const ColumnScalars& factor, std::span<const ColumnLine> x,
                std::span<ColumnLine> y) noexcept {
    HWY_DYNAMIC_DISPATCH(add_lines)(in_single(factor), x.data(), y.data(), y.size());
}

void scale_and_add(const ColumnScalars& factor, std::span<const ColumnLine> x,
                   std::span<ColumnLine> y) noexcept {
    HWY_DYNAMIC_DISPATCH(scale_lines)(in_single(factor), x.data(), y.data(), y.size());
}

void turn_into_order(const NodeOrder& nodes, std::span<const ColumnLine> v,
                     std::span<ColumnLine> ordered) noexcept {
    HWY_DYNAMIC_DISPATCH(nodes_to_order)(nodes, v.data(), ordered.data());
}

void turn_back(const NodeOrder& nodes, std::span<const ColumnLine> ordered,
               std::span<ColumnLine> v) noexcept {
    HWY_DYNAMIC_DISPATCH(order_to_nodes)(nodes, ordered.data(), v.data());
}

} // namespace tissue
#endif
