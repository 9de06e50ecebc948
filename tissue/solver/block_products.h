// tissue/solver/block_products.h
// Products of the matrices of a quadratic body with sixteen vectors side by side: the numbers of a
// tet, and those between two nodes, are read once for all. Tissue loop; no allocation. Internal to
// the quadratic solver.
#pragma once

#include "tissue/solver/quadratic.h"

namespace tissue {

/// q += factor K p, sums at anchored nodes too; blocks as in BlockScratch. `columns`: the first of
/// a line that are wanted, here and below; few cost less.
void add_tangent_product(const QuadraticModel& model, const QuadraticTangents& tangents,
                         float factor, std::span<const ColumnLine> p, std::span<ColumnLine> q,
                         int columns = SingleFactor::kLanes) noexcept;

/// q = S p, S the same for x, y and z and on the pattern of the mass.
void scalar_product(const QuadraticModel& model, std::span<const float> S,
                    std::span<const ColumnLine> p, std::span<ColumnLine> q,
                    int columns = SingleFactor::kLanes) noexcept;
void scalar_product(const QuadraticModel& model, std::span<const double> S,
                    std::span<const DoubleLine> p, std::span<DoubleLine> q) noexcept;

} // namespace tissue
