// Compiled once for each instruction set; which one runs is decided at the first call.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/solver/sparse_products.cpp"
#include "tissue/solver/sparse_products.h"

#include <algorithm>
#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

} // namespace

// Lines of eight: x[kProductLanes * unknown + column], y alike and zero before.
void multiply_lines(const SparsePattern& pattern, const double* value, const double* x, double* y) {
    constexpr hn::CappedTag<double, kProductLanes> kTag;
    const std::size_t step = hn::Lanes(kTag);
    for (std::size_t lane = 0; lane < kProductLanes; lane += step) {
        for (int c = 0; c < pattern.size; ++c) {
            int k = pattern.column_start[c];
            const int end = pattern.column_start[c + 1];
            const std::size_t own = kProductLanes * static_cast<std::size_t>(c) + lane;
            const auto at_c = hn::LoadU(kTag, x + own);
            auto sum = hn::MulAdd(hn::Set(kTag, value[k]), at_c, hn::LoadU(kTag, y + own));
            for (++k; k < end; ++k) { // diagonal first
                const std::size_t r =
                    kProductLanes * static_cast<std::size_t>(pattern.row[k]) + lane;
                const auto entry = hn::Set(kTag, value[k]);
                sum = hn::MulAdd(entry, hn::LoadU(kTag, x + r), sum);
                hn::StoreU(hn::MulAdd(entry, at_c, hn::LoadU(kTag, y + r)), kTag, y + r);
            }
            hn::StoreU(sum, kTag, y + own);
        }
    }
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(multiply_lines);

void multiply_each(const SparsePattern& pattern, std::span<const double> values,
                   std::span<const double* const> x, std::span<double* const> y,
                   std::span<double> scratch) noexcept {
    const auto n = static_cast<std::size_t>(pattern.size);
    double* in = scratch.data();
    double* out = in + kProductLanes * n;
    for (std::size_t first = 0; first < x.size(); first += kProductLanes) {
        const std::size_t count = std::min<std::size_t>(kProductLanes, x.size() - first);
        std::fill_n(in, 2 * kProductLanes * n, 0.0);
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < count; ++j)
                in[kProductLanes * i + j] = x[first + j][i];
        }
        HWY_DYNAMIC_DISPATCH(multiply_lines)(pattern, values.data(), in, out);
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < count; ++j)
                y[first + j][i] = out[kProductLanes * i + j];
        }
    }
}

} // namespace tissue
#endif
