// Compiled once for each instruction set; which one runs is decided at the first solve.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/solver/single_solve.cpp"
#include "tissue/solver/single_factor.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr int kLanes = SingleFactor::kLanes, kColumns = SingleFactor::kColumns;
using Block = SingleFactor::Block;
using Line = SingleFactor::Line;
constexpr hn::CappedTag<float, kLanes> kTag;

// out = [B; C] own
void down(const Block& block, const Line* value, const float* own, Line* out) noexcept {
    const int step = static_cast<int>(hn::Lanes(kTag));
    std::fill_n(out, block.lines, Line{});
    for (int j = 0; j < block.columns; j += kColumns) {
        const int left = block.columns - j; // there are zeros where columns end
        const auto x0 = hn::Set(kTag, own[j]), x1 = hn::Set(kTag, left > 1 ? own[j + 1] : 0.0f),
                   x2 = hn::Set(kTag, left > 2 ? own[j + 2] : 0.0f),
                   x3 = hn::Set(kTag, left > 3 ? own[j + 3] : 0.0f);
        for (int line = j / kLanes; line < block.lines; ++line, value += kColumns) {
            for (int k = 0; k < kLanes; k += step) {
                float* to = &out[line].lane[k];
                const auto a = hn::MulAdd(
                    hn::Load(kTag, &value[1].lane[k]), x1,
                    hn::MulAdd(hn::Load(kTag, &value[0].lane[k]), x0, hn::Load(kTag, to)));
                const auto b = hn::MulAdd(hn::Load(kTag, &value[3].lane[k]), x3,
                                          hn::Mul(hn::Load(kTag, &value[2].lane[k]), x2));
                hn::Store(hn::Add(a, b), kTag, to);
            }
        }
    }
}

// own = [B; C]^T in
void up(const Block& block, const Line* value, const Line* in, float* own) noexcept {
    const int step = static_cast<int>(hn::Lanes(kTag));
    for (int j = 0; j < block.columns; j += kColumns) {
        auto s0 = hn::Zero(kTag), s1 = s0, s2 = s0, s3 = s0;
        for (int line = j / kLanes; line < block.lines; ++line, value += kColumns) {
            for (int k = 0; k < kLanes; k += step) {
                const auto x = hn::Load(kTag, &in[line].lane[k]);
                s0 = hn::MulAdd(hn::Load(kTag, &value[0].lane[k]), x, s0);
                s1 = hn::MulAdd(hn::Load(kTag, &value[1].lane[k]), x, s1);
                s2 = hn::MulAdd(hn::Load(kTag, &value[2].lane[k]), x, s2);
                s3 = hn::MulAdd(hn::Load(kTag, &value[3].lane[k]), x, s3);
            }
        }
        const float sum[kColumns]{
            hn::GetLane(hn::SumOfLanes(kTag, s0)), hn::GetLane(hn::SumOfLanes(kTag, s1)),
            hn::GetLane(hn::SumOfLanes(kTag, s2)), hn::GetLane(hn::SumOfLanes(kTag, s3))};
        std::copy_n(sum, std::min(kColumns, block.columns - j), own + j);
    }
}

} // namespace

void solve_lines(const SingleFactor& factor, float* b, Line* scratch) {
    float* flat = scratch->lane.data(); // lines follow each other without a gap
    for (const Block& block : factor.block) {
        down(block, &factor.value[block.value_start], b + block.first, scratch);
        std::copy_n(flat, block.columns, b + block.first);
        const int* row = factor.row.data() + block.row_start;
        for (int r = 0; r < block.below; ++r)
            b[row[r]] -= flat[block.columns + r];
    }
    for (std::size_t s = factor.block.size(); s-- > 0;) {
        const Block& block = factor.block[s];
        const int* row = factor.row.data() + block.row_start;
        scratch[block.lines - 1] = Line{}; // what pads the last line
        std::copy_n(b + block.first, block.columns, flat);
        for (int r = 0; r < block.below; ++r)
            flat[block.columns + r] = -b[row[r]];
        up(block, &factor.value[block.value_start], scratch, b + block.first);
    }
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(solve_lines);

void solve(const SingleFactor& factor, std::span<float> b,
           std::span<SingleFactor::Line> scratch) noexcept {
    HWY_DYNAMIC_DISPATCH(solve_lines)(factor, b.data(), scratch.data());
}

} // namespace tissue
#endif
