// tissue/mesh/elastic_bed.h
// How an organ is held: a bed of springs to the rest place, spread evenly over a region of its
// volume. Ligaments and loose connective tissue yield, so nothing is fixed; and because the region
// is integrated and not a choice of nodes, two meshes of one organ are held alike.
//   energy = 1/2 (E / L^2) int_region |u|^2 dV
// L: the length over which a displacement of the tissue dies out inside the region; L -> 0 clamps.
// Made by bake and at load, any thread; the samples serve linear and quadratic shapes alike.
#pragma once

#include "tissue/mesh/tet_mesh.h"

#include <functional>

namespace tissue {

/// One point of the integral. Energy = 1/2 E stiffness_m |u(point)|^2.
struct BedSample {
    std::uint32_t tet = 0;
    std::array<double, 4> weight{}; // barycentric, sums to 1
    double stiffness_m = 0.0;       // volume / L^2, so that times E it is N/m
};

/// The bed where `inside` (of a rest place, metres) says so. Tets wholly inside are integrated
/// exactly for linear shapes; those across the rim by their points, 64 each. `length_m` > 0 is L,
/// else std::invalid_argument.
std::vector<BedSample> make_bed(const TetMesh& mesh,
                                const std::function<bool(const glm::dvec3&)>& inside,
                                double length_m);

/// A bed so weak that it only keeps a loose body from flying off in statics: L = twice the
/// diagonal of its box, everywhere.
std::vector<BedSample> weak_bed(const TetMesh& mesh);

} // namespace tissue
