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

struct Tile {
    int from, size; // among the block's own
    const double* inverse;
};

Tile tile_of(const SupernodeView& f, const Block& b, int from) noexcept {
    return {from, std::min(kTile, b.own - from),
            f.inverse + static_cast<std::size_t>(b.first + from) * kTile};
}

// out = op(A) x or, with `onto`, out -= op(A) x; A as it is stored is rows x columns.
struct Dense {
    const double* at;
    int rows, columns, lead;
};
void product(CBLAS_TRANSPOSE turned, const Dense& a, const double* x, int x_lead, int count,
             bool onto, double* out, int out_lead) noexcept {
    const double scale = onto ? -1.0 : 1.0, old = onto ? 1.0 : 0.0;
    const bool straight = turned == CblasNoTrans;
    if (count == 1)
        cblas_dgemv(CblasColMajor, turned, a.rows, a.columns, scale, a.at, a.lead, x, 1, old, out,
                    1);
    else
        cblas_dgemm(CblasColMajor, turned, CblasNoTrans, straight ? a.rows : a.columns, count,
                    straight ? a.columns : a.rows, scale, a.at, a.lead, x, x_lead, old, out,
                    out_lead);
}

// own[tile] <- op(inverse) own[tile]
void divide(CBLAS_TRANSPOSE turned, const Tile& t, double* own, int n, int columns,
            double* scratch) noexcept {
    product(turned, {t.inverse, t.size, t.size, kTile}, own + t.from, n, columns, false, scratch,
            t.size);
    for (int c = 0; c < columns; ++c)
        std::copy_n(scratch + static_cast<std::size_t>(c) * static_cast<std::size_t>(t.size),
                    t.size,
                    own + t.from + static_cast<std::size_t>(c) * static_cast<std::size_t>(n));
}

// The block's own rows below a tile, in the tile's columns.
Dense under(const Block& b, const Tile& t) noexcept {
    const int end = t.from + t.size;
    return {b.diagonal + static_cast<std::size_t>(t.from) * static_cast<std::size_t>(b.lead) + end,
            b.own - end, t.size, b.lead};
}

void down(const SupernodeView& f, const Block& b, double* x, int n, int columns,
          double* scratch) noexcept {
    double* own = x + b.first;
    for (int from = 0; from < b.own; from += kTile) {
        const Tile t = tile_of(f, b, from);
        divide(CblasNoTrans, t, own, n, columns, scratch);
        const Dense rest = under(b, t);
        if (rest.rows > 0)
            product(CblasNoTrans, rest, own + from, n, columns, true, own + from + t.size, n);
    }
    if (b.below == 0)
        return;
    product(CblasNoTrans, {b.lower, b.below, b.own, b.lead}, own, n, columns, false, scratch,
            b.below);
    for (int c = 0; c < columns; ++c) {
        double* to = x + static_cast<std::size_t>(c) * static_cast<std::size_t>(n);
        const double* from =
            scratch + static_cast<std::size_t>(c) * static_cast<std::size_t>(b.below);
        for (int r = 0; r < b.below; ++r)
            to[b.row[r]] -= from[r];
    }
}

void up(const SupernodeView& f, const Block& b, double* x, int n, int columns,
        double* scratch) noexcept {
    double* own = x + b.first;
    if (b.below > 0) {
        for (int c = 0; c < columns; ++c) {
            const double* from = x + static_cast<std::size_t>(c) * static_cast<std::size_t>(n);
            double* to = scratch + static_cast<std::size_t>(c) * static_cast<std::size_t>(b.below);
            for (int r = 0; r < b.below; ++r)
                to[r] = from[b.row[r]];
        }
        product(CblasTrans, {b.lower, b.below, b.own, b.lead}, scratch, b.below, columns, true, own,
                n);
    }
    for (int from = (b.own - 1) / kTile * kTile; from >= 0; from -= kTile) {
        const Tile t = tile_of(f, b, from);
        const Dense rest = under(b, t);
        if (rest.rows > 0)
            product(CblasTrans, rest, own + from + t.size, n, columns, true, own + from, n);
        divide(CblasTrans, t, own, n, columns, scratch);
    }
}

// The inverse of a lower triangle, column by column, with zeros above the diagonal.
void invert(const double* lower, int lead, int size, double* out) noexcept {
    for (int j = 0; j < size; ++j) {
        double* to = out + static_cast<std::size_t>(j) * kTile;
        std::fill(to, to + size, 0.0);
        to[j] = 1.0;
        for (int k = j; k < size; ++k) {
            const double* column =
                lower + static_cast<std::size_t>(k) * static_cast<std::size_t>(lead);
            const double at = to[k] / column[k];
            to[k] = at;
            for (int i = k + 1; i < size; ++i)
                to[i] -= at * column[i];
        }
    }
}

} // namespace

void invert_tiles(const SupernodeView& factor, std::span<double> inverse) noexcept {
    for (int s = 0; s < factor.blocks; ++s) {
        const Block b = block_of(factor, s);
        for (int from = 0; from < b.own; from += kTile) {
            const std::size_t diagonal =
                static_cast<std::size_t>(from) * static_cast<std::size_t>(b.lead + 1);
            invert(b.diagonal + diagonal, b.lead, std::min(kTile, b.own - from),
                   inverse.data() + static_cast<std::size_t>(b.first + from) * kTile);
        }
    }
}

void descend_supernodes(const SupernodeView& factor, std::span<double> x, int columns,
                        std::span<double> scratch) noexcept {
    const std::size_t size = x.size() / static_cast<std::size_t>(columns);
    for (int s = 0; s < factor.blocks; ++s) {
        const Block b = block_of(factor, s);
        if (!all_zero(x.data(), size, b, columns))
            down(factor, b, x.data(), static_cast<int>(size), columns, scratch.data());
    }
}

void solve_supernodes(const SupernodeView& factor, std::span<double> x, int columns,
                      std::span<double> scratch) noexcept {
    descend_supernodes(factor, x, columns, scratch);
    const int n = static_cast<int>(x.size() / static_cast<std::size_t>(columns));
    for (int s = factor.blocks; s-- > 0;)
        up(factor, block_of(factor, s), x.data(), n, columns, scratch.data());
}

} // namespace tissue
