// tissue/response/footprint.h
// Contact on coarse tetrahedra: makes the footprint rows of a ContactSurface, at bake time.
// Kernel k(rho) = 2/(pi r^2) (1 - rho^2), rho = distance / r, 36 points on 3 rings, in the tangent
// plane at the vertex, each dropped onto the body's boundary; points off the body are left out and
// the rest renormalised. r = max(1.3175 a, min(c h, s)): a tip radius, h nodal size, c = 1.5,
// s distance to a free edge of the body.
#pragma once

#include "tissue/mesh/contact_surface.h"

namespace tissue {

struct FootprintOptions {
    double size_factor = 1.5;       // c
    double tip_radius_max_m = 3e-3; // a
    bool point_rows = false;        // negative control: bare barycentric rows
};

/// Fills everything of `surface` except the mesh terms, from rest_m and triangles.
void make_footprints(const TetMesh& mesh, const FootprintOptions& options, ContactSurface& surface);

/// Nodal size h of every node of the body (volume-weighted mean edge, smoothed so that it grows
/// by at most 0.5 per unit of distance).
std::vector<double> nodal_size_m(const TetMesh& mesh);

/// The mesh term dW = W_quadratic - W_linear >= 0 of the same mesh under the same kernel, which
/// softens what linear tetrahedra make too stiff. Statics, anchored nodes fixed. Slow: bake time.
/// `progress` (may be empty) is called with 0..1.
void make_mesh_terms(const TetMesh& mesh, double poisson, std::span<const std::uint8_t> anchored,
                     ContactSurface& surface, void (*progress)(double share));

} // namespace tissue
