// haptics/rigid/convex_contact.h
// Contact of two convex pieces from tick to tick: which way they push each other, and over what
// area. step_rigid calls it for every pair of pieces that are near; 1 kHz, no allocation.
//
// The direction is that of the smallest penetration, found by a walk from last tick's direction,
// so that it stays on the side of entry, and turns at most kMostTurn_rad per tick, so that it
// never snaps (at the edge of a box the smallest penetration itself turns 90 degrees at once).
// While it is held back the depth is still that of the way out, so nothing is left when the pieces
// part; and where a local minimum ends and the next one is far less deep, the way out shrinks by at
// most a fifth per tick.
//
// The area: seen along the direction n, the upper surface of a and the lower surface of b overlap
// by a column d(x) at each x across n. That is the depth of the patches, piecewise linear over
// pairs of faces. It is continuous in the poses, its integrals know nothing of tessellation, and
// over a flat face it is the plain depth; under a corner its weighted mean is half the depth of
// the corner.
#pragma once

#include "haptics/rigid/contact_patch.h"
#include "haptics/rigid/convex_hull.h"
#include "haptics/rigid/rigid_pose.h"

namespace haptics {

/// 5 degrees: 90 degrees in 18 ms, and 9 % of the force per tick.
inline constexpr double kMostTurn_rad = 0.0873;

/// What a pair of pieces keeps from tick to tick. A pair that comes near starts with a new one.
struct PairMemory {
    glm::dvec3 normal_a{0.0}; // frame of piece a; 0: not known
    double way_out_m = 0.0;   // of last tick, if it overlapped
    bool overlapped = false;
};

/// In the frame of piece a.
struct PairContact {
    double depth_m = 0.0;   // along the normal; negative: apart by that
    glm::dvec3 normal{0.0}; // b is pushed along it
    double scale = 1.0;     // below 1: the direction was held back; the way out is scale * depth_m
};

/// Pieces farther apart than `margin_m` are not looked at closely: depth_m is then below -margin_m.
/// Real-time safe.
PairContact convex_contact(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a,
                           double margin_m, PairMemory& memory) noexcept;

/// Adds the patches of an overlapping pair, in the world. Surfaces steeper than 89.9 degrees to the
/// normal are left out, and all but the 64 faces of each piece nearest to its extreme vertex, so
/// pieces of more than some hundred faces feel rounder than they are. Two balls of 4000 faces, deep
/// in each other, take 0.2 ms; boxes 2 us.
void overlap_patches(const ConvexHull& a, const ConvexHull& b, const RigidPose& a_in_world,
                     const RigidPose& b_in_a, const PairContact& contact,
                     PatchList& patches) noexcept;

} // namespace haptics
