// assets/bake/import/grouping.h
// Pieces to bodies that can be filled with tetrahedra: those that cross themselves or overlap
// others are sampled anew, together. Called by import.
#pragma once

#include "assets/bake/import/bodies.h"
#include "assets/bake/import/clean.h"
#include "assets/bake/import/phase_clock.h"

namespace bake {

struct GivenBody {
    Body body;    // fit for tetrahedra
    Surface seen; // triangles of the file that bound it: what distances are measured from
};

/// Largest first. `edge_m` is that of the tetrahedra and decides how fine sampling must be. Throws
/// ImportRefused with a place where sampling loses more than half an edge.
std::vector<GivenBody> separate_bodies(Pieces pieces, double edge_m, Notes& notes,
                                       PhaseClock& clock);

} // namespace bake
