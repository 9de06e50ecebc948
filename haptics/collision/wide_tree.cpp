#include "haptics/collision/wide_tree.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace haptics {
namespace {

using glm::dvec3;
using Node = WideTree::Node;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kFarFloat = std::numeric_limits<float>::infinity();
constexpr int kWidth = WideTree::kWidth;

struct Run {
    std::uint32_t first, count; // of the order
};

struct Builder {
    WideTree& tree;
    const MeshView& mesh;
    std::vector<dvec3> centre;
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> place; // of a vertex

    // Halves at a multiple of `grain`, across the longest side of the centres.
    std::pair<Run, Run> halve(const Run& run, std::uint32_t grain) {
        dvec3 low{kInfinity}, high{-kInfinity};
        for (std::uint32_t i = run.first; i < run.first + run.count; ++i) {
            low = glm::min(low, centre[order[i]]);
            high = glm::max(high, centre[order[i]]);
        }
        const dvec3 size = high - low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::uint32_t grains = (run.count + grain - 1) / grain;
        const std::uint32_t left = grains / 2 * grain;
        const auto begin = order.begin() + run.first;
        // ties by number, so that the halves do not depend on the library
        std::nth_element(
            begin, begin + left, begin + run.count, [&](std::uint32_t a, std::uint32_t b) {
                return centre[a][axis] != centre[b][axis] ? centre[a][axis] < centre[b][axis]
                                                          : a < b;
            });
        return {{run.first, left}, {run.first + left, run.count - left}};
    }

    std::uint32_t place_of(std::uint32_t vertex) {
        if (place[vertex] == WideTree::kNothing) {
            place[vertex] = static_cast<std::uint32_t>(tree.vertex_of_place.size());
            tree.vertex_of_place.push_back(vertex);
        }
        return place[vertex];
    }

    std::uint32_t add_leaf(const Run& run, std::uint32_t parent_lane) {
        WideTree::Leaf& leaf = tree.leaf.emplace_back();
        leaf.triangle.fill(WideTree::kNothing);
        leaf.vertex.fill({0, 0, 0});
        auto& places = tree.place_of.emplace_back();
        for (auto& corner : places)
            corner.fill(0);
        for (std::uint32_t i = 0; i < run.count; ++i) {
            leaf.triangle[i] = order[run.first + i];
            leaf.vertex[i] = mesh.triangle[leaf.triangle[i]];
            for (int corner = 0; corner < 3; ++corner)
                places[corner][i] = place_of(leaf.vertex[i][corner]);
        }
        tree.parent_lane.push_back(parent_lane);
        return static_cast<std::uint32_t>(tree.leaf.size() - 1) | WideTree::kLeafBit;
    }

    // Cuts into parts that fill a subtree each, but for one: no node but the last is left half
    // empty.
    std::uint32_t add_node(const Run& run, std::uint32_t parent_lane) {
        const auto at = static_cast<std::uint32_t>(tree.node.size());
        Node& made = tree.node.emplace_back();
        for (int axis = 0; axis < 3; ++axis)
            for (int lane = 0; lane < kWidth; ++lane) {
                made.low[axis][lane] = kFarFloat;
                made.high[axis][lane] = -kFarFloat;
            }
        std::fill(std::begin(made.child), std::end(made.child), WideTree::kNothing);
        made.parent_lane = parent_lane;
        tree.slabs.push_back({}); // nothing: no normal

        std::uint32_t grain = kWidth; // triangles that fill a child
        while (static_cast<std::uint64_t>(grain) * kWidth < run.count)
            grain *= kWidth;
        std::array<Run, kWidth> part;
        int parts = 1;
        part[0] = run;
        for (int i = 0; i < parts;) {
            if (part[i].count <= grain) {
                ++i;
                continue;
            }
            std::tie(part[i], part[parts]) = halve(part[i], grain);
            ++parts;
        }
        for (int lane = 0; lane < parts; ++lane) {
            const std::uint32_t child = part[lane].count <= kWidth
                                            ? add_leaf(part[lane], at * kWidth + lane)
                                            : add_node(part[lane], at * kWidth + lane);
            tree.node[at].child[lane] = child;
        }
        return at;
    }
};

std::uint64_t next_version() noexcept {
    static std::atomic<std::uint64_t> last{0}; // never waits
    return ++last;
}

void choose_frame(WideTree& tree, const MeshView& mesh) noexcept {
    dvec3 low{kInfinity}, high{-kInfinity};
    for (const dvec3& v : mesh.vertex_m) {
        low = glm::min(low, v);
        high = glm::max(high, v);
    }
    const dvec3 half = 0.5 * (high - low);
    const double size = std::max({half.x, half.y, half.z});
    tree.origin_m = low + half;
    tree.scale_pm =
        size > 0.0 && std::isfinite(size) ? std::exp2(-std::ceil(std::log2(size))) : 1.0;
    if (!std::isfinite(tree.origin_m.x + tree.origin_m.y + tree.origin_m.z))
        tree.origin_m = dvec3{0.0};
}

void fill_places(WideTree& tree, std::span<const dvec3> vertex_m) noexcept {
    const dvec3 origin = tree.origin_m;
    const double scale = tree.scale_pm;
    constexpr std::size_t ahead = 24; // vertices, so that memory has time to answer
    for (std::size_t i = 0; i < tree.place.size(); ++i) {
        if (i + ahead < tree.place.size())
            __builtin_prefetch(&vertex_m[tree.vertex_of_place[i + ahead]]);
        const dvec3 p = (vertex_m[tree.vertex_of_place[i]] - origin) * scale;
        tree.place[i] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z),
                         0.0f};
    }
}

float farthest(const Node& root) noexcept {
    float out = 0.0f;
    for (int axis = 0; axis < 3; ++axis)
        for (int lane = 0; lane < kWidth; ++lane)
            if (root.child[lane] != WideTree::kNothing)
                out = std::max(
                    {out, std::abs(root.low[axis][lane]), std::abs(root.high[axis][lane])});
    return out;
}

} // namespace

WideTree make_wide_tree(const MeshView& mesh) {
    WideTree tree;
    if (!mesh.triangle.empty()) {
        Builder builder{tree, mesh, {}, {}, {}};
        builder.place.resize(mesh.vertex_m.size(), WideTree::kNothing);
        builder.order.resize(mesh.triangle.size());
        std::iota(builder.order.begin(), builder.order.end(), 0u);
        for (const auto& [a, b, c] : mesh.triangle)
            builder.centre.push_back((mesh.vertex_m[a] + mesh.vertex_m[b] + mesh.vertex_m[c]) /
                                     3.0);
        builder.add_node({0, static_cast<std::uint32_t>(builder.order.size())}, WideTree::kNothing);
    }
    tree.place.resize(tree.vertex_of_place.size());
    choose_frame(tree, mesh);
    refit(tree, mesh);
    return tree;
}

void refit(WideTree& tree, const MeshView& mesh) noexcept {
    tree.version = next_version();
    tree.moving = !mesh.before_m.empty();
    if (tree.node.empty())
        return;
    fill_places(tree, mesh.vertex_m);
    wide_detail::fill_boxes(tree);
    // gone from its frame, or out of all proportion to it: the frame follows
    const float far = farthest(tree.node[0]);
    if (far > 2.0f && far < kFarFloat) {
        choose_frame(tree, mesh);
        fill_places(tree, mesh.vertex_m);
        wide_detail::fill_boxes(tree);
    }
    if (!mesh.before_m.empty()) {
        fill_places(tree, mesh.before_m);
        wide_detail::widen_boxes(tree);
    }
}

namespace wide_detail {

double slack(const glm::dvec3& p) noexcept {
    return kSlack * std::max({1.0, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

TreeReach make_reach(const WideTree& tree, const Reach& reach) noexcept {
    const glm::dvec3 from = tree.to_tree(reach.from_m), to = tree.to_tree(reach.to_m);
    const glm::dvec3 d = to - from;
    TreeReach out;
    const double wide = reach.radius_m * tree.scale_pm + 2.0 * std::max(slack(from), slack(to));
    out.radius = static_cast<float>(std::min(wide, 1e18));
    out.point = d == glm::dvec3{0.0};
    constexpr double most = 1e30; // instead of infinity, so that 0 times it is 0
    for (int axis = 0; axis < 3; ++axis) {
        out.from[axis] = static_cast<float>(from[axis]);
        out.inverse[axis] = static_cast<float>(std::clamp(1.0 / d[axis], -most, most));
    }
    return out;
}

namespace {

// Eight boxes against a reach. The order of the loops lets the compiler take lanes side by side.
std::uint32_t boxes_met(const float (&low)[3][kWidth], const float (&high)[3][kWidth],
                        const TreeReach& reach, std::array<float, kWidth>& order) noexcept {
    std::array<float, kWidth> in{}, out, distance2{};
    out.fill(1.0f);
    for (int axis = 0; axis < 3; ++axis)
        for (int lane = 0; lane < kWidth; ++lane) {
            const float l = low[axis][lane] - reach.from[axis];
            const float h = high[axis][lane] - reach.from[axis];
            const float off = std::max(std::max(l, -h), 0.0f);
            distance2[lane] += off * off;
            const float a = (l - reach.radius) * reach.inverse[axis];
            const float b = (h + reach.radius) * reach.inverse[axis];
            in[lane] = std::max(in[lane], std::min(a, b));
            out[lane] = std::min(out[lane], std::max(a, b));
        }
    std::uint32_t met = 0;
    for (int lane = 0; lane < kWidth; ++lane) {
        const bool hit = reach.point ? distance2[lane] <= reach.radius * reach.radius
                                     : in[lane] <= out[lane] * (1.0f + 1e-5f) + 1e-6f;
        met |= static_cast<std::uint32_t>(hit) << lane;
        order[lane] = reach.point ? distance2[lane] : in[lane];
    }
    return met;
}

} // namespace

std::uint32_t children_met(const WideTree::Node& node, const TreeReach& reach,
                           std::array<float, kWidth>& order) noexcept {
    std::uint32_t there = 0;
    for (int lane = 0; lane < kWidth; ++lane)
        there |= static_cast<std::uint32_t>(node.child[lane] != WideTree::kNothing) << lane;
    return boxes_met(node.low, node.high, reach, order) & there;
}

std::uint32_t triangles_met(const WideTree::Leaf& leaf, const TreeReach& reach) noexcept {
    float low[3][kWidth], high[3][kWidth];
    for (int axis = 0; axis < 3; ++axis)
        for (int lane = 0; lane < kWidth; ++lane) {
            const float a = leaf.corner[0][axis][lane], b = leaf.corner[1][axis][lane],
                        c = leaf.corner[2][axis][lane];
            low[axis][lane] = std::min(std::min(a, b), c);
            high[axis][lane] = std::max(std::max(a, b), c);
        }
    std::array<float, kWidth> order;
    return boxes_met(low, high, reach, order);
}

} // namespace wide_detail

} // namespace haptics
