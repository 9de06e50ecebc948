// haptics/collision/neighbours.h
// Which triangles lie around each one: those that share a vertex with it. Constant, made once.
#pragma once

#include "haptics/collision/mesh_view.h"

#include <vector>

namespace haptics {

struct Neighbours {
    std::vector<std::uint32_t> first;    // of `triangle`, and one beyond the last
    std::vector<std::uint32_t> triangle; // by number; without itself
    std::span<const std::uint32_t> of(std::uint32_t t) const noexcept {
        return {triangle.data() + first[t], first[t + 1] - first[t]};
    }
};

Neighbours make_neighbours(const MeshView& mesh);

} // namespace haptics
