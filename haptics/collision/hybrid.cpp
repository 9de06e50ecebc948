#include "haptics/collision/hybrid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numeric>

namespace haptics {
namespace {

using glm::dvec3;

constexpr double kSide = 3.0;     // of a cell, in average edges
constexpr std::size_t kMany = 16; // triangles from which on a tree is faster than their boxes
constexpr double kLong = 2.0;     // cells along any axis
constexpr double kMostAlong = 1 << 20;

ItemBox joined(const ItemBox& a, const ItemBox& b) noexcept {
    return {glm::min(a.low_m, b.low_m), glm::max(a.high_m, b.high_m)};
}

ItemBox nothing() noexcept {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {dvec3{kInfinity}, dvec3{-kInfinity}};
}

struct Placed {
    std::uint64_t key = 0;
    std::uint32_t triangle = 0;
};

/// The ordinary triangles by the cell of their middle; the long ones into `large`.
std::vector<Placed> place_triangles(const MeshView& mesh, double cell_m,
                                    std::vector<std::uint32_t>& large) {
    std::vector<ItemBox> box;
    ItemBox all = nothing();
    for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t) {
        box.push_back(box_of(mesh, t));
        all = joined(all, box.back());
    }
    const dvec3 whole = all.high_m - all.low_m;
    const double side_m = std::max(cell_m, std::max({whole.x, whole.y, whole.z}) / kMostAlong);
    std::vector<Placed> out;
    for (std::uint32_t t = 0; t < box.size(); ++t) {
        const dvec3 size = box[t].high_m - box[t].low_m;
        if (std::max({size.x, size.y, size.z}) > kLong * side_m) {
            large.push_back(t);
            continue;
        }
        CellPlace at{};
        for (int k = 0; k < 3 && side_m > 0.0; ++k)
            at[k] = static_cast<std::int32_t>(
                (0.5 * (box[t].low_m[k] + box[t].high_m[k]) - all.low_m[k]) / side_m);
        out.push_back({cell_key(at), t});
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Placed& a, const Placed& b) { return a.key < b.key; });
    return out;
}

} // namespace

Hybrid make_hybrid(const MeshView& mesh) {
    Hybrid hybrid{.wanted_m = kSide * average_edge_m(mesh),
                  .cluster = {},
                  .box = {},
                  .table = {},
                  .large = {}};
    std::vector<std::uint32_t> large, in;
    const std::vector<Placed> placed = place_triangles(mesh, hybrid.wanted_m, large);
    for (std::size_t i = 0; i < placed.size(); ++i) {
        in.push_back(placed[i].triangle);
        if (i + 1 < placed.size() && placed[i + 1].key == placed[i].key)
            continue;
        if (in.size() > kMany)
            hybrid.cluster.push_back({.tree = make_obb_tree(mesh, in), .triangle = {}, .box = {}});
        else
            hybrid.cluster.push_back(
                {.tree = {}, .triangle = in, .box = std::vector<ItemBox>(in.size())});
        in.clear();
    }
    hybrid.box.resize(hybrid.cluster.size());
    hybrid.table = make_cell_table(hybrid.cluster.size());
    hybrid.large = make_obb_tree(mesh, large);
    refit(hybrid, mesh);
    return hybrid;
}

void refit(Hybrid& hybrid, const MeshView& mesh) noexcept {
    for (std::size_t c = 0; c < hybrid.cluster.size(); ++c) {
        Hybrid::Cluster& cluster = hybrid.cluster[c];
        refit(cluster.tree, mesh);
        ItemBox all = nothing();
        for (const std::uint32_t t : cluster.tree.triangle)
            all = joined(all, box_of(mesh, t));
        for (std::size_t i = 0; i < cluster.triangle.size(); ++i) {
            cluster.box[i] = box_of(mesh, cluster.triangle[i]);
            all = joined(all, cluster.box[i]);
        }
        hybrid.box[c] = all;
    }
    lay_out(hybrid.table, hybrid.box, hybrid.wanted_m);
    for (std::uint32_t c = 0; c < hybrid.box.size(); ++c) {
        if (hybrid.box[c].low_m.x > hybrid.box[c].high_m.x)
            continue;
        const CellRange r = cells_of(hybrid.table, hybrid.box[c]);
        CellPlace at;
        for (at[2] = r.low[2]; at[2] <= r.high[2]; ++at[2])
            for (at[1] = r.low[1]; at[1] <= r.high[1]; ++at[1])
                for (at[0] = r.low[0]; at[0] <= r.high[0]; ++at[0])
                    list_item(hybrid.table, at, c);
    }
    finish(hybrid.table);
    refit(hybrid.large, mesh);
}

} // namespace haptics
