// haptics/collision/wide_tree.h
// Our own collision method: a tree of axis-aligned boxes with eight children to a node and eight
// triangles to a leaf, all eight looked at by one SIMD instruction, and a ring of leaves around
// the last place asked about, so that the 1 kHz loop does not start at the root again.
//
// Boxes and triangles are kept in float, relative to the mesh, only to rule triangles out: a float
// distance is believed to within `slack`, and what could be nearest is measured in double on the
// mesh itself. So the answer is that of brute force in double, to the bit, on every CPU, in every
// unit and anywhere in the world; SIMD width only changes the time.
//
// The ring: when it is made at place p0, it holds every leaf whose box comes within R of p0. At
// another place p, what is not in the ring is farther than R - |p - p0|; a nearest point closer
// than that (or nothing in a radius smaller than that) is certainly the global answer, and nothing
// but the ring has been looked at. Else the ring is made anew, about as wide as it has room for.
//
// One thread refits, others ask: the owner has two trees and hands over the one at rest (refit
// needs no more than the mesh). Asking writes only the ring, which is the asker's own.
#pragma once

#include "haptics/collision/mesh_view.h"
#include "haptics/collision/queries.h"
#include "haptics/collision/reach.h"

#include <bit>
#include <span>
#include <vector>

namespace haptics {

struct WideTree {
    static constexpr int kWidth = 8;
    static constexpr std::uint32_t kNothing = 0xffffffffu;
    static constexpr std::uint32_t kLeafBit = 0x80000000u; // child: a leaf's number, not a node's

    struct alignas(64) Node {
        float low[3][kWidth], high[3][kWidth]; // lane without a child: never met
        std::uint32_t child[kWidth];
        std::uint32_t parent_lane; // parent * kWidth + lane; kNothing: root
    };
    struct alignas(32) Leaf {
        float corner[3][3][kWidth]; // [corner][axis][lane]; lane without a triangle: not a number
        // beside them, because what is fetched together should lie together: what the last word in
        // double needs
        std::array<std::uint32_t, kWidth> triangle; // kNothing: lane without one
        std::array<Corners, kWidth> vertex;
    };
    /// Skin is flat: of each leaf, a slab that holds it, across the mean normal. Boxes of skin that
    /// lies askew are thick; with the slab, a leaf beside the foot is known to be far. In the order
    /// of the node's children; those that are nodes have no normal.
    struct alignas(64) Slabs {
        float normal[3][kWidth];
        float low[kWidth], high[kWidth]; // along the normal
    };
    std::vector<Node> node; // the root first, parents before children
    std::vector<Leaf> leaf;
    std::vector<Slabs> slabs; // of each node
    // for refit: vertices in the tree's frame, each where the first leaf that has it needs it
    std::vector<std::array<float, 4>> place;
    std::vector<std::uint32_t> vertex_of_place;
    std::vector<std::array<std::array<std::uint32_t, kWidth>, 3>> place_of; // leaf, corner, lane
    std::vector<std::uint32_t> parent_lane;                                 // of a leaf

    // tree frame: (metres - origin) * scale, a power of two; the mesh is about -1..1 there
    glm::dvec3 origin_m{0.0};
    double scale_pm = 1.0;
    std::uint64_t version = 0; // of the last refit; unlike that of any other tree
    bool moving = false;       // boxes cover where the mesh was as well

    glm::dvec3 to_tree(const glm::dvec3& place_m) const noexcept {
        return (place_m - origin_m) * scale_pm;
    }
};

/// Of one asker near one tree. 4 kB.
struct WideRing {
    static constexpr int kRoom = 64; // leaves

    std::uint64_t version = 0; // of the tree it is of; 0: none
    int leaves = 0;
    float reach = 0.0f;  // R, tree frame; 0: no ring
    float disc2 = 1e-3f; // square of the radius of the disc of skin that the next ring holds
    std::array<float, 3> centre{};                  // p0, tree frame
    std::array<float, 3> last_place{}, last_foot{}; // asked about, and answered; tree frame
    std::uint32_t last_leaf = 0;                    // where the nearest was
    std::uint32_t made = 0, asked = 0;              // counters, for the bench
    /// Boxes around each eight leaves, low x y z and high x y z: the first eight boxes to ask.
    static constexpr int kEights = kRoom / WideTree::kWidth;
    static_assert(kEights == WideTree::kWidth);
    alignas(64) std::array<std::array<float, kEights>, 6> around{};
    /// Side by side in memory: where caches were driven out, each line fetched is felt. Rows: box
    /// low x y z, high x y z, slab normal x y z, low, high.
    static constexpr int kRows = 11;
    struct alignas(64) Eight {
        std::array<std::array<float, WideTree::kWidth>, kRows> row{};
        std::array<std::uint32_t, WideTree::kWidth> leaf{};
    };
    std::array<Eight, kEights> eight{};
};

/// Setup. Indices and vertices must be good (make_index checks). The same mesh gives the same tree.
WideTree make_wide_tree(const MeshView& mesh);

/// Boxes for the vertices now, and of those before if the mesh has moved. Linear. A vertex that
/// is not finite takes its triangles out of the world until the next refit.
void refit(WideTree& tree, const MeshView& mesh) noexcept;

/// The nearest point of the mesh as it is now, if one is within `radius_m`, and nothing else.
SurfaceHit closest_within(const WideTree& tree, const MeshView& mesh, WideRing& ring,
                          const glm::dvec3& place_m, double radius_m) noexcept;
SurfaceHit closest_within(const WideTree& tree, const MeshView& mesh, const glm::dvec3& place_m,
                          double radius_m) noexcept;

/// Which instruction set the questions are answered with, e.g. "AVX2".
const char* wide_tree_instructions() noexcept;

namespace wide_detail {
/// Float distances are right to this share of 1 (the mesh's size) and of the place asked about:
/// each corner, the place and each of some twenty operations are rounded by 2^-24, and weights of
/// triangles with angles above 6 degrees amplify that by ten; below, see the kernel.
inline constexpr double kSlack = 64.0 * 0x1p-24;
double slack(const glm::dvec3& place) noexcept; // tree frame

/// Leaves, slabs and boxes from `place`; then, wider, boxes and slabs for where the places were.
void fill_boxes(WideTree& tree) noexcept;
void widen_boxes(WideTree& tree) noexcept;

/// Lanes whose box meets the reach, given in the tree's frame, widened by its slack.
struct TreeReach {
    std::array<float, 3> from{}, inverse{}; // of the segment's direction
    float radius = 0.0f;
    bool point = true;
};
TreeReach make_reach(const WideTree& tree, const Reach& reach) noexcept;
/// `order`: how early each is met.
std::uint32_t children_met(const WideTree::Node& node, const TreeReach& reach,
                           std::array<float, WideTree::kWidth>& order) noexcept;
/// Of a leaf's triangles as they are now, by their boxes.
std::uint32_t triangles_met(const WideTree::Leaf& leaf, const TreeReach& reach) noexcept;
inline constexpr int kMostDepth = 24; // 8^11 triangles and more
} // namespace wide_detail

/// See reach.h.
template <class Look> void visit(const WideTree& tree, Reach& reach, Look&& look) {
    if (tree.node.empty())
        return;
    std::array<std::uint32_t, wide_detail::kMostDepth * WideTree::kWidth> stack;
    int top = 0;
    stack[top++] = 0;
    wide_detail::TreeReach now = wide_detail::make_reach(tree, reach);
    while (top > 0) {
        const std::uint32_t at = stack[--top];
        if ((at & WideTree::kLeafBit) != 0) {
            const std::uint32_t leaf = at & ~WideTree::kLeafBit;
            // boxes of leaves cover both ends of a motion, triangles know one
            std::uint32_t met = tree.moving ? (1u << WideTree::kWidth) - 1u
                                            : wide_detail::triangles_met(tree.leaf[leaf], now);
            for (; met != 0; met &= met - 1) {
                const std::uint32_t t = tree.leaf[leaf].triangle[std::countr_zero(met)];
                if (t != WideTree::kNothing)
                    look(t);
            }
            now = wide_detail::make_reach(tree, reach);
            continue;
        }
        const WideTree::Node& node = tree.node[at];
        std::array<float, WideTree::kWidth> order;
        std::array<float, WideTree::kWidth>
            pushed; // the latest first, so that the earliest is next
        const int first = top;
        for (std::uint32_t met = wide_detail::children_met(node, now, order); met != 0;
             met &= met - 1) {
            const int lane = std::countr_zero(met);
            int to = top++;
            for (; to > first && pushed[to - first - 1] < order[lane]; --to) {
                stack[to] = stack[to - 1];
                pushed[to - first] = pushed[to - first - 1];
            }
            stack[to] = node.child[lane];
            pushed[to - first] = order[lane];
        }
    }
}

} // namespace haptics
