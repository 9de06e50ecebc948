// sim/bridge/faced_skin.h
// What a place on one organ's skin meets of another's: the nearest skin that faces it. Because it
// has to face it, the far side of something thin is never met, however deep a place is. Made at
// setup, asked by organ_rows.cpp in the tissue loop.
#pragma once

#include "haptics/collision/wide_tree.h"
#include "sim/bridge/body.h"

namespace sim {

/// One body's skin for such questions, where it is now.
struct SkinTree {
    haptics::WideTree tree;
    std::vector<std::uint32_t> start, around; // triangles around each vertex
    std::vector<glm::dvec3> was_m;            // skin at the last refit
    glm::dvec3 low_m{0.0}, high_m{0.0};
};
SkinTree make_skin_tree(const Body& body);

/// To where the skin is now. Returns how far any vertex moved. Real-time safe, as all below.
double refit(SkinTree& skin, const Body& body) noexcept;

haptics::MeshView view_of(const Body& body) noexcept;

struct FacedSkin {
    bool found = false;
    haptics::SurfacePoint at;
    glm::dvec3 normal{0.0}; // unit, out of the skin, smooth but for creases
    double gap_m = 0.0;     // along it, below 0 inside
    double beside_m = 0.0;  // how far the place is from being above `at`
    double facing = 0.0;    // 1: straight, 0: across
};
/// `outward`: the unit normal of the skin that the place is on.
FacedSkin skin_facing(const Body& body, const SkinTree& skin, const glm::dvec3& place_m,
                      const glm::dvec3& outward, double within_m) noexcept;

} // namespace sim
