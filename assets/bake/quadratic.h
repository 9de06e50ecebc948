// assets/bake/quadratic.h
// How coarse an organ's tetrahedra may be if their shapes are quadratic: the coarsest that keep the
// skin's compliance within 7 % in the mean and 15 % at every place (K) of a much finer mesh. Called
// by bake and import.
//
// Measured on quadratic tets with their footprint rows and the sub-grid term, statics, tip of 3 mm,
// 50 places by area; normal compliance over that of a fine quadratic mesh of the same skin, mean
// [least most]:
// - boundary edges up to 1.8 radii of curvature, as linear tets have them, corner nodes asked
//   120 | 100 | 60: liver 1.01 [.90 1.16] | 1.00 [.85 1.15] | .98 [.75 1.16]; spleen, 100: 1.01
//   [.99 1.09]; gallbladder, which hangs on a duct of 10 mm, 110 | 100 | 88: 1.11 | 1.30 | 1.98,
//   for its duct becomes three-cornered
// - edges up to 1.3 radii, 90 asked, as here: liver 1.00 [.93 1.14], spleen 1.00 [.98 1.09],
//   gallbladder .95 [.89 .97], but 1.14 with 80: what hangs on a stalk is as good as the stalk
// - tubes, stations apart by 1.3 | 2 | 2.5 | 3 | 4 radii: .98 | .96 | .94 | .90 | .86
// - the flap, cells in one layer, 12 x 9 | 9 x 7, even: 1.01 [.91 1.15] | .96 [.80 1.29], both in
//   the row of tets at its hinge; its recipe has 7 x 6, away from the hinge .97, least .88
// Beside that, linear tets with their (local) mesh terms: liver and spleen 1.01, gallbladder .67,
// tubes .61 to .69, flaps .39 and .27: they lock where something bends as a whole.
#pragma once

#include "assets/bake/recipe.h"

namespace bake {

/// Beside NAME.organ lies NAME.quadratic.organ.
inline constexpr const char* kQuadraticEnding = ".quadratic.organ";

/// Corner nodes of a body whose edge nobody chose, before grading.
inline constexpr double kQuadraticNodes = 90.0;

/// Boundary edges where the body is strongly curved: five around a stalk.
inline constexpr double kQuadraticRadiiPerEdge = 1.3;

/// The recipe with the tetrahedra for quadratic shapes instead of its own: quadratic_edge_mm or
/// quadratic_cells where it says, else the edge for kQuadraticNodes, stations two radii apart, or
/// three quarters of the cells; never finer than its own. Fine spots coarsen with the edge.
/// `skin` of the recipe.
Recipe quadratic_recipe(const Recipe& recipe, const Surface& skin);

} // namespace bake
