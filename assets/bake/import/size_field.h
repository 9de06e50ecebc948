// assets/bake/import/size_field.h
// How long the edges of an organ's surfaces should be, from its own shape. Called by import.
#pragma once

#include "assets/bake/remesh.h"

namespace bake {

/// How remeshing should treat a surface: creases are kept if the surface has few and clear ones, as
/// cut planes and machined parts have; steps of voxels and noise are not creases. Sharp tips stay.
RemeshOptions edges_to_keep(const Surface& surface, double skin_m);

/// Diameter of the largest ball that touches the surface at each point from inside (shrinking
/// balls, Ma, Bae & Choi 2012), or from outside where that is smaller; at most `most_m`. A ball
/// that is not held from the far side measures curvature or a corner, not thickness: `most_m`.
std::vector<double> thickness_m(const Surface& surface, double most_m);

/// Wanted edge for `skin`: `edge_m`, shorter where the surface is curved (`radii_per_edge` times
/// the radius of curvature, down to 0.35 of it) or where the body, or the gap between two parts of
/// it, is thin (down to a quarter). What is smaller than an edge (noise, steps) is smoothed away
/// before looking.
SizeAt shape_size(const Surface& skin, double edge_m, double radii_per_edge,
                  const RemeshOptions& keep);

/// About how many nodes tetrahedra of that size in `skin` would have.
double nodes_for(const Surface& skin, double volume_m3, const SizeAt& size);

} // namespace bake
