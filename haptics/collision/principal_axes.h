// haptics/collision/principal_axes.h
// The directions in which a surface is spread out most, second and least. Setup of box trees.
#pragma once

#include "haptics/collision/mesh_view.h"

#include <glm/mat3x3.hpp>

namespace haptics {

struct SurfaceSpread {
    glm::dmat3 axes{1.0}; // columns: right-handed, orthonormal, the most spread out first
    glm::dvec3 mean_m{0.0};
};

/// Of the surface of some triangles, by the covariance of all its points (Gottschalk, Lin, Manocha
/// 1996, OBBTree); of triangles without area, of their corners.
SurfaceSpread surface_spread(const MeshView& mesh, std::span<const std::uint32_t> triangle);

} // namespace haptics
