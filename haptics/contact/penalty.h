// haptics/contact/penalty.h
// The penalty method: the nearest point of the surface pushes along the nearest face's normal with
// k times the depth. It has no memory, which is what makes it fail: beyond the middle of something
// thin it pushes out on the far side, and from one tick to the next the nearest face may be another
// (Zilles and Salisbury, A constraint-based god-object method for haptic display, IROS 1995,
// section 2, lists both). Here to be compared with.
#pragma once

#include "haptics/collision/index.h"
#include "haptics/contact/proxy_method.h"

namespace haptics {

/// F = k (radius - s) n, s the signed distance of the ball's centre: negative behind the nearest
/// face, so here winding means something, the mesh is closed and its triangles face outwards.
/// Where several faces share the nearest point, the one that is seen least from aside decides.
/// `proxy_m` is the place on the surface's outside that the spring pulls to. Knows no friction and
/// no motion of the mesh: it is where it is now. 1 kHz.
void step_penalty(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& input,
                  ProxyState& state) noexcept;

} // namespace haptics
