// See the header.
#include "tissue/solver/supernode_solve.h"

#include <algorithm>
#include <cblas.h>
#include <cstddef>

namespace tissue {
namespace {

struct Block {
    int first, own, below;
    const double *diagonal, *lower; // own x own, below x own; `lead` apart
    const int* row;                 // of the rows below
    int lead;
};

Block block_of(const SupernodeView& f, int s) noexcept {
    const int own = f.first[s + 1] - f.first[s], rows = f.row_start[s + 1] - f.row_start[s];
    const double* at = f.value + f.value_start[s];
    return {f.first[s], own, rows - own, at, at + own, f.row + f.row_start[s] + own, rows};
}

bool all_zero(const double* x, std::size_t n, const Block& b, int columns) noexcept {
    for (int c = 0; c < columns; ++c) {
        const double* at = x + static_cast<std::size_t>(c) * n + b.first;
        if (std::any_of(at, at + b.own, [](double v) { return v != 0.0; }))
            return false;
    }
    return true;
}

void divide(CBLAS_TRANSPOSE transposed, const Block& b, double* own, int n, int columns) noexcept {
    if (columns == 1)
        cblas_dtrsv(CblasColMajor, CblasLower, transposed, CblasNonUnit, b.own, b.diagonal, b.lead,
                    own, 1);
    else
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, transposed, CblasNonUnit, b.own, columns,
                    1.0, b.diagonal, b.lead, own, n);
}

void down(const Block& b, double* x, int n, int columns, double* below) noexcept {
    double* own = x + b.first;
    divide(CblasNoTrans, b, own, n, columns);
    if (b.below == 0)
        return;
    if (columns == 1)
        cblas_dgemv(CblasColMajor, CblasNoTrans, b.below, b.own, 1.0, b.lower, b.lead, own, 1, 0.0,
                    below, 1);
    else
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, b.below, columns, b.own, 1.0,
                    b.lower, b.lead, own, n, 0.0, below, b.below);
    for (int c = 0; c < columns; ++c) {
        double* to = x + static_cast<std::size_t>(c) * static_cast<std::size_t>(n);
        const double* from =
            below + static_cast<std::size_t>(c) * static_cast<std::size_t>(b.below);
        for (int r = 0; r < b.below; ++r)
            to[b.row[r]] -= from[r];
    }
}

void up(const Block& b, double* x, int n, int columns, double* below) noexcept {
    double* own = x + b.first;
    for (int c = 0; c < columns; ++c) {
        const double* from = x + static_cast<std::size_t>(c) * static_cast<std::size_t>(n);
        double* to = below + static_cast<std::size_t>(c) * static_cast<std::size_t>(b.below);
        for (int r = 0; r < b.below; ++r)
            to[r] = from[b.row[r]];
    }
    if (b.below > 0 && columns == 1)
        cblas_dgemv(CblasColMajor, CblasTrans, b.below, b.own, -1.0, b.lower, b.lead, below, 1, 1.0,
                    own, 1);
    else if (b.below > 0)
        cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, b.own, columns, b.below, -1.0, b.lower,
                    b.lead, below, b.below, 1.0, own, n);
    divide(CblasTrans, b, own, n, columns);
}

} // namespace

void solve_supernodes(const SupernodeView& factor, std::span<double> x, int columns,
                      std::span<double> scratch) noexcept {
    const std::size_t size = x.size() / static_cast<std::size_t>(columns);
    const int n = static_cast<int>(size);
    for (int s = 0; s < factor.blocks; ++s) {
        const Block b = block_of(factor, s);
        if (!all_zero(x.data(), size, b, columns))
            down(b, x.data(), n, columns, scratch.data());
    }
    for (int s = factor.blocks; s-- > 0;)
        up(block_of(factor, s), x.data(), n, columns, scratch.data());
}

} // namespace tissue
