// haptics/rigid/separation.h
// Distance of two convex pieces that are apart, and between which points. Called at 1 kHz by
// contact_patch and close_pairs; no allocation.
//
// Gilbert, Johnson, Keerthi 1988: the point of the Minkowski difference nearest to the origin, by
// a simplex that is exchanged corner by corner; the nearest point of the simplex by the regions of
// its faces, edges and corners.
#pragma once

#include "haptics/rigid/convex_hull.h"
#include "haptics/rigid/rigid_pose.h"

namespace haptics {

/// In the frame of piece a.
struct Separation {
    bool apart = false;      // false: they overlap or touch; the rest says nothing
    double distance_m = 0.0; // exact to 1e-9 of it, never above the true one by more
    glm::dvec3 normal{0.0};  // unit, from a to b
    glm::dvec3 on_a_m{0.0}, on_b_m{0.0};
    int steps = 0;
};

/// `guess`: direction from a to b to begin with (any length; last tick's normal saves steps).
/// `beyond_m`: stops as soon as the distance is known to be above it; distance_m is then some
/// lower bound above it, the points are not the nearest. Real-time safe.
Separation separation(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a,
                      const glm::dvec3& guess, double beyond_m) noexcept;

} // namespace haptics
