// sim/study/hold_side.h
// An organ of a study held by a bed on one of its sides, where a surface that was imported is held
// by nothing. Called by trocar study organ.
#pragma once

#include "tissue/mesh/baked_organ.h"

#include <memory>

namespace sim {

/// Springs for an organ that was baked loose, or to replace its own: a bed over the share of its
/// extent that lies farthest along `toward`.
struct HoldSide {
    glm::dvec3 toward{0.0}; // 0: as baked
    double share = 0.3;
    double length_m = 0.01;
};

using OrganPointer = std::shared_ptr<const tissue::BakedOrgan>;

/// Throws std::invalid_argument as held_by() does, and for a share that is none.
OrganPointer held_organ(OrganPointer organ, const HoldSide& hold);

} // namespace sim
