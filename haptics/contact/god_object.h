// haptics/contact/god_object.h
// The god-object of Zilles and Salisbury (A constraint-based god-object method for haptic display,
// IROS 1995): a point that follows the device but never passes a facet. Here to be compared with,
// so with the weaknesses of the published method:
//  - it is a point: `radius_m` means nothing, a surface is felt where the ball's centre meets it,
//    and it falls through any crack that its line hits;
//  - constraints are equations: a plane once found in a tick is not given up in it, even if its
//    multiplier pulls, so in a blunt concave fold the point stays in the fold;
//  - a mesh that moves past it leaves it on the other side;
//  - no friction (the paper only suggests where it would act).
#pragma once

#include "haptics/collision/index.h"
#include "haptics/contact/proxy_method.h"

namespace haptics {

/// F = k (god-object - device). A facet that the line from the god-object to where it wants to go
/// passes becomes a constraint plane, from whichever side it is met; the place nearest to the
/// device on all planes found (Lagrange multipliers) is where it wants to go next, until nothing
/// is in the way or three planes hold it. 1 kHz.
void step_god_object(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& input,
                     ProxyState& state) noexcept;

} // namespace haptics
