// tissue/solver/tangle.h
// Tangles: inverted tets and all that share a corner with them, as far as they hang together. Which
// way each tet of a tangle faces says nothing any more. The mean of F over all of them does: it
// depends on where the rim of the region is, not on how its inside is thrown about (divergence
// theorem). So a tangle has one rotation, the one nearest to that mean.
// Internal to the corotated solver; tissue loop, in steps with inverted tets.
#pragma once

#include "tissue/solver/corotated.h"

namespace tissue {

/// Sized once for a model; contents mean nothing except after find_tangles().
struct Tangles {
    int inverted = 0;                 // tets with det F <= 0
    std::vector<std::int32_t> node;   // a node that stands for the tangle of this one; -1: none
    std::vector<glm::dmat3> rotation; // at that node
};
Tangles make_tangles(const CorotatedModel& model);

void find_tangles(const CorotatedModel& model, std::span<const glm::dvec3> position_m,
                  Tangles& tangles) noexcept;

/// The rotation of the tangle that a tet is in; null: none. Between two tangles, of its first
/// corner's.
inline const glm::dmat3* rotation_of(const Tangles& tangles, const Tet& tet) noexcept {
    for (const std::uint32_t corner : tet)
        if (tangles.node[corner] >= 0)
            return &tangles.rotation[tangles.node[corner]];
    return nullptr;
}

} // namespace tissue
