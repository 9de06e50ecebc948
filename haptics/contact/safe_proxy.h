// haptics/contact/safe_proxy.h
// Our contact method for a ball (or point) on a triangle mesh that may move under it: a proxy that
// is never on the wrong side and never stuck, with Coulomb friction, and tools' shafts likewise.
// For whoever feels a mesh at 1 kHz; nothing is allocated, thrown or waited for.
//
// What holds the proxy is made of half-spaces. If a plane has the ball's centre on one side and
// all of a triangle, grown by the radius, on the other, the centre may go anywhere on its side: no
// straight path there meets the triangle. So:
//   1. the mesh has moved: the ball rides along with what it touches. A plane with a fixed normal
//      that keeps them apart at both ends of the interval keeps them apart throughout, because
//      the farthest corner's way along the normal is convex in time: no root finding.
//   2. the ball moves to the place nearest to the device in front of the planes of what it touches
//      (plane_qp.h). Triangles on that path that are met by a swept ball bring in their planes,
//      until the path is free; then it is taken. Such steps are repeated, from planes made anew,
//      as the surface turns; what is left is done in the next tick.
// A plane comes from a real touch only, so triangles beside the path, or behind an edge, hold
// nothing up: it slides over convex edges and stops in concave ones.
//   3. it does not jump: beyond the device's own way it comes no farther in a tick than what
//      changes the force by kCatchUp_n. Off an edge or over a bump it catches up in a few ticks,
//      and the force with it.
// Subgoals and planes: Ruspini, Kolarov and Khatib 1997, to which moving triangles and the proof
// of every step are added.
#pragma once

#include "haptics/collision/index.h"
#include "haptics/contact/proxy_method.h"

namespace haptics {

inline constexpr double kCatchUp_n = 0.25;

/// One tick. Any radius from 0. With a WideTree as index, the proxy's own ring is used.
void step_safe_proxy(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& in,
                     ProxyState& state) noexcept;

} // namespace haptics
