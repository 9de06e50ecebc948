// tests/bake/skin_compliance.h
// How a baked organ yields to a flat tip at places of its skin, in statics: rows on its tetrahedra
// of either order as they lie in the file, mesh term, sub-grid term. Shared by tests of bake.
#pragma once

#include "tissue/mesh/baked_organ.h"

#include <cstdint>
#include <vector>

namespace bake_tests {

/// Vertices of the skin, seeded, each as likely as its share of the area.
std::vector<std::uint32_t> skin_places(const tissue::ContactSurface& skin, int count,
                                       std::uint64_t seed);

/// m/N along the normals of these vertices.
std::vector<double> normal_compliances_mpn(const tissue::BakedOrgan& organ,
                                           const std::vector<std::uint32_t>& vertices,
                                           double tip_radius_m);

struct Ratios {
    double mean, deviation, low, high;
};
/// Stiffness of `organ` over that of `finer`, which has the same skin, at 50 places.
Ratios stiffness_ratios(const tissue::BakedOrgan& organ, const tissue::BakedOrgan& finer,
                        double tip_radius_m, std::uint64_t seed);

} // namespace bake_tests
