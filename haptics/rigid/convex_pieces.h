// haptics/rigid/convex_pieces.h
// Cuts a triangle surface into patches whose convex hulls stay inside the solid. Load time; the
// pieces make a RigidShape.
//
// Surface decomposition as in SWIFT++ (Ehmann, Lin 2001, Accurate and Fast Proximity Queries
// Between Polyhedra Using Convex Surface Decomposition): from a seed triangle the patch grows over
// its neighbours while every triangle stays on the hull of the patch. Then it is cut back until
// the hull does not leave the solid, tested at samples of its faces and edges: a fault smaller
// than a quarter of a hull's face may go unseen.
//
// The hulls cover the surface, not the inside: what is deep inside a thick concave solid may touch
// no piece. A surface concave everywhere (the inside of a bowl) becomes one piece per triangle.
#pragma once

#include "haptics/rigid/convex_hull.h"
#include "haptics/rigid/surface_query.h"

namespace haptics {

/// Patches flatter than `thickness_m` are given that thickness inward; where a solid is thinner,
/// down to 1/64 of it. Open surfaces become shells of that thickness; their inside is behind the
/// triangles. Faces that look into the solid (or into the next shell) are marked `inner`.
/// Throws std::invalid_argument for thickness_m <= 0 and what convex_hull throws, naming surface
/// and piece.
std::vector<ConvexHull> convex_pieces(const RigidSurface& surface, double thickness_m);

} // namespace haptics
