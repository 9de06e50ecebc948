// tissue/solver/block_vectors.h
// What conjugate gradients do with vectors of sixteen columns side by side, each column with
// factors of its own. Tissue loop; no allocation. Internal to the quadratic solver.
#pragma once

#include "tissue/solver/block_solve.h"

#include <glm/mat3x3.hpp>

namespace tissue {

/// One number of each column.
using ColumnScalars = std::array<double, SingleFactor::kLanes>;

/// a^T b
ColumnScalars products_of(std::span<const ColumnLine> a, std::span<const ColumnLine> b) noexcept;

/// y += factor x
void add_scaled(const ColumnScalars& factor, std::span<const ColumnLine> x,
                std::span<ColumnLine> y) noexcept;

/// y = x + factor y
void scale_and_add(const ColumnScalars& factor, std::span<const ColumnLine> x,
                   std::span<ColumnLine> y) noexcept;

/// Node by node W^T v into elimination order: three lines from `v`, to `order[dof + c]`; and W v
/// back. Nodes without unknowns (dof < 0) are left alone.
struct NodeOrder {
    std::span<const std::int32_t> dof, order;
    std::span<const glm::mat3> warp;
};
void turn_into_order(const NodeOrder& nodes, std::span<const ColumnLine> v,
                     std::span<ColumnLine> ordered) noexcept;
void turn_back(const NodeOrder& nodes, std::span<const ColumnLine> ordered,
               std::span<ColumnLine> v) noexcept;

} // namespace tissue
