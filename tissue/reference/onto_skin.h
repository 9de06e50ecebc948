// tissue/reference/onto_skin.h
// A reference body's facets around a place, laid on the smooth skin that tools touch. A coarse
// mesh's facets stand off it by the square of their edges, and a tip's first touch feels the facet
// and not the organ: it leans as the facet does. Called by studies and tests after refine.h; any
// thread, not real time.
// Between the vertices of the skin: the mean of its triangle and of what the tangent planes of its
// corners say, which any surface of second order has exactly (after Boubekeur & Alexa, Phong
// tessellation, 2008, with the weight 1/2).
#pragma once

#include "tissue/mesh/contact_surface.h"
#include "tissue/response/boundary_tree.h"

namespace tissue {

/// The skin at rest as a smooth surface.
struct SmoothSkin {
    BoundaryTree tree;
    std::vector<glm::dvec3> normal; // unit, per vertex
};
/// Throws std::invalid_argument if the surface has no triangle.
SmoothSkin make_smooth_skin(const ContactSurface& surface);

/// Of the smooth surface, over the point of the skin's triangles that is nearest to `from_m`.
glm::dvec3 on_smooth_skin(const SmoothSkin& skin, const glm::dvec3& from_m);

/// Moves the nodes of `mesh` around `place_m`: those of the boundary onto the skin, all the way
/// within `whole_m`, less and less beyond it; those inside by the mean of their neighbours' moves
/// (a discrete harmonic map), so tets keep their shapes where they can. The farther facets are
/// from the skin, the farther out it reaches. No tet keeps less than a fifth of its volume: where
/// one would, facets stay between. Returns how far off the skin a node within `whole_m` still is:
/// next to nothing if facets are moved by little of their edges, so lay, refine and lay again; some
/// hundredths of an edge of the skin at a crease, where the smooth surface is not its own image.
/// Throws as check_mesh().
double lay_onto_skin(const SmoothSkin& skin, const glm::dvec3& place_m, double whole_m,
                     TetMesh& mesh);

} // namespace tissue
