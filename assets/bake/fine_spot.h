// assets/bake/fine_spot.h
// Places with shorter edges than the rest of a surface. Asked for in recipes and at import, and
// added where coarse triangles went wrong.
#pragma once

#include "assets/bake/surface.h"

#include <vector>

namespace bake {

/// A place with shorter edges: edge_mm up to radius_mm, then growing by `growth` per unit.
struct FineSpot {
    glm::dvec3 centre_mm{0.0};
    double radius_mm = 0.0, edge_mm = 0.0, growth = 0.5;
};

/// `base`, but shorter at the spots.
SizeAt with_spots(SizeAt base, std::vector<FineSpot> spots);

} // namespace bake
