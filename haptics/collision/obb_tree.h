// haptics/collision/obb_tree.h
// A tree of boxes that lie as the surface does (Gottschalk, Lin, Manocha 1996, OBBTree). Good for
// slivers and thin sheets askew; a deformed mesh keeps its axes.
#pragma once

#include "haptics/collision/cell_walk.h"
#include "haptics/collision/counted.h"
#include "haptics/collision/mesh_view.h"

#include <glm/mat3x3.hpp>

namespace haptics {

struct ObbTree {
    /// Depth first: the left child of a box is the next one, the right child is the first box
    /// that is not part of the left one.
    struct Box {
        glm::dmat3 axes{1.0}; // columns
        glm::dvec3 centre_m{0.0}, half_m{0.0};
        std::uint32_t after = 0;        // first box that is not part of this one
        std::uint32_t first = 0;        // leaf: of `triangle`
        std::uint32_t first_corner = 0; // of `corner`, up to the next box's
        std::uint32_t count = 0;        // inner: 0
    };
    std::vector<Box> box; // and one beyond the last
    std::vector<std::uint32_t> triangle;
    std::vector<std::uint32_t> corner; // the vertices in each box, each once
    double largest_m = 0.0;
    std::uint32_t boxes() const noexcept {
        return box.empty() ? 0 : static_cast<std::uint32_t>(box.size() - 1);
    }
};

ObbTree make_obb_tree(const MeshView& mesh);
/// The same, of some of the triangles.
ObbTree make_obb_tree(const MeshView& mesh, std::span<const std::uint32_t> triangle);

/// Keeps axes and topology, measures the boxes anew, from all the vertices in each: boxes of boxes
/// would grow from level to level. n log n, no allocation. What is not finite is left out.
void refit(ObbTree& tree, const MeshView& mesh) noexcept;

namespace obb {

/// Square of the distance of a point from a box.
inline double distance2_m2(const ObbTree::Box& box, const glm::dvec3& place_m) noexcept {
    const glm::dvec3 p = (place_m - box.centre_m) * box.axes; // the transposed, times the vector
    const glm::dvec3 out = glm::max(glm::abs(p) - box.half_m, 0.0);
    return glm::dot(out, out);
}

/// Whether a segment may come as near to a box as `thick_m`: the separating axes of Gregory et al.
/// 1999, a box thicker by that. Exact for 0.
inline bool meets(const ObbTree::Box& box, const glm::dvec3& from_m, const glm::dvec3& to_m,
                  double thick_m) noexcept {
    const glm::dvec3 m = (0.5 * (from_m + to_m) - box.centre_m) * box.axes; // middle
    const glm::dvec3 h = 0.5 * (to_m - from_m) * box.axes;                  // half the segment
    const glm::dvec3 a = glm::abs(h), b = box.half_m + thick_m;
    return std::abs(m.x) <= b.x + a.x && std::abs(m.y) <= b.y + a.y && std::abs(m.z) <= b.z + a.z &&
           std::abs(m.y * h.z - m.z * h.y) <= b.y * a.z + b.z * a.y &&
           std::abs(m.z * h.x - m.x * h.z) <= b.x * a.z + b.z * a.x &&
           std::abs(m.x * h.y - m.y * h.x) <= b.x * a.y + b.y * a.x;
}

inline constexpr int kDeepest = 256; // setup splits one to seven at worst: 103 for 10^6 triangles

template <class Look> void visit_leaf(const ObbTree& tree, const ObbTree::Box& leaf, Look& look) {
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
        look(tree.triangle[i]);
}

/// Around a point: the nearer child first.
template <class Look>
void visit_ball(const ObbTree& tree, const Reach& reach, double slack_m, Look& look) {
    struct Later {
        std::uint32_t at;
        double distance2_m2;
    };
    std::array<Later, kDeepest> later;
    int laters = 0;
    const auto within = [&](double distance2) {
        const double far_m = reach.radius_m + slack_m;
        return distance2 <= far_m * far_m;
    };
    count_box(look);
    later[laters++] = {0, distance2_m2(tree.box[0], reach.from_m)};
    while (laters > 0) {
        const Later next = later[--laters];
        if (!within(next.distance2_m2))
            continue;
        const ObbTree::Box& box = tree.box[next.at];
        if (box.count > 0) {
            visit_leaf(tree, box, look);
            continue;
        }
        const std::uint32_t left = next.at + 1, right = tree.box[left].after;
        const Later a{left, distance2_m2(tree.box[left], reach.from_m)};
        const Later b{right, distance2_m2(tree.box[right], reach.from_m)};
        count_box(look);
        count_box(look);
        const bool swap = b.distance2_m2 < a.distance2_m2;
        later[laters++] = swap ? a : b;
        later[laters++] = swap ? b : a;
    }
}

/// Along a segment: the child whose middle comes first, first.
template <class Look>
void visit_segment(const ObbTree& tree, const Reach& reach, double slack_m, Look& look) {
    std::array<std::uint32_t, kDeepest> later;
    int laters = 0;
    later[laters++] = 0;
    const glm::dvec3 d = reach.to_m - reach.from_m;
    while (laters > 0) {
        const std::uint32_t at = later[--laters];
        const ObbTree::Box& box = tree.box[at];
        count_box(look);
        if (!meets(box, reach.from_m, reach.to_m, reach.radius_m + slack_m))
            continue;
        if (box.count > 0) {
            visit_leaf(tree, box, look);
            continue;
        }
        const std::uint32_t left = at + 1, right = tree.box[left].after;
        const bool swap = glm::dot(tree.box[right].centre_m - tree.box[left].centre_m, d) < 0.0;
        later[laters++] = swap ? left : right;
        later[laters++] = swap ? right : left;
    }
}

} // namespace obb

template <class Look> void visit(const ObbTree& tree, Reach& reach, Look&& look) {
    if (tree.boxes() == 0 || !cell_walk::finite(reach))
        return;
    // setup's axes are square to each other to a rounding
    const double slack_m = cell_walk::slack_m(tree.largest_m, reach);
    if (reach.from_m == reach.to_m)
        obb::visit_ball(tree, reach, slack_m, look);
    else
        obb::visit_segment(tree, reach, slack_m, look);
}

} // namespace haptics
