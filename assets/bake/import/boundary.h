// assets/bake/import/boundary.h
// The boundary of the tetrahedra for a given skin: coarse triangles that keep to the skin, hold its
// volume and never cross each other. Called by organ_body.
#pragma once

#include "assets/bake/import/notes.h"
#include "assets/bake/recipe.h"
#include "assets/bake/remesh.h"

namespace bake {

struct BoundaryOptions {
    double edge_m = 0.0;
    double volume_m3 = 0.0; // to hold
    double farthest = 0.0;  // from the skin, both ways; of edge_m, or of the mean edge if shorter
    RemeshOptions keep;
    std::vector<FineSpot> fine; // asked for
};

struct Boundary {
    Surface surface;
    double distance_m = 0.0;   // from the skin, both ways
    std::size_t crossings = 0; // pairs of triangles
    int tries = 0;
    std::string problem; // empty: good
};

/// Where triangles cross or are too far from the skin, edges are made shorter and it is tried
/// again, up to eight times; the best try is returned. `by_shape`: wanted edges to begin with.
Boundary make_boundary(const Surface& skin, const SizeAt& by_shape, const BoundaryOptions& options,
                       const Notes& notes);

/// Spots with shorter edges than `size` at places that went wrong.
void add_spots(const std::vector<glm::dvec3>& places, const SizeAt& size,
               std::vector<FineSpot>& spots);

} // namespace bake
