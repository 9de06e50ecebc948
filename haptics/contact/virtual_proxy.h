// haptics/contact/virtual_proxy.h
// The virtual proxy of Ruspini, Kolarov and Khatib (The haptic display of complex graphical
// environments, SIGGRAPH 1997): a ball that moves towards the device as far as the surface lets
// it, in straight steps, along the planes that the surface has where the ball touches it. Here to
// be compared with, so with the weaknesses of the published method:
//  - surfaces that move while it moves are not in the paper: it takes the mesh as it is now, so one
//    that jumps past the ball's centre leaves it on the other side;
//  - force shading turns forces, not distances: over the facets of a cylinder of radius R the force
//    still ripples by k R (1 - cos(pi / N));
//  - a shaded force is no gradient, so a hand can draw work from it: over a facet at A from the
//    axis it leans by k x d / (A - d) at x beside its middle, d deep, and a loop out to X at one
//    depth and back at another leaves k X^2 / 2 times the difference of d / (A - d).
#pragma once

#include "haptics/collision/index.h"
#include "haptics/contact/proxy_method.h"

namespace haptics {

/// F = k (proxy - device) in every tick, whatever keeps the proxy from the device, also that the
/// steps ran out; `touching` says that something does. The ball's radius must be above 0: without
/// one, no force. In the configuration space of its centre the surface is everything within a
/// radius of the mesh; a step there is a swept ball (section 3). Where it touches, each contact is
/// a plane, and the next subgoal the point nearest to the device in front of all (eq. 1), solved
/// exactly (plane_qp.h).
/// Force shading: if the input has `vertex_normal`, their mean where the ball touches says where
/// the force points, in two passes, first with planes that have these normals, then with those that
/// the surface has; the steps are swept as ever, so no triangle is passed. Creases (triangles that
/// meet without a vertex in common) and planes are felt as without, to the bit.
/// Friction (section 5): while the tangential force is below static_friction times the normal one
/// the subgoal is where the proxy is; beyond, it moves until dynamic_friction times the normal
/// force is left. 1 kHz; at most kMostSubgoals steps, what is left is for the next tick.
void step_virtual_proxy(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& input,
                        ProxyState& state) noexcept;

inline constexpr int kMostSubgoals = 16;

} // namespace haptics
