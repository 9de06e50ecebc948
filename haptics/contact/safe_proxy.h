// haptics/contact/safe_proxy.h
// Our contact method for a ball (or point) on a triangle mesh that may move under it: a proxy that
// keeps its side and does not stick, with Coulomb friction. For shafts and several tools see
// safe_tools.h. For whoever feels a mesh at 1 kHz; nothing is allocated, thrown or waited for.
//
// What holds the proxy is made of half-spaces. If a plane has the ball's centre on one side and
// all of a triangle, grown by the radius, on the other, the centre may go anywhere on its side: no
// straight path there meets the triangle. So:
//   1. the mesh has moved: the ball rides along with what it touches, in parts of the interval
//      short enough for its way to be swept free of what passes. A plane with a fixed normal that
//      keeps them apart at both ends keeps them apart throughout, because the farthest corner's
//      way along the normal is convex in time; under a face that turns, so does a normal that
//      turns (triangle_sweep.cpp).
//   2. the ball moves to the place nearest to the device in front of the planes of what it touches
//      (plane_qp.h). Triangles on that path, or deepest in at its end, bring in their planes until
//      the path is free; then it is taken. Such steps are repeated, from planes made anew,
//      as the surface turns; what is left is done in the next tick.
// Triangles that are not in the way make no plane (but the nearest, if nothing is touched), so
// those beside the path or behind an edge hold nothing up: it slides over convex edges and stops
// in concave ones.
//   3. it does not jump: beyond the device's own way it comes no farther in a tick than what
//      changes the force by kCatchUp_n. Off an edge or over a bump it catches up in a few ticks,
//      and the force with it.
// Not proved: a mesh that closes on the ball from all sides (it goes where that is least, and may
// be passed), and more triangles within its radius than NearLeaves has room for: at least 96, some
// 600 as a rule (then some are not looked at).
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
