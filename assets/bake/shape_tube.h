// assets/bake/shape_tube.h
// A vessel or a duct: a round bar along a line, with flat ends. Its cross-sections are polygons
// that are as large as the circle, so that few sides lose no volume; or the rod along that line.
// Called by recipe and bake.
#pragma once

#include "assets/bake/surface.h"
#include "tissue/rod/rod_line.h"

#include <vector>

namespace bake {

struct TubeShape {
    std::vector<glm::dvec3> point_mm;            // the line passes each
    double radius_mm = 1.0, radius_end_mm = 1.0; // changes evenly along the line
    int sides = 6;                               // of the tetrahedra's cross-section
};

/// The line must not bend tighter than this many radii: the inner side of the tetrahedra, whose
/// polygon is larger than the circle, would fold.
inline constexpr double kTightestBend = 1.5;

/// The whole skin, closed.
Surface tube_surface(const TubeShape& shape, double edge_m);
/// A node in the middle and a ring around it at every station.
tissue::TetMesh tube_mesh(const TubeShape& shape, double edge_m);
/// A node at every station; held by nothing.
tissue::RodLine tube_line(const TubeShape& shape, double edge_m);

} // namespace bake
