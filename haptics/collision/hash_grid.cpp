#include "haptics/collision/hash_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace haptics {
namespace {

using glm::dvec3;

/// Whether a triangle meets a box (Akenine-Moeller 2001, Fast 3D Triangle-Box Overlap Testing):
/// thirteen axes, of which the three of the box are known to overlap here. The cell is centred.
bool overlaps(const std::array<dvec3, 3>& p, const dvec3& half) noexcept {
    const dvec3 edge[3] = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
    const auto apart = [&](const dvec3& axis) {
        const double a = glm::dot(axis, p[0]), b = glm::dot(axis, p[1]), c = glm::dot(axis, p[2]);
        const double reach = glm::dot(glm::abs(axis), half);
        return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
    };
    if (apart(glm::cross(edge[0], edge[1])))
        return false;
    for (const dvec3& e : edge)
        if (apart({0.0, -e.z, e.y}) || apart({e.z, 0.0, -e.x}) || apart({-e.y, e.x, 0.0}))
            return false;
    return true;
}

/// How far the corners of a triangle have moved, at most, along each axis.
dvec3 moved_m(const MeshView& mesh, std::uint32_t t) noexcept {
    dvec3 out{0.0};
    if (mesh.before_m.empty())
        return out;
    const auto now = mesh.corners(t), before = mesh.corners_before(t);
    for (int k = 0; k < 3; ++k)
        out = glm::max(out, glm::abs(now[k] - before[k]));
    return out;
}

void list_triangle(CellTable& table, const MeshView& mesh, std::uint32_t t,
                   const CellRange& r) noexcept {
    constexpr int kFew = 8; // cells: nearly all are met, to test them costs more than they do
    const dvec3 half = moved_m(mesh, t) + 0.5 * table.cell_m + table.fat_m;
    const std::array<dvec3, 3> corner = mesh.corners(t);
    const bool few =
        (r.high[0] - r.low[0] + 1) * (r.high[1] - r.low[1] + 1) * (r.high[2] - r.low[2] + 1) <=
        kFew;
    CellPlace at;
    for (at[2] = r.low[2]; at[2] <= r.high[2]; ++at[2])
        for (at[1] = r.low[1]; at[1] <= r.high[1]; ++at[1])
            for (at[0] = r.low[0]; at[0] <= r.high[0]; ++at[0]) {
                const dvec3 centre =
                    table.low_m + (dvec3{at[0], at[1], at[2]} + 0.5) * table.cell_m;
                if (few ||
                    overlaps({corner[0] - centre, corner[1] - centre, corner[2] - centre}, half))
                    list_item(table, at, t);
            }
}

} // namespace

HashGrid make_hash_grid(const MeshView& mesh) {
    HashGrid grid{.wanted_m = average_edge_m(mesh),
                  .table = make_cell_table(mesh.triangle.size()),
                  .box = std::vector<ItemBox>(mesh.triangle.size())};
    refit(grid, mesh);
    return grid;
}

void refit(HashGrid& grid, const MeshView& mesh) noexcept {
    for (std::uint32_t t = 0; t < grid.box.size(); ++t)
        grid.box[t] = box_of(mesh, t);
    lay_out(grid.table, grid.box, grid.wanted_m);
    for (std::uint32_t t = 0; t < grid.box.size(); ++t)
        if (grid.box[t].low_m.x <= grid.box[t].high_m.x)
            list_triangle(grid.table, mesh, t, cells_of(grid.table, grid.box[t]));
    finish(grid.table);
}

} // namespace haptics
