// haptics/rigid/spd_system.h
// Small dense symmetric matrices: the equilibrium of up to three coupled tools, and the largest
// eigenvalue of a stiffness. 1 kHz, on the stack.
#pragma once

#include <array>
#include <cstddef>

namespace haptics {

/// A x = b with A symmetric and positive definite, n <= 18 unknowns, both triangles stored.
struct SpdSystem {
    static constexpr std::size_t kMost = 18;
    std::array<std::array<double, kMost>, kMost> a{};
    std::array<double, kMost> b{};
    std::size_t n = 0;
};

/// Cholesky; x in `b`, `a` is overwritten. False if A is not positive definite or a number is not
/// finite; `b` is then of no use. Real-time safe.
bool solve(SpdSystem& system) noexcept;

using Matrix6 = std::array<std::array<double, 6>, 6>;

/// Largest eigenvalue of a symmetric matrix (cyclic Jacobi). Real-time safe.
double largest_eigenvalue(Matrix6 m) noexcept;

} // namespace haptics
