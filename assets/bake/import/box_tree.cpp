#include "assets/bake/import/box_tree.h"

#include <algorithm>
#include <numeric>

namespace bake {

Box box_of(const Surface& surface) {
    Box box;
    for (const auto& p : surface.point_m) {
        box.add(p);
    }
    return box;
}

std::vector<Box> triangle_boxes(const Surface& surface) {
    std::vector<Box> boxes(surface.triangles.size());
    for (std::size_t t = 0; t < boxes.size(); ++t) {
        for (const auto v : surface.triangles[t]) {
            boxes[t].add(surface.point_m[v]);
        }
    }
    return boxes;
}

BoxTree::BoxTree(const std::vector<Box>& boxes, std::uint32_t leaf_items) : boxes_(boxes) {
    items_.resize(boxes.size());
    std::iota(items_.begin(), items_.end(), 0u);
    if (items_.empty()) {
        return;
    }
    nodes_.push_back({.box = {}, .first = 0, .count = static_cast<std::uint32_t>(items_.size())});
    for (std::size_t at = 0; at < nodes_.size(); ++at) { // grows while it is walked
        const std::uint32_t first = nodes_[at].first, count = nodes_[at].count;
        Box box, middles;
        for (std::uint32_t i = first; i < first + count; ++i) {
            box.add(boxes_[items_[i]]);
            middles.add(0.5 * (boxes_[items_[i]].low + boxes_[items_[i]].high));
        }
        nodes_[at].box = box;
        if (count <= leaf_items) {
            continue;
        }
        // halves along the longest side; equal middles in order of number
        const glm::dvec3 size = middles.high - middles.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto begin = items_.begin() + first, half = begin + count / 2;
        std::nth_element(begin, half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
            const double ma = boxes_[a].low[axis] + boxes_[a].high[axis];
            const double mb = boxes_[b].low[axis] + boxes_[b].high[axis];
            return ma != mb ? ma < mb : a < b;
        });
        nodes_[at].left = static_cast<std::int32_t>(nodes_.size());
        nodes_.push_back({.box = {}, .first = first, .count = count / 2});
        nodes_[at].right = static_cast<std::int32_t>(nodes_.size());
        nodes_.push_back({.box = {}, .first = first + count / 2, .count = count - count / 2});
    }
}

} // namespace bake
