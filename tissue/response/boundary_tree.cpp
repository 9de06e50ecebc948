// tissue/response/boundary_tree.cpp
// Median-split box tree. Bake time, any thread.
#include "tissue/response/boundary_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace tissue {
namespace {

using glm::dvec3;

constexpr std::uint32_t kLeafSize = 4;
constexpr double kEdgeSlack = 1e-9; // of barycentric weights, so that no line slips between two

// Fills the box of order[first, first + count) and its children, depth first.
void split(BoundaryTree& tree, std::span<const dvec3> centre, std::uint32_t first,
           std::uint32_t count) {
    const std::size_t at = tree.box.size();
    BoundaryTree::Box box{dvec3{std::numeric_limits<double>::infinity()},
                          dvec3{-std::numeric_limits<double>::infinity()}, first, count, 0};
    for (std::uint32_t i = first; i < first + count; ++i) {
        for (const std::uint32_t node : tree.triangle[tree.order[i]]) {
            box.low = glm::min(box.low, tree.node_m[node]);
            box.high = glm::max(box.high, tree.node_m[node]);
        }
    }
    tree.box.push_back(box);
    if (count <= kLeafSize)
        return;

    const dvec3 size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t left = count / 2;
    const auto begin = tree.order.begin() + first;
    std::nth_element(begin, begin + left, begin + count, [&](std::uint32_t a, std::uint32_t b) {
        return centre[a][axis] != centre[b][axis] ? centre[a][axis] < centre[b][axis] : a < b;
    });
    tree.box[at].count = 0;
    split(tree, centre, first, left);
    tree.box[at].right = static_cast<std::uint32_t>(tree.box.size());
    split(tree, centre, first + left, count - left);
}

double distance2(const BoundaryTree::Box& box, const dvec3& p) {
    const dvec3 outside = glm::max(glm::max(box.low - p, p - box.high), dvec3{0.0});
    return glm::dot(outside, outside);
}

// Line against triangle (Moeller & Trumbore 1997), t and weights.
std::optional<BoundaryPoint> hit(const BoundaryTree& tree, std::uint32_t t, const dvec3& from,
                                 const dvec3& direction) {
    const auto [i, j, k] = tree.triangle[t];
    const dvec3 ab = tree.node_m[j] - tree.node_m[i], ac = tree.node_m[k] - tree.node_m[i];
    const dvec3 h = glm::cross(direction, ac);
    const double det = glm::dot(ab, h);
    if (std::abs(det) <= 1e-12 * glm::length(ab) * glm::length(ac))
        return std::nullopt;
    const dvec3 s = from - tree.node_m[i];
    const dvec3 q = glm::cross(s, ab);
    const double v = glm::dot(s, h) / det, w = glm::dot(direction, q) / det;
    if (v < -kEdgeSlack || w < -kEdgeSlack || v + w > 1.0 + kEdgeSlack)
        return std::nullopt;
    const dvec3 weight = glm::clamp(dvec3{1.0 - v - w, v, w}, 0.0, 1.0);
    return BoundaryPoint{t, weight / (weight.x + weight.y + weight.z), glm::dot(ac, q) / det};
}

bool crosses(const BoundaryTree::Box& box, const dvec3& from, const dvec3& direction, double low,
             double high) {
    const dvec3 slack{1e-9 * (glm::length(box.high - box.low) + high - low)};
    for (int axis = 0; axis < 3; ++axis) {
        const double a = box.low[axis] - slack[axis] - from[axis];
        const double b = box.high[axis] + slack[axis] - from[axis];
        if (std::abs(direction[axis]) < 1e-14) {
            if (a > 0.0 || b < 0.0)
                return false;
            continue;
        }
        const double t0 = a / direction[axis], t1 = b / direction[axis];
        low = std::max(low, std::min(t0, t1));
        high = std::min(high, std::max(t0, t1));
    }
    return low <= high;
}

} // namespace

dvec3 closest_weight(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& p) noexcept {
    const dvec3 ab = b - a, ac = c - a;
    const double d1 = glm::dot(ab, p - a), d2 = glm::dot(ac, p - a);
    if (d1 <= 0.0 && d2 <= 0.0)
        return {1, 0, 0};
    const double d3 = glm::dot(ab, p - b), d4 = glm::dot(ac, p - b);
    if (d3 >= 0.0 && d4 <= d3)
        return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        const double v = d1 / (d1 - d3);
        return {1.0 - v, v, 0};
    }
    const double d5 = glm::dot(ab, p - c), d6 = glm::dot(ac, p - c);
    if (d6 >= 0.0 && d5 <= d6)
        return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        const double w = d2 / (d2 - d6);
        return {1.0 - w, 0, w};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1.0 - w, w};
    }
    const double sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

BoundaryTree make_boundary_tree(const TetMesh& mesh) {
    return make_surface_tree(mesh.rest_m, boundary_triangles(mesh));
}

BoundaryTree make_surface_tree(std::span<const dvec3> node_m, std::span<const Triangle> triangles) {
    BoundaryTree tree;
    tree.node_m.assign(node_m.begin(), node_m.end());
    tree.triangle.assign(triangles.begin(), triangles.end());
    if (tree.triangle.empty())
        throw std::invalid_argument("the body has no boundary triangles");
    std::vector<dvec3> centre;
    for (const auto& [i, j, k] : tree.triangle) {
        const dvec3 &a = node_m[i], &b = node_m[j], &c = node_m[k];
        centre.push_back((a + b + c) / 3.0);
        tree.normal.push_back(glm::normalize(glm::cross(b - a, c - a)));
    }
    tree.order.resize(tree.triangle.size());
    std::iota(tree.order.begin(), tree.order.end(), 0u);
    split(tree, centre, 0, static_cast<std::uint32_t>(tree.order.size()));
    return tree;
}

BoundaryPoint nearest_point(const BoundaryTree& tree, const dvec3& point_m) {
    BoundaryPoint best;
    double best2 = std::numeric_limits<double>::infinity();
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
        const std::uint32_t at = open.back();
        open.pop_back();
        const BoundaryTree::Box& box = tree.box[at];
        if (distance2(box, point_m) >= best2)
            continue;
        for (std::uint32_t i = box.first; i < box.first + box.count; ++i) {
            const std::uint32_t t = tree.order[i];
            const auto [a, b, c] = tree.triangle[t];
            const dvec3 weight =
                closest_weight(tree.node_m[a], tree.node_m[b], tree.node_m[c], point_m);
            const dvec3 gap = position_m(tree, {t, weight, 0.0}) - point_m;
            if (glm::dot(gap, gap) < best2) {
                best2 = glm::dot(gap, gap);
                best = {t, weight, std::sqrt(best2)};
            }
        }
        if (box.count == 0) {
            const bool left_first =
                distance2(tree.box[at + 1], point_m) <= distance2(tree.box[box.right], point_m);
            open.push_back(left_first ? box.right : at + 1);
            open.push_back(left_first ? at + 1 : box.right);
        }
    }
    return best;
}

std::vector<BoundaryPoint> line_hits(const BoundaryTree& tree, const dvec3& from_m,
                                     const dvec3& direction, double low_m, double high_m) {
    std::vector<BoundaryPoint> hits;
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
        const std::uint32_t at = open.back();
        open.pop_back();
        const BoundaryTree::Box& box = tree.box[at];
        if (!crosses(box, from_m, direction, low_m, high_m))
            continue;
        for (std::uint32_t i = box.first; i < box.first + box.count; ++i) {
            const auto found = hit(tree, tree.order[i], from_m, direction);
            if (found && found->distance_m >= low_m && found->distance_m <= high_m)
                hits.push_back(*found);
        }
        if (box.count == 0) {
            open.push_back(box.right);
            open.push_back(at + 1);
        }
    }
    std::sort(hits.begin(), hits.end(), [](const BoundaryPoint& a, const BoundaryPoint& b) {
        return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.triangle < b.triangle;
    });
    return hits;
}

dvec3 position_m(const BoundaryTree& tree, const BoundaryPoint& at) {
    const auto [a, b, c] = tree.triangle[at.triangle];
    return at.weight.x * tree.node_m[a] + at.weight.y * tree.node_m[b] +
           at.weight.z * tree.node_m[c];
}

} // namespace tissue
