// tissue/solver/sparse_products.h
// A symmetric sparse matrix times several vectors, eight side by side, so that each entry is read
// once for eight of them. Any thread, no allocation.
#pragma once

#include "tissue/solver/sparse_factor.h"

namespace tissue {

inline constexpr int kProductLanes = 8;

/// y[j] = A x[j] for the full symmetric matrix, each of pattern.size numbers; an x may be a y.
/// `scratch` holds 2 * kProductLanes * pattern.size numbers.
void multiply_each(const SparsePattern& pattern, std::span<const double> values,
                   std::span<const double* const> x, std::span<double* const> y,
                   std::span<double> scratch) noexcept;

} // namespace tissue
