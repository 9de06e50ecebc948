// haptics/contact/surface_walk.h
// Carries a point along a triangulated surface: from triangle to triangle, never through it.
// Used on the 1 kHz patch, and by sim/bridge on the whole surface in the tissue loop; `Surface`
// is anything with
//   glm::dvec3 position(int triangle, int corner) const;   // as deformed now
//   int neighbour(int triangle, int corner) const;         // across the edge opposite; -1: rim
// so that vertices are evaluated only where the point goes. Real-time safe if these are.
#pragma once

#include "haptics/contact/local_model.h"

#include <glm/geometric.hpp>

namespace haptics {

struct WalkResult {
    SurfacePoint point;
    bool at_rim = false; // wanted to leave the surface; clamped to its edge
};

/// Moves `from` by `offset_m` (its part along the surface), at most kMaxWalkTriangles triangles.
template <typename Surface>
WalkResult walk(const Surface& surface, SurfacePoint from, glm::dvec3 offset_m) noexcept;

} // namespace haptics
