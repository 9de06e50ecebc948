// assets/bake/import/box_tree.h
// A tree of boxes: which of many small things may touch a box. Called by the search for
// intersections, by stitching and by the winding numbers. Built once, in a fixed order.
#pragma once

#include "assets/bake/surface.h"

#include <limits>

namespace bake {

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::max()};
    glm::dvec3 high{std::numeric_limits<double>::lowest()};

    void add(const glm::dvec3& p) {
        for (int d = 0; d < 3; ++d) {
            low[d] = std::min(low[d], p[d]);
            high[d] = std::max(high[d], p[d]);
        }
    }
    void add(const Box& b) {
        add(b.low);
        add(b.high);
    }
    [[nodiscard]] bool meets(const Box& b) const {
        bool apart = false;
        for (int d = 0; d < 3; ++d) {
            apart = apart || low[d] > b.high[d] || b.low[d] > high[d];
        }
        return !apart;
    }
};

Box box_of(const Surface& surface);
std::vector<Box> triangle_boxes(const Surface& surface);

class BoxTree {
  public:
    /// A leaf has one item, an inner node two children; `first` and `count` are the node's items in
    /// `items`.
    struct Node {
        Box box;
        std::uint32_t first = 0, count = 0;
        std::int32_t left = -1, right = -1; // -1: a leaf
    };

    explicit BoxTree(const std::vector<Box>& boxes, std::uint32_t leaf_items = 4);

    /// Calls f(item) for every item whose box meets `box`.
    template <class F> void visit(const Box& box, F&& f) const {
        if (nodes_.empty()) {
            return;
        }
        std::int32_t stack[64];
        int depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const Node& node = nodes_[static_cast<std::size_t>(stack[--depth])];
            if (!node.box.meets(box)) {
                continue;
            }
            if (node.left < 0) {
                for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                    if (boxes_[items_[i]].meets(box)) {
                        f(items_[i]);
                    }
                }
            } else {
                stack[depth++] = node.right;
                stack[depth++] = node.left;
            }
        }
    }

    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
    [[nodiscard]] const std::vector<std::uint32_t>& items() const { return items_; }

  private:
    std::vector<Box> boxes_;
    std::vector<Node> nodes_; // children after their parent; halves, so 64 levels are plenty
    std::vector<std::uint32_t> items_;
};

} // namespace bake
