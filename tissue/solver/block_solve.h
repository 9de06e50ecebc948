// tissue/solver/block_solve.h
// A factor in single precision solved for sixteen right-hand sides side by side: each of its
// numbers is read once and multiplies a line of sixteen. Tissue loop; no allocation.
#pragma once

#include "tissue/solver/single_factor.h"

namespace tissue {

/// One number of sixteen vectors.
using ColumnLine = SingleFactor::Line;
static_assert(SingleFactor::kLanes == 16);

/// A X = B in place, lines in elimination order, then kColumns - 1 lines more of finite numbers
/// that are read and mean nothing. A column's answer does not depend on its neighbours. `columns`:
/// the first of a line that are wanted; few are solved for faster. Any thread.
void solve_block(const SingleFactor& factor, std::span<ColumnLine> b,
                 int columns = SingleFactor::kLanes) noexcept;

} // namespace tissue
