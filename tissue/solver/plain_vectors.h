// tissue/solver/plain_vectors.h
// Sums over vectors of unknowns, in their order. Called by the direct solvers, the reference and
// the baselines, at set-up and in steps; not for 1 kHz.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace tissue {

/// a . b; `b` is as long as `a`. In the unit of a times that of b.
inline double product_of(std::span<const double> a, std::span<const double> b) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

/// The Euclidean norm, in the unit of v; 0 of nothing.
inline double norm_of(std::span<const double> v) noexcept {
    return std::sqrt(product_of(v, v));
}

} // namespace tissue
