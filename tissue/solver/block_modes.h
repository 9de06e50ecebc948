// tissue/solver/block_modes.h
// A few vectors that a solve knows beforehand, and their products with sixteen columns side by
// side. Tissue loop; no allocation after make_known_modes(). Internal to the quadratic solver.
#pragma once

#include "tissue/solver/block_solve.h"

namespace tissue {

/// Vectors in tiles of kTile: of a tile, the kTile numbers of one line after those of another.
struct KnownModes {
    static constexpr int kTile = 8, kMost = 40;
    int modes = 0;              // 0: nothing is known
    std::size_t lines = 0;      // of a block, see BlockScratch
    std::vector<float> value;   // zero beyond `modes`, and at anchored nodes
    std::vector<float> inverse; // of what the matrix is in each mode
    float& at(int mode, std::size_t line) noexcept {
        return value[(static_cast<std::size_t>(mode / kTile) * lines + line) * kTile +
                     static_cast<std::size_t>(mode % kTile)];
    }
};
KnownModes make_known_modes(std::size_t lines);

/// z += V diag(inverse) V^T r
void add_known(const KnownModes& known, std::span<const ColumnLine> r,
               std::span<ColumnLine> z) noexcept;

} // namespace tissue
