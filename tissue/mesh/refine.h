// tissue/mesh/refine.h
// A mesh of the same body with smaller tetrahedra around a place: for a reference that is measured
// by, so facets stay flat and only the mesh changes, not the shape. Called by studies and tests;
// any thread, not real time. Longest-edge bisection (Rivara 1984): an edge is cut in the middle, in
// every tet that has it, and only while it is the longest of all of them; a longer one nearby is
// cut first. So the mesh stays conforming without a repair, and angles do not shrink without end.
#pragma once

#include "tissue/mesh/elastic_bed.h"

namespace tissue {

/// Longest edge allowed for a tet whose nearest corner is `distance` from the place, or from the
/// line between it and `place_m + down_m`:
///   edge_m + growth max(0, distance - core_m)
struct RefineSize {
    double edge_m = 0.0, core_m = 0.0;
    double growth = 0.5;
    glm::dvec3 down_m{0.0};
};

struct RefinedMesh {
    TetMesh mesh;                       // nodes of the coarse mesh keep their numbers
    std::vector<std::uint8_t> anchored; // a new node is if both ends of its edge are
    std::vector<BedSample> bed;         // the same points with the same stiffness
};

/// `anchored`: a flag per node, or empty: none. Throws std::invalid_argument as check_mesh(), for a
/// size that does not fit, edge_m or growth not above 0, a sample of a tet that the mesh lacks, and
/// beyond `most_tets`.
RefinedMesh refined(const TetMesh& mesh, std::span<const std::uint8_t> anchored,
                    std::span<const BedSample> bed, const glm::dvec3& place_m,
                    const RefineSize& size, std::size_t most_tets = 400000);

/// Least over the tets of 12 (3 V)^(2/3) / sum of squared edges: 1 for a regular tet, 0 for a flat
/// one (Liu & Joe 1994).
double least_shape_quality(const TetMesh& mesh);

} // namespace tissue
