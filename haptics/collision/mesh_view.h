// haptics/collision/mesh_view.h
// A triangle mesh as collision sees it: owned by somebody else, its vertices may move, its
// triangles stay. Metres, world frame; any other unit and any origin give the same answers.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace haptics {

using Corners = std::array<std::uint32_t, 3>;
inline constexpr std::uint32_t kNoSurface = 0xffffffffu; // instead of a triangle's number

struct MeshView {
    std::span<const glm::dvec3> vertex_m; // now
    std::span<const Corners> triangle;    // both sides are skin; winding means nothing here
    /// Where the vertices were when the interval began, for queries in which the mesh moves on
    /// straight lines from there to `vertex_m`. Empty: it rests.
    std::span<const glm::dvec3> before_m;

    std::array<glm::dvec3, 3> corners(std::uint32_t t) const noexcept {
        const auto [a, b, c] = triangle[t];
        return {vertex_m[a], vertex_m[b], vertex_m[c]};
    }
    std::array<glm::dvec3, 3> corners_before(std::uint32_t t) const noexcept {
        if (before_m.empty())
            return corners(t);
        const auto [a, b, c] = triangle[t];
        return {before_m[a], before_m[b], before_m[c]};
    }
};

} // namespace haptics
