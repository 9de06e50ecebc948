// haptics/collision/item_box.h
// Boxes of triangles, over both ends of the interval, and the length of edges: what methods
// gather from a mesh.
#pragma once

#include "haptics/collision/cell_table.h"
#include "haptics/collision/mesh_view.h"

namespace haptics {

/// Empty (low > high) if a corner is not finite: such a triangle meets nothing.
ItemBox box_of(const MeshView& mesh, std::uint32_t triangle) noexcept;

/// Over all edges of all triangles; 0 without any.
double average_edge_m(const MeshView& mesh) noexcept;

} // namespace haptics
