// tissue/response/footprint.h
// Contact on coarse tetrahedra: makes the footprint rows of a ContactSurface, at bake time.
// Kernel k(rho) = 2/(pi r^2) (1 - rho^2), rho = distance / r, 90 points on 5 rings, in the tangent
// plane at the vertex, each carried along the normal onto the body's boundary; points off the body
// are left out and the rest renormalised. r = max(1.3175 a, min(c h, max(s, h/2))): a tip radius,
// h nodal size, s distance to a free edge of the body (or to where it has turned by 66 deg): on the
// skin where that is closed, so that it does not hang on the facets of the tetrahedra.
// c = 1.5 on linear shapes, with a mesh term. On quadratic ones, without: 1.25, but 1.5 where the
// tets are graded (h / mean edge here > 1.2). Normal stiffness of blocks over the tissue's, mean of
// 50 places, flat tips a = 1.5 / 2.5 / 5 mm (uniform tets of 12 and 8 mm; 2.5 to 12 mm; tangential
// 0.5 to 1 % higher):
//          12 mm                8 mm                 graded
//   c 1    1.01 / 1.02 / 1.04   1.03 / 1.05 / 1.12   1.03 / 1.06 / 1.13
//   1.25   1.01 / 1.01 / 1.02   1.02 / 1.03 / 1.06   1.02 / 1.04 / 1.08
//   1.5    1.00 / 1.00 / 1.01   1.01 / 1.01 / 1.03   1.01 / 1.02 / 1.04
// A wide kernel leaves the shape to theory, which knows no curvature: on a spleen in tets of 12 mm
// tangential compliance is 5, 6 and 7 % too low with c = 1, 1.25 and 1.5.
#pragma once

#include "tissue/mesh/contact_surface.h"

namespace tissue {

/// thickness_m where nothing rigid holds the far side: the sub-grid term is a half-space's.
inline constexpr double kUnbacked_m = 1e3;

struct FootprintOptions {
    int order = 1;                  // of the tets' shapes; 2: rows name nodes of quadratic_mesh()
    double size_factor = 1.5;       // c; of order 2 where the mesh is graded
    double even_factor = 1.25;      // c of order 2 where it is not
    double tip_radius_max_m = 3e-3; // a
    bool point_rows = false;        // negative control: bare barycentric rows
};

/// Fills everything of `surface` from rest_m and triangles; the mesh terms with zeros, which of
/// order 2 they stay (see mesh_term.h). Weights of order 2 may be negative, as shapes are.
/// `anchored`: one flag per node of the body; may be empty: no node is. thickness_m is the way
/// through the body along the inward normal if it ends on a boundary triangle with at least two
/// anchored corners (a bonded layer), else kUnbacked_m. Throws std::invalid_argument for sizes that
/// do not fit, an index out of range, a vertex without area, a surface that is not manifold.
void make_footprints(const TetMesh& mesh, std::span<const std::uint8_t> anchored,
                     const FootprintOptions& options, ContactSurface& surface);

/// Nodal size h of every node of the body (volume-weighted mean edge, smoothed so that it grows
/// by at most 0.3 per unit of distance).
std::vector<double> nodal_size_m(const TetMesh& mesh);

} // namespace tissue
