// tissue/solver/block_scratch.h
// Vectors of sixteen columns side by side, for a quadratic body: what solves and products of
// quadratic_columns.h work in. Sized at setup, tissue loop.
#pragma once

#include "tissue/solver/block_modes.h"

namespace tissue {

/// For the mass, in which bases are made orthonormal.
struct alignas(64) DoubleLine {
    std::array<double, SingleFactor::kLanes> lane{};
};

/// A block has three lines of every node, x, y and z, and three of the sink. Anchored: zero.
struct BlockScratch {
    std::vector<ColumnLine> x, r, z, p, q;
    std::vector<ColumnLine> ordered; // in elimination order, as solve_block() takes it
    std::vector<DoubleLine> double_x, double_y;
    std::vector<std::int32_t> order_of_unknown; // its place there
    KnownModes known;
    std::vector<float> bed_npm;         // as QuadraticModel's
    int columns = SingleFactor::kLanes; // of this group that are in use, the first
};

} // namespace tissue
