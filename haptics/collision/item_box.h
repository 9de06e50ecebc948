// haptics/collision/item_box.h
// Boxes of triangles, over both ends of the interval, and the length of edges: what grids gather
// from a mesh.
#pragma once

#include "haptics/collision/cell_table.h"
#include "haptics/collision/mesh_view.h"
#include "haptics/collision/reach.h"

#include <glm/common.hpp>

namespace haptics {

/// Empty (low > high) if a corner is not finite: such a triangle meets nothing.
ItemBox box_of(const MeshView& mesh, std::uint32_t triangle) noexcept;

/// Over all edges of all triangles; 0 without any.
double average_edge_m(const MeshView& mesh) noexcept;

/// Whether the box of a reach, `slack_m` thicker, meets a box.
inline bool near(const ItemBox& box, const Reach& reach, double slack_m) noexcept {
    const double far_m = reach.radius_m + slack_m;
    const glm::dvec3 low = glm::min(reach.from_m, reach.to_m) - far_m;
    const glm::dvec3 high = glm::max(reach.from_m, reach.to_m) + far_m;
    return low.x <= box.high_m.x && low.y <= box.high_m.y && low.z <= box.high_m.z &&
           high.x >= box.low_m.x && high.y >= box.low_m.y && high.z >= box.low_m.z;
}

} // namespace haptics
