// assets/bake/shape_sheet.h
// A flap of tissue: a flat box, its free corners rounded and its free edges thinned by one smooth
// map. Skin and tetrahedra are grids of the same box under the same map, so they agree whatever
// their fineness. Called by recipe and bake.
#pragma once

#include "assets/bake/surface.h"

#include <array>
#include <cstdint>

namespace bake {

struct SheetShape {
    glm::dvec3 centre_mm{0.0};
    glm::dvec3 size_mm{1.0};  // width, length, thickness; attached at +y, free at -y
    glm::dvec3 tilt_deg{0.0}; // turned about x, then y, then z
    std::array<int, 3> cells{1, 1, 1};
    double corner_mm = 0.0;         // how far the free corners move inwards, in x and in y
    double edge_thickness_mm = 1.0; // at the three free edges
    double taper_mm = 1.0;          // over which it is reached
    double bulge_mm = 0.0;          // of the middle, towards +z
    double noise_mm = 0.0, noise_wavelength_mm = 40.0; // towards +z only
    std::uint64_t seed = 1;
};

/// The corner's rounding reaches this many times corner_mm; 4 would be a smooth edge, whose
/// tetrahedron in the corner is flat.
inline constexpr double kCornerReach = 5.0;

/// Of a taper, the widest cell beside a free edge: with even cells wider than the taper a flap of
/// 7 x 6 misses 2.7 % of its volume, so 1.5 %.
inline constexpr double kTaperShare = 0.75;
/// But of an even cell at least this: a taper much shorter is not worth a sliver.
inline constexpr double kNarrowest = 0.5;

/// The whole skin, closed.
Surface sheet_surface(const SheetShape& shape, double edge_m);
/// Six tetrahedra a cell, the left half mirrored, so that a diagonal runs into both free corners;
/// cells beside free edges no wider than follows their taper.
tissue::TetMesh sheet_mesh(const SheetShape& shape);

} // namespace bake
