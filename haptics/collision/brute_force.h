// haptics/collision/brute_force.h
// Looks at every triangle: what the other methods are tested against.
#pragma once

#include "haptics/collision/mesh_view.h"
#include "haptics/collision/reach.h"

namespace haptics {

struct BruteForce {
    std::uint32_t triangles = 0;
};

inline BruteForce make_brute_force(const MeshView& mesh) noexcept {
    return {static_cast<std::uint32_t>(mesh.triangle.size())};
}

inline void refit(BruteForce&, const MeshView&) noexcept {}

template <class Look> void visit(const BruteForce& all, Reach&, Look&& look) {
    for (std::uint32_t t = 0; t < all.triangles; ++t)
        look(t);
}

} // namespace haptics
