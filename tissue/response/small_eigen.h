// tissue/response/small_eigen.h
// Small dense symmetric matrices for the contact basis: pivoted Cholesky and eigenvectors. Fixed
// size, no allocation; column j of a matrix is m[j]. Tissue loop.
#pragma once

#include <array>
#include <span>

namespace tissue {

inline constexpr int kSmall = 36; // kMaxBasis and padding to whole SIMD registers

struct SmallMatrix {
    alignas(64) std::array<std::array<double, kSmall>, kSmall> column{};
    std::array<double, kSmall>& operator[](int j) noexcept { return column[j]; }
    const std::array<double, kSmall>& operator[](int j) const noexcept { return column[j]; }
    double* data() noexcept { return column[0].data(); }
    const double* data() const noexcept { return column[0].data(); }
};

/// Lower Cholesky factor of the upper left `size` x `size` part (its lower triangle is read), with
/// diagonal pivoting inside consecutive groups: all of a group that is worth it comes before the
/// next group. Pivots below `cut` are left out. `kept` receives the old indices in the order
/// taken; returns how many. Factor rows and columns are in that order, zero elsewhere.
int pivoted_cholesky(SmallMatrix& matrix, int size, std::span<const int> group_size, double cut,
                     std::array<int, kSmall>& kept) noexcept;

/// The same without pivoting; false if the matrix is not positive definite.
bool cholesky(SmallMatrix& matrix, int size) noexcept;

/// Eigenvalues (ascending) and unit eigenvectors of a positive definite matrix: one-sided Jacobi
/// on its Cholesky factor (Hestenes 1958; Veselic & Hari 1989). With H = L L^T and L W = U S, U
/// holds the eigenvectors and nothing else needs to be carried along. Returns the sweeps taken,
/// 0 if the matrix is not positive definite.
int positive_eigen(SmallMatrix& matrix, int size, std::array<double, kSmall>& value) noexcept;

} // namespace tissue
