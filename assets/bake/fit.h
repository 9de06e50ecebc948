// assets/bake/fit.h
// Moves the points of a coarse surface so that the surface, not its points, lies on a fine one:
// a coarse mesh with its points on a convex body is too small, and cuts off thin edges. Called by
// bake for the boundary of the tetrahedra.
#pragma once

#include "assets/bake/surface.h"

namespace bake {

/// Least squares over the points of `skin` (area-weighted), by `rounds` of local averages of what
/// is left. Points on creases of the skin of more than `crease_deg` do not move; where only the
/// coarse surface bends as much, as it does around whatever is slender for it, there is none.
void fit_to_skin(const Surface& skin, int rounds, double crease_deg, Surface& coarse);

} // namespace bake
