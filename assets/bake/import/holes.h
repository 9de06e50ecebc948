// assets/bake/import/holes.h
// Closes small holes of a surface with the patch of least area. Called by clean.
#pragma once

#include "assets/bake/import/notes.h"
#include "assets/bake/import/topology.h"

namespace bake {

/// A hole of up to this share of the piece's area is filled; more than that would be an invention.
inline constexpr double kHoleShare = 0.05;

struct Hole {
    glm::dvec3 centre_m{0.0};
    double area_m2 = 0.0, length_m = 0.0; // of the patch, around the rim
    std::uint32_t triangle = 0;           // one at the rim
    std::vector<std::uint32_t> rim;       // points, in the order of the patch
    std::vector<tissue::Triangle> patch;  // empty: the rim is too long or not simple
};

/// The rims of the open edges, largest patch first. The patch of least area by dynamic programming
/// (Barequet & Sharir 1995) up to 200 corners; a longer rim gets no patch and the area of a cone.
std::vector<Hole> find_holes(const Surface& surface, const Topology& topology);

} // namespace bake
