// haptics/collision/neighbours.h
// Which triangle lies across each edge of each one. Constant, made once.
#pragma once

#include "haptics/collision/mesh_view.h"

#include <vector>

namespace haptics {

struct Neighbours {
    /// By the corner opposite the edge; kNoSurface at a rim. Where more than two triangles share
    /// an edge, the next of them by number, in a ring.
    std::vector<std::array<std::uint32_t, 3>> across;
};

Neighbours make_neighbours(const MeshView& mesh);

} // namespace haptics
