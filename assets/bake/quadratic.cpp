#include "assets/bake/quadratic.h"

#include "assets/bake/edge_for_nodes.h"

#include <algorithm>
#include <cmath>

namespace bake {
namespace {

constexpr double kMm = 1e-3;
constexpr double kCellsShare = 0.75;
constexpr double kRadiiApart = 2.0;

std::array<int, 3> fewer(std::array<int, 3> cells) {
    for (int& n : cells) {
        n = std::max(1, static_cast<int>(std::lround(kCellsShare * n)));
    }
    return cells;
}

double usual_edge_mm(const Recipe& recipe, const Surface& skin) {
    double volume_m3 = 0.0, area = 0.0;
    if (const auto* tube = std::get_if<TubeShape>(&recipe.shape)) {
        return kRadiiApart * std::min(tube->radius_mm, tube->radius_end_mm);
    }
    if (const auto* box = std::get_if<BoxShape>(&recipe.shape)) { // its skin may be the top alone
        const glm::dvec3 s = kMm * box->size_mm;
        volume_m3 = s.x * s.y * s.z;
        area = 2.0 * (s.x * s.y + s.y * s.z + s.z * s.x);
    } else {
        volume_m3 = bake::volume_m3(skin);
        area = area_m2(skin);
    }
    return edge_for_nodes(volume_m3, area, kQuadraticNodes) / kMm;
}

} // namespace

Recipe quadratic_recipe(const Recipe& recipe, const Surface& skin) {
    Recipe coarse = recipe;
    if (auto* sheet = std::get_if<SheetShape>(&coarse.shape)) {
        sheet->cells = recipe.quadratic_cells.value_or(fewer(sheet->cells));
        return coarse;
    }
    if (auto* box = std::get_if<BoxShape>(&coarse.shape); box != nullptr && box->cells) {
        box->cells = recipe.quadratic_cells.value_or(fewer(*box->cells));
        return coarse;
    }
    coarse.edge_mm =
        recipe.quadratic_edge_mm.value_or(std::max(recipe.edge_mm, usual_edge_mm(recipe, skin)));
    coarse.radii_per_edge = kQuadraticRadiiPerEdge;
    for (FineSpot& spot : coarse.fine) {
        spot.edge_mm *= coarse.edge_mm / recipe.edge_mm;
    }
    return coarse;
}

} // namespace bake
