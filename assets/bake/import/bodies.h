// assets/bake/import/bodies.h
// Closed pieces to bodies: which shells face outwards, which are cavities of others, which are
// specks. Called by import after clean.
#pragma once

#include "assets/bake/import/notes.h"
#include "assets/bake/surface.h"

namespace bake {

struct Body {
    Surface surface;                  // outer shell first, then its cavities
    std::vector<glm::dvec3> cavity_m; // a place in each cavity
    double volume_m3 = 0.0;           // without the cavities
};

/// Pieces of less than this share of the largest one's volume are specks of a segmentation.
inline constexpr double kSpeckShare = 1e-3;

/// Largest body first. A shell inside another is a cavity of it, whichever way its triangles face;
/// a shell inside a cavity is a body. Throws ImportRefused if nothing has a volume.
std::vector<Body> make_bodies(std::vector<Surface> closed, Notes& notes);

} // namespace bake
