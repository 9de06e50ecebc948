// haptics/contact/vertex_normals.h
// Normals at the vertices of a mesh, for methods that shade forces. Called at setup, and again
// after the vertices have moved; nothing is allocated, so also in a loop.
#pragma once

#include "haptics/collision/mesh_view.h"

namespace haptics {

/// Unit, to the side from which a triangle's corners run counterclockwise (they must be wound
/// alike): the mean of the facets' normals by the angle of each at the vertex (Thuermer and
/// Wuethrich, Computing vertex normals from polygonal facets, J. Graphics Tools 3, 1998), which
/// does not depend on how a flat face is cut. Zero where no facet with an area is, or all cancel.
/// Vertices at the same place that are not the same vertex make a crease. `normal`: one for each
/// vertex.
void angle_weighted_normals(const MeshView& mesh, std::span<glm::dvec3> normal) noexcept;

} // namespace haptics
