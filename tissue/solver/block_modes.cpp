// Compiled once for each instruction set; which one runs is decided at the first call.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/solver/block_modes.cpp"
#include "tissue/solver/block_modes.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr int kLanes = SingleFactor::kLanes, kTile = KnownModes::kTile;
constexpr hn::CappedTag<float, kLanes> kTag;
using V = hn::Vec<hn::CappedTag<float, kLanes>>;

V all(float value) noexcept {
    return hn::Set(kTag, value);
}

// share = diag(inverse) V^T r for the modes of one tile
void project(const float* value, const float* inverse, const ColumnLine* r, std::size_t lines,
             int k, V* share) noexcept {
    V s0 = hn::Zero(kTag), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
    for (std::size_t i = 0; i < lines; ++i, value += kTile) {
        const V x = hn::Load(kTag, &r[i].lane[k]);
        s0 = hn::MulAdd(all(value[0]), x, s0);
        s1 = hn::MulAdd(all(value[1]), x, s1);
        s2 = hn::MulAdd(all(value[2]), x, s2);
        s3 = hn::MulAdd(all(value[3]), x, s3);
        s4 = hn::MulAdd(all(value[4]), x, s4);
        s5 = hn::MulAdd(all(value[5]), x, s5);
        s6 = hn::MulAdd(all(value[6]), x, s6);
        s7 = hn::MulAdd(all(value[7]), x, s7);
    }
    const V sum[kTile] = {s0, s1, s2, s3, s4, s5, s6, s7};
    for (int m = 0; m < kTile; ++m)
        share[m] = hn::Mul(all(inverse[m]), sum[m]);
}

// z += V share
void add(const float* value, const V* share, ColumnLine* z, std::size_t lines, int k) noexcept {
    const V s0 = share[0], s1 = share[1], s2 = share[2], s3 = share[3], s4 = share[4],
            s5 = share[5], s6 = share[6], s7 = share[7];
    for (std::size_t i = 0; i < lines; ++i, value += kTile) {
        float* to = &z[i].lane[k];
        V a = hn::MulAdd(all(value[0]), s0, hn::Load(kTag, to));
        V b = hn::Mul(all(value[1]), s1);
        a = hn::MulAdd(all(value[2]), s2, a);
        b = hn::MulAdd(all(value[3]), s3, b);
        a = hn::MulAdd(all(value[4]), s4, a);
        b = hn::MulAdd(all(value[5]), s5, b);
        a = hn::MulAdd(all(value[6]), s6, a);
        b = hn::MulAdd(all(value[7]), s7, b);
        hn::Store(hn::Add(a, b), kTag, to);
    }
}

} // namespace

void add_tiles(const KnownModes& known, const ColumnLine* r, ColumnLine* z) {
    for (int m = 0; m < known.modes; m += kTile) {
        const float* value = &known.value[static_cast<std::size_t>(m) * known.lines];
        for (int k = 0; k < kLanes; k += static_cast<int>(hn::Lanes(kTag))) {
            V share[kTile];
            project(value, &known.inverse[m], r, known.lines, k, share);
            add(value, share, z, known.lines, k);
        }
    }
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(add_tiles);

KnownModes make_known_modes(std::size_t lines) {
    KnownModes known;
    known.lines = lines;
    known.value.assign(lines * KnownModes::kMost, 0.0f);
    known.inverse.assign(KnownModes::kMost, 0.0f);
    return known;
}

void add_known(const KnownModes& known, std::span<const ColumnLine> r,
               std::span<ColumnLine> z) noexcept {
    if (known.modes > 0)
        HWY_DYNAMIC_DISPATCH(add_tiles)(known, r.data(), z.data());
}

} // namespace tissue
#endif
