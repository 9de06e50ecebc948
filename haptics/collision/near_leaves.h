// haptics/collision/near_leaves.h
// What is around a ball that moves a little: the leaves of a wide tree that come within some way of
// it, and which of their triangles a straight path of the ball may meet. Eight triangles at a time
// and in float, so it only ever rules out: what is left has to be looked at in double. For contact
// methods at 1 kHz; nothing is allocated or thrown.
//
// A triangle is ruled out if a plane can be seen between: all three corners behind it, both ends of
// the path in front of it by the ball's radius. Any direction will do for the plane's normal; tried
// are those from the triangle's nearest points to the two ends. What float makes of a corner is
// off by half an ulp of the tree's frame, everything after that is done as seen from the centre,
// where numbers are small: a plane is trusted to far less than what a distance is (wide_tree.h).
#pragma once

#include "haptics/collision/index.h"

#include <array>
#include <span>

namespace haptics {

/// Not initialised: there is room for many. Not to be copied: it may point into itself.
struct NearLeaves {
    static constexpr int kRoom = 96;
    static constexpr int kWidth = WideTree::kWidth;
    static constexpr int kPlaces = kRoom * kWidth;

    int count = 0;
    glm::dvec3 centre_m{0.0};
    double reach_m = 0.0; // of the centre: all triangles within it are here; beyond it who knows
    glm::dvec3 origin_m{0.0};
    double scale_pm = 1.0; // the leaves' frame: (metres - origin) * scale
    MeshView mesh{};
    std::array<const WideTree::Leaf*, kRoom> leaf;
    /// Of each triangle a plane that it is behind, across the direction from its nearest point to
    /// the centre; as seen from the centre, in that scale, for eight: normal x y z, offset. A lane
    /// without a triangle: minus infinity.
    alignas(32) std::array<std::array<std::array<float, kWidth>, 4>, kRoom> plane;
    std::array<float, kRoom> least_of_leaf; // they may be as near to the centre as this, not nearer

    // leaves of a method that has none: made as they are found
    static constexpr int kMade = 32;
    std::array<WideTree::Leaf, kMade> made;

    // A place is leaf * kWidth + lane.
    std::uint32_t triangle(std::uint32_t place) const noexcept {
        return leaf[place / kWidth]->triangle[place % kWidth];
    }
    TriangleCorners corner(std::uint32_t place) const noexcept {
        const auto [a, b, c] = leaf[place / kWidth]->vertex[place % kWidth];
        return {mesh.vertex_m[a], mesh.vertex_m[b], mesh.vertex_m[c]};
    }
    float least(std::uint32_t place) const noexcept {
        return std::max(0.0f, -plane[place / kWidth][3][place % kWidth]);
    }
    /// What is no farther from the centre than this has a `least` no larger than the answer.
    float bound(double distance_m) const noexcept {
        return static_cast<float>(distance_m * scale_pm * (1.0 + 0x1p-23));
    }
};

/// Those that come within `reach_m` of `centre_m`. Returns false if there are more than there is
/// room for; then some are left out, any of them. With a WideTree as index, its ring is used, which
/// should not be one that closest_within uses.
bool find_near(const CollisionIndex& index, const MeshView& mesh, const glm::dvec3& centre_m,
               double reach_m, WideRing& ring, NearLeaves& out) noexcept;

/// What the questions answer with: as many as returned.
using Places = std::array<std::uint32_t, NearLeaves::kPlaces + NearLeaves::kWidth>;

/// The triangles that a ball may meet on its straight way, among those near. Only within the reach
/// that these were found for: both ends must be closer to the centre than that, less the radius.
int may_meet(const NearLeaves& near, const glm::dvec3& from_m, const glm::dvec3& to_m,
             double radius_m, Places& out) noexcept;

/// The triangles that may come within a radius of the centre.
int may_touch(const NearLeaves& near, double radius_m, Places& out) noexcept;

/// The place of the triangle with the least `least`; -1: there are none.
int nearest_place(const NearLeaves& near) noexcept;

} // namespace haptics
