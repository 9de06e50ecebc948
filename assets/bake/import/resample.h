// assets/bake/import/resample.h
// The last repair: what lies inside a surface that crosses itself, has open seams or overlaps
// others is sampled on a grid (winding number above one half) and gets a new surface. Called by
// import.
#pragma once

#include "assets/bake/surface.h"

namespace bake {

struct Resampled {
    Surface surface;           // closed and manifold; may be of several pieces
    Surface seen;              // triangles given that lie between inside and outside
    double hidden_share = 0.0; // of the area given: walls within the body
};

/// Details below `cell_m` are lost; cells grow if there would be more than two million. Throws
/// std::invalid_argument if there is no inside.
Resampled resample(const Surface& given, double cell_m);

/// The triangles of `given` that lie between inside and outside, and how much does not.
void find_seen(const Surface& given, double cell_m, Resampled& result);

} // namespace bake
