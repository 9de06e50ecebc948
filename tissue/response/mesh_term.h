// tissue/response/mesh_term.h
// The mesh term dW = W_quadratic - W_linear >= 0 of the same mesh under the same kernel, which
// softens what linear tetrahedra make too stiff (linear shapes are a subspace of the quadratic
// ones, so the difference has one sign). Statics, anchored nodes fixed, `bed` holding. Slow: bake
// time.
#pragma once

#include "tissue/mesh/elastic_bed.h"
#include "tissue/response/footprint.h"

namespace tissue {

/// Fills surface.mesh_term_n_m and _t_m, and _lean_m with what of dW is neither, so that
///   E dW = term_n n n^T + term_t (1 - n n^T) + lean,  n the rest normal.
/// Where an end bends, dW follows the bend and not the skin: lean is then as great as the others,
/// and a tip that sticks to the skin feels it. Call after make_footprints, with the same options.
/// Solved at every vertex of the skin, for near an edge nothing can be interpolated: the kernel
/// shrinks there and the compliance rises within a tetrahedron. Tangential: mean of two tangents.
/// `progress` (may be empty) is called with 0..1.
/// Throws std::invalid_argument for sizes that do not fit, a Poisson's ratio out of range, rows of
/// order 2, and a body that nothing holds: it has no static compliance.
void make_mesh_terms(const TetMesh& mesh, double poisson, std::span<const std::uint8_t> anchored,
                     const FootprintOptions& options, ContactSurface& surface,
                     std::span<const BedSample> bed = {}, void (*progress)(double share) = nullptr);

} // namespace tissue
