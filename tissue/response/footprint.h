// tissue/response/footprint.h
// Contact on coarse tetrahedra: makes the footprint rows of a ContactSurface, at bake time.
// Kernel k(rho) = 2/(pi r^2) (1 - rho^2), rho = distance / r, 90 points on 5 rings, in the tangent
// plane at the vertex, each carried along the normal onto the body's boundary; points off the body
// are left out and the rest renormalised. r = max(1.3175 a, min(c h, max(s, h/2))): a tip radius,
// h nodal size, c = 1.5, s distance to a free edge of the body (or to where it has turned by 66
// deg): on the skin where that is closed, so that it does not hang on the facets of the tetrahedra.
#pragma once

#include "tissue/mesh/contact_surface.h"

namespace tissue {

/// thickness_m where nothing rigid holds the far side: the sub-grid term is a half-space's.
inline constexpr double kUnbacked_m = 1e3;

struct FootprintOptions {
    double size_factor = 1.5;       // c
    double tip_radius_max_m = 3e-3; // a
    bool point_rows = false;        // negative control: bare barycentric rows
};

/// Fills everything of `surface` from rest_m and triangles; the mesh terms with zeros (see
/// mesh_term.h). `anchored`: one flag per node of the body; may be empty: no node is.
/// thickness_m is the way through the body along the inward normal if it ends on a boundary
/// triangle with at least two anchored corners (a bonded layer), else kUnbacked_m.
/// Throws std::invalid_argument for sizes that do not fit, an index out of range, a vertex
/// without area, a surface that is not manifold.
void make_footprints(const TetMesh& mesh, std::span<const std::uint8_t> anchored,
                     const FootprintOptions& options, ContactSurface& surface);

/// Nodal size h of every node of the body (volume-weighted mean edge, smoothed so that it grows
/// by at most 0.3 per unit of distance).
std::vector<double> nodal_size_m(const TetMesh& mesh);

} // namespace tissue
