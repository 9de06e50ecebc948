// assets/bake/quality.h
// How good tetrahedra are, and moving inner nodes so that the worst of them gets better. Called
// by bake after TetGen.
#pragma once

#include "tissue/mesh/tet_mesh.h"

namespace bake {

struct TetQuality {
    double worst_dihedral_deg = 0.0; // smallest; a regular tetrahedron has 70.53
    double largest_dihedral_deg = 0.0;
    double worst_aspect = 0.0, mean_aspect = 0.0; // longest edge / smallest height, regular = 1
    double mean_edge_m = 0.0;
};
TetQuality tet_quality(const tissue::TetMesh& mesh);

/// Six dihedral angles of a tetrahedron of positive volume, in radians.
std::array<double, 6> dihedrals_rad(const std::array<glm::dvec3, 4>& corner);

/// Moves nodes that are not on the boundary so that the smallest dihedral angle around each grows
/// (hill climbing over fixed directions, Freitag & Ollivier-Gooch 1997); never makes a tetrahedron
/// worse than the worst it had beside it.
void improve_inner_nodes(tissue::TetMesh& mesh, int sweeps);

} // namespace bake
