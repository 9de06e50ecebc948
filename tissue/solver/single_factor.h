// tissue/solver/single_factor.h
// A sparse Cholesky factor in single precision, for a preconditioner: solves several times faster
// than CHOLMOD does, and exact to 1e-6 or so times the condition of A. Tissue loop; made at setup.
// The inverse of each diagonal block is multiplied in, so that a supernode is one dense product on
// the way down and its transpose on the way up (selective inversion, Raghavan 1998).
#pragma once

#include "tissue/solver/sparse_factor.h"

#include <array>

namespace tissue {

struct SingleFactor {
    static constexpr int kLanes = 16;  // floats of a Line
    static constexpr int kColumns = 4; // that are stored side by side

    struct alignas(64) Line {
        std::array<float, kLanes> lane{};
    };
    /// y_own = B y_own, y_below -= C y_own, with [B; C] = [I; L21] L11^-1, and back.
    struct Block {
        int first = 0, columns = 0; // its own unknowns
        int row_start = 0, below = 0;
        int lines = 0; // of a column of [B; C]
        std::size_t value_start = 0;
    };
    int size = 0;
    std::vector<int> order; // unknown that is eliminated k-th
    std::vector<Block> block;
    std::vector<int> row;    // below the blocks
    std::vector<Line> value; // per block and kColumns columns, line by line from their own rows on
    int most_lines = 0;      // of a block, for scratch
};

SingleFactor make_single_factor(const Supernodes& nodes);

/// A x = b in place, in elimination order. `scratch`: SingleFactor::most_lines. Any thread.
void solve(const SingleFactor& factor, std::span<float> b,
           std::span<SingleFactor::Line> scratch) noexcept;

} // namespace tissue
