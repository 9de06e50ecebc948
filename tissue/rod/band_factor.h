// tissue/rod/band_factor.h
// Symmetric matrices whose entries lie near the diagonal, and their L D L^T. Called by rod_step.cpp
// in the tissue loop. Work grows with size x band^2.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tissue {

/// Lower half: entry (row, column) with 0 <= row - column <= band at row (band + 1) + column - row
/// + band.
struct BandMatrix {
    int size = 0, band = 0;
    std::vector<double> value;

    std::size_t at(int row, int column) const noexcept {
        return static_cast<std::size_t>(row * (band + 1) + column - row + band);
    }
};
BandMatrix make_band(int size, int band);

/// L D L^T in place, without pivoting: D on the diagonal, the unit diagonal of L is not kept.
/// False if a pivot is not above 1e-14 of the largest entry of the diagonal: not positive definite,
/// or not finite; `matrix` is spoilt then. Real-time safe.
bool factor(BandMatrix& matrix) noexcept;

/// One right-hand side in place, by what factor() made. Real-time safe.
void solve(const BandMatrix& factored, std::span<double> x) noexcept;

/// y = A x. Real-time safe.
void multiply(const BandMatrix& matrix, std::span<const double> x, std::span<double> y) noexcept;

} // namespace tissue
