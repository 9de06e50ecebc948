// haptics/collision/box_tree.h
// Does a segment meet a triangle mesh whose vertices move and whose topology stays? A tree of
// axis-aligned boxes. sim/ asks it on the tissue thread, once per FEM step.
//
// It never lets a segment through between two triangles: in the plane across the segment an edge
// is the same two points for both its triangles, and on which side of it the segment passes is
// known by the exact sign (Woop, Benthin, Wald 2013, Watertight Ray/Triangle Intersection). What
// only touches an edge, a rim or a vertex is a hit too, within the rounding of the coordinates
// themselves: some 1e-14 of the largest one, whatever the unit.
//
// A wider tree, boxes in float or several rays at once would be faster; they may replace what is
// in BoxTree as long as these three functions and their answers stay.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace haptics {

struct BoxTree {
    /// Depth first: the left child of a box is the next one, `after` is the first box that is not
    /// part of it (of an inner box's left child: the right child).
    struct Box {
        glm::dvec3 low_m{0.0}, high_m{0.0};
        std::uint32_t after = 0;
        std::uint32_t first = 0, first_corner = 0; // leaf: ranges of `triangle` and `corner`
        std::uint16_t count = 0, corners = 0;      // inner: 0
    };
    std::vector<Box> box;
    std::vector<std::array<std::uint32_t, 3>> triangle; // in the order of the leaves
    std::vector<std::uint32_t> corner;                  // vertices of each leaf, each once
    double largest_m = 0.0;                             // largest finite coordinate of the mesh
};

/// Setup. Throws std::invalid_argument naming a triangle with an index that is not a vertex, or a
/// vertex that is not finite. A mesh without triangles meets nothing. The same mesh gives the same
/// tree.
BoxTree make_box_tree(std::span<const glm::dvec3> vertex_m,
                      std::span<const std::array<std::uint32_t, 3>> triangle);

/// The boxes for the places where the vertices, as many as at setup, are now. Linear in the
/// triangles. Real-time safe.
void refit(BoxTree& tree, std::span<const glm::dvec3> vertex_m) noexcept;

/// Whether the segment, its ends included, meets any triangle from either side. `vertex_m`: those
/// of the last refit. Coordinates below 1e150; a segment or triangle that is not finite meets
/// nothing. Real-time safe, deterministic to the bit.
bool segment_hits(const BoxTree& tree, std::span<const glm::dvec3> vertex_m,
                  const glm::dvec3& from_m, const glm::dvec3& to_m) noexcept;

} // namespace haptics
