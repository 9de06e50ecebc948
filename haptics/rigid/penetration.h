// haptics/rigid/penetration.h
// How far, and which way, one of two overlapping convex pieces must move to come free. Called at
// 1 kHz by contact_patch; no allocation.
//
// The answer is the smallest support distance h(n) = max_a n.a - min_b n.b of the Minkowski
// difference, and that is reached at a vertex of the overlay of the two Gauss maps: a face of one
// piece against a vertex of the other, or two edges. DEEP (Kim, Lin, Manocha 2002, Incremental
// Penetration Depth Estimation Between Convex Polytopes Using Dual-Space Expansion) walks there:
// a pair of vertices, one of each piece, owns the convex spherical polygon of directions in which
// both are extreme; take its best corner, look at all pairs that share that corner, move to the
// best of them, until none is better.
//
// A walk may end in a local minimum: h over the overlay is not convex (a rod through the middle of
// a plate comes free upward and downward). From a start near last tick's direction that is wanted:
// the way out does not flip. Without history several starts are tried.
#pragma once

#include "haptics/rigid/convex_hull.h"
#include "haptics/rigid/rigid_pose.h"

namespace haptics {

/// In the frame of piece a.
struct Penetration {
    glm::dvec3 normal{0.0, 0.0, 1.0}; // unit; b comes free along it, a against it
    double depth_m = 0.0;             // way to move; negative if the pieces are apart: then only
                                      // some separating distance, not the largest
    std::uint32_t vertex_a = 0, vertex_b = 0; // extreme along the normal
    int hubs = 0;                             // pairs of vertices looked at
    bool found = false; // false: every direction is of an inner face; normal is the start
};

/// One walk from a direction (any length but 0). `b_in_a`: pose of b seen from a. Corners of the
/// overlay at a face marked `inner` are passed over. Real-time safe.
Penetration walk_penetration(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a,
                             const glm::dvec3& start) noexcept;

/// The best of several walks: from the line between the centres and from the best normals among up
/// to 32 faces of each piece, nine in all. Real-time safe; some fifteen times one walk.
Penetration penetration(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a) noexcept;

} // namespace haptics
