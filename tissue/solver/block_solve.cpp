// Compiled once for each instruction set; which one runs is decided at the first solve.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/solver/block_solve.cpp"
#include "tissue/solver/block_solve.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr int kLanes = SingleFactor::kLanes, kColumns = SingleFactor::kColumns;
constexpr int kTile = 8; // rows whose sums are kept in registers
using Block = SingleFactor::Block;
constexpr hn::CappedTag<float, kLanes> kTag;

// Lines of value before those of the `group`-th kColumns columns are not stored: the blocks of a
// column begin at its own rows, kLanes of them at a time.
int first_line(int group) noexcept {
    return group * kColumns / kLanes;
}

// own <- B own, below -= C own. Tiles from the last to the first: what a tile reads of `own` is not
// overwritten yet, since B is lower triangular.
void down(const Block& block, const ColumnLine* value, const int* row, ColumnLine* own,
          ColumnLine* all, int columns) noexcept {
    const int step = static_cast<int>(hn::Lanes(kTag)), rows = block.columns + block.below;
    const int groups = (block.columns + kColumns - 1) / kColumns;
    for (int first = (rows - 1) / kTile * kTile; first >= 0; first -= kTile) {
        const int line = first / kLanes;
        const int reach = std::min(groups, (first + kTile) / kColumns);
        for (int k = 0; k < columns; k += step) {
            auto s0 = hn::Zero(kTag), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
            const ColumnLine* from = value;
            for (int g = 0; g < reach; ++g) {
                const ColumnLine* at = from + kColumns * (line - first_line(g));
                for (int c = 0; c < kColumns; ++c) {
                    const auto x = hn::Load(kTag, &own[kColumns * g + c].lane[k]);
                    const float* v = &at[c].lane[first % kLanes];
                    s0 = hn::MulAdd(hn::Set(kTag, v[0]), x, s0);
                    s1 = hn::MulAdd(hn::Set(kTag, v[1]), x, s1);
                    s2 = hn::MulAdd(hn::Set(kTag, v[2]), x, s2);
                    s3 = hn::MulAdd(hn::Set(kTag, v[3]), x, s3);
                    s4 = hn::MulAdd(hn::Set(kTag, v[4]), x, s4);
                    s5 = hn::MulAdd(hn::Set(kTag, v[5]), x, s5);
                    s6 = hn::MulAdd(hn::Set(kTag, v[6]), x, s6);
                    s7 = hn::MulAdd(hn::Set(kTag, v[7]), x, s7);
                }
                from += kColumns * (block.lines - first_line(g));
            }
            const auto put = [&](int t, auto sum) {
                const int r = first + t;
                if (r < block.columns) {
                    hn::Store(sum, kTag, &own[r].lane[k]);
                } else if (r < rows) {
                    float* to = &all[row[r - block.columns]].lane[k];
                    hn::Store(hn::Sub(hn::Load(kTag, to), sum), kTag, to);
                }
            };
            put(0, s0), put(1, s1), put(2, s2), put(3, s3);
            put(4, s4), put(5, s5), put(6, s6), put(7, s7);
        }
    }
}

// own <- B^T own - C^T below, kColumns at a time from the first: the rows that a column reads of
// `own` are its own and later ones.
void up(const Block& block, const ColumnLine* value, const int* row, ColumnLine* own,
        const ColumnLine* all, int columns) noexcept {
    const int step = static_cast<int>(hn::Lanes(kTag)), rows = block.columns + block.below;
    const int groups = (block.columns + kColumns - 1) / kColumns;
    for (int g = 0; g < groups; ++g) {
        const float* v = value->lane.data();
        const int begin = first_line(g) * kLanes; // row of v[0]
        const auto at = [&](int r) {
            return v + kColumns * ((r - begin) / kLanes * kLanes) + (r - begin) % kLanes;
        };
        for (int k = 0; k < columns; k += step) {
            auto s0 = hn::Zero(kTag), s1 = s0, s2 = s0, s3 = s0, t0 = s0, t1 = s0, t2 = s0, t3 = s0;
            int r = kColumns * g;
            for (; r < block.columns; ++r) {
                const float* w = at(r);
                const auto x = hn::Load(kTag, &own[r].lane[k]);
                s0 = hn::MulAdd(hn::Set(kTag, w[0]), x, s0);
                s1 = hn::MulAdd(hn::Set(kTag, w[kLanes]), x, s1);
                s2 = hn::MulAdd(hn::Set(kTag, w[2 * kLanes]), x, s2);
                s3 = hn::MulAdd(hn::Set(kTag, w[3 * kLanes]), x, s3);
            }
            for (; r + 1 < rows; r += 2) {
                const float *w = at(r), *u = at(r + 1);
                const auto x = hn::Load(kTag, &all[row[r - block.columns]].lane[k]);
                const auto y = hn::Load(kTag, &all[row[r + 1 - block.columns]].lane[k]);
                s0 = hn::NegMulAdd(hn::Set(kTag, w[0]), x, s0);
                s1 = hn::NegMulAdd(hn::Set(kTag, w[kLanes]), x, s1);
                s2 = hn::NegMulAdd(hn::Set(kTag, w[2 * kLanes]), x, s2);
                s3 = hn::NegMulAdd(hn::Set(kTag, w[3 * kLanes]), x, s3);
                t0 = hn::NegMulAdd(hn::Set(kTag, u[0]), y, t0);
                t1 = hn::NegMulAdd(hn::Set(kTag, u[kLanes]), y, t1);
                t2 = hn::NegMulAdd(hn::Set(kTag, u[2 * kLanes]), y, t2);
                t3 = hn::NegMulAdd(hn::Set(kTag, u[3 * kLanes]), y, t3);
            }
            if (r < rows) {
                const float* w = at(r);
                const auto x = hn::Load(kTag, &all[row[r - block.columns]].lane[k]);
                s0 = hn::NegMulAdd(hn::Set(kTag, w[0]), x, s0);
                s1 = hn::NegMulAdd(hn::Set(kTag, w[kLanes]), x, s1);
                s2 = hn::NegMulAdd(hn::Set(kTag, w[2 * kLanes]), x, s2);
                s3 = hn::NegMulAdd(hn::Set(kTag, w[3 * kLanes]), x, s3);
            }
            const auto put = [&](int c, auto sum) {
                if (kColumns * g + c < block.columns)
                    hn::Store(sum, kTag, &own[kColumns * g + c].lane[k]);
            };
            put(0, hn::Add(s0, t0)), put(1, hn::Add(s1, t1));
            put(2, hn::Add(s2, t2)), put(3, hn::Add(s3, t3));
        }
        value += kColumns * (block.lines - first_line(g));
    }
}

} // namespace

void solve_columns_of_lines(const SingleFactor& factor, ColumnLine* b, int columns) {
    for (const Block& block : factor.block)
        down(block, &factor.value[block.value_start], factor.row.data() + block.row_start,
             b + block.first, b, columns);
    for (std::size_t s = factor.block.size(); s-- > 0;) {
        const Block& block = factor.block[s];
        up(block, &factor.value[block.value_start], factor.row.data() + block.row_start,
           b + block.first, b, columns);
    }
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(solve_columns_of_lines);

void solve_block(const SingleFactor& factor, std::span<ColumnLine> b, int columns) noexcept {
    HWY_DYNAMIC_DISPATCH(solve_columns_of_lines)(factor, b.data(), columns);
}

} // namespace tissue
#endif
