// tissue/solver/supernode_solve.h
// L L^T X = B for a factor of dense blocks and many right-hand sides. What a tool loads are a few
// nodes: on the way down, blocks above them in the elimination tree have nothing to pass on and are
// left out (Gilbert & Peierls 1988, by blocks). Tiles on the diagonal are inverted once for each
// factor, so that all else is products: what is left of a triangular solve by BLAS is mostly
// waiting for the number before. Tissue loop; no allocation.
#pragma once

#include <cstddef>
#include <span>

namespace tissue {

/// As Supernodes, not owned: block s has columns [first[s], first[s + 1]), rows
/// row[row_start[s]..row_start[s + 1]), first its own, and numbers from value[value_start[s]],
/// column by column.
struct SupernodeView {
    int blocks = 0;
    const int *first = nullptr, *row_start = nullptr, *value_start = nullptr, *row = nullptr;
    const double* value = nullptr;
    const double* inverse = nullptr; // of the tiles on the diagonal, `kTile` numbers a column
};

/// A block's own columns are taken so many at a time; its last tile may be smaller.
inline constexpr int kTile = 32;

/// Fills `inverse`, kTile numbers for each column of the factor, from the numbers of `factor`.
void invert_tiles(const SupernodeView& factor, std::span<double> inverse) noexcept;

/// In elimination order, in place, `columns` columns of n one after the other. `scratch`: rows
/// below a block, the most of any, and no less than kTile, for each column.
void solve_supernodes(const SupernodeView& factor, std::span<double> x, int columns,
                      std::span<double> scratch) noexcept;

/// The first half alone, L Y = B: what is squared gives b^T A^-1 b.
void descend_supernodes(const SupernodeView& factor, std::span<double> x, int columns,
                        std::span<double> scratch) noexcept;

} // namespace tissue
