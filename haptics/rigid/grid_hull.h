// haptics/rigid/grid_hull.h
// Quickhull on integer points: triangles only, exact. Part of convex_hull; load time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace haptics {

/// Coordinates below 2^30 in size: the determinant below then fits 128 bits.
using GridPoint = std::array<std::int64_t, 3>;
using GridTriangle = std::array<std::uint32_t, 3>; // point numbers, counter-clockwise from outside

/// Hull of the points that lie farther than `tolerance` (grid steps) from what is there already.
/// Empty if all points lie within `tolerance` of a plane.
std::vector<GridTriangle> grid_hull(std::span<const GridPoint> point, double tolerance);

} // namespace haptics
