// assets/bake/import/improve.h
// Lifts the worst tetrahedra by moving their nodes, those of the boundary too. Called by
// organ_body after TetGen, which keeps the boundary as it is.
#pragma once

#include "assets/bake/nearest.h"
#include "tissue/mesh/tet_mesh.h"

namespace bake {

struct ImproveOptions {
    double wanted_deg = 16.0;   // dihedral angles below it, or that near to 180, are worked on
    double boundary_deg = 14.0; // and below this one boundary nodes move too
    double hold_deg = 10.0;     // that holding the volume may cost
    double reach_m = 0.0;       // how far a node of the boundary may be from the skin
    double volume_m3 = 0.0;     // of the body, to be held
    int sweeps = 12;
};

/// Hill climbing over fixed directions (Freitag & Ollivier-Gooch 1997) at the nodes of bad
/// tetrahedra only; never makes the worst beside a node worse. Then the boundary moves along its
/// normals until the volume is right, as far as no tetrahedron gets worse than hold_deg. If the
/// boundary would cross itself, only inner nodes move.
void improve_nodes(tissue::TetMesh& mesh, const NearestOnSurface& skin,
                   const ImproveOptions& options);

} // namespace bake
