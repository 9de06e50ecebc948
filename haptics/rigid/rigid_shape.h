// haptics/rigid/rigid_shape.h
// A rigid body as convex pieces under a tree of hulls, and which pieces of two bodies are near.
// Built at load, asked at 1 kHz.
#pragma once

#include "haptics/rigid/contact_patch.h"
#include "haptics/rigid/convex_hull.h"
#include "haptics/rigid/rigid_pose.h"

#include <string>

namespace haptics {

struct RigidShape {
    /// Hull and sphere of all pieces below. A leaf is its piece.
    struct Node {
        ConvexHull hull;
        std::uint32_t left = 0, right = 0; // 0: leaf
        std::uint32_t piece = 0;           // of a leaf
    };
    std::string name;
    std::vector<ConvexHull> piece; // in the frame of the body
    std::vector<Node> node;        // the root first; empty: nothing is ever near
};

/// Load time. Halves the pieces along the longest side of their centres. Throws what convex_hull
/// throws, naming the shape.
RigidShape make_shape(std::string_view name, std::vector<ConvexHull> piece);

struct PiecePair {
    std::uint32_t a = 0, b = 0;
};
using PairList = Bounded<PiecePair, 128>;

/// Pairs of pieces closer than `margin_m`, overlapping ones included, always in the same order for
/// the same pairs. What does not fit is counted in `dropped`, and so is a tree too deep to follow
/// (64 levels). Sphere tests first, then the distance of hulls, stopped at the margin (Ehmann, Lin
/// 2001). Real-time safe.
void close_pairs(const RigidShape& a, const RigidShape& b, const RigidPose& b_in_a, double margin_m,
                 PairList& out) noexcept;

} // namespace haptics
