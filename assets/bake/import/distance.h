// assets/bake/import/distance.h
// How far two surfaces are from each other. Called by import.
#pragma once

#include "assets/bake/surface.h"

namespace bake {

struct Far {
    double distance_m = 0.0;
    glm::dvec3 at_m{0.0}; // on the surface measured from
};

/// Farthest of sampled places of `from` from `to`: corners, edge middles and centres of its
/// triangles, evenly thinned out to half a million places.
Far farthest(const Surface& from, const Surface& to);

/// Both ways.
Far hausdorff(const Surface& a, const Surface& b);

/// Appends places on `from` that are farther than `limit_m` from `to`, twice that apart.
void add_far_places(const Surface& from, const Surface& to, double limit_m,
                    std::vector<glm::dvec3>& places);

} // namespace bake
