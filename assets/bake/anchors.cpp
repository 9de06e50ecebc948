#include "assets/bake/anchors.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace bake {
namespace {

constexpr double kMm = 1e-3;
constexpr double kSlackMm = 1e-6; // a face of the box counts as inside

bool in_anchor(const Recipe& recipe, const glm::dvec3& p_m) {
    const glm::dvec3 p = p_m / kMm;
    const auto in_sphere = [&](const AnchorSphere& s) {
        return glm::length(p - s.centre_mm) <= s.radius_mm;
    };
    const auto in_box = [&](const AnchorBox& b) {
        return glm::all(glm::greaterThanEqual(p, b.low_mm - kSlackMm)) &&
               glm::all(glm::lessThanEqual(p, b.high_mm + kSlackMm));
    };
    return std::any_of(recipe.anchor_spheres.begin(), recipe.anchor_spheres.end(), in_sphere) ||
           std::any_of(recipe.anchor_boxes.begin(), recipe.anchor_boxes.end(), in_box);
}

void make_line_anchors(const Recipe& recipe, tissue::RodLine& line) {
    const auto inside = [&](const glm::dvec3& p_m) { return in_anchor(recipe, p_m); };
    line.bed_pa = 1e3 * recipe.bed_kpa;
    if (recipe.hold_length_mm > 0.0) {
        tissue::hold_line(inside, kMm * recipe.hold_length_mm, line);
    } else {
        tissue::fix_line(inside, line);
    }
    if (!tissue::has_hold(line)) {
        throw RecipeError(fmt::format("{}: anchor_sphere and anchor_box hold no part of the rod: "
                                      "accepted: hold_length_mm and one that meets its line, one "
                                      "that two nodes in a row lie in, or bed_kpa",
                                      recipe.name));
    }
}

} // namespace

void make_anchors(const Recipe& recipe, tissue::BakedOrgan& organ) {
    if (tissue::is_rod(organ)) {
        make_line_anchors(recipe, organ.line);
        return;
    }
    const tissue::TetMesh& mesh = organ.mesh;
    organ.anchored.assign(mesh.rest_m.size(), 0);
    organ.bed.clear();
    if (recipe.hold_length_mm > 0.0) {
        organ.bed = tissue::make_bed(
            mesh, [&](const glm::dvec3& p_m) { return in_anchor(recipe, p_m); },
            kMm * recipe.hold_length_mm);
        if (organ.bed.empty()) {
            throw RecipeError(fmt::format("{}: anchor_sphere and anchor_box hold no part of the "
                                          "body: accepted: at least one that meets it",
                                          recipe.name));
        }
        return;
    }
    std::transform(mesh.rest_m.begin(), mesh.rest_m.end(), organ.anchored.begin(),
                   [&](const glm::dvec3& p_m) { return std::uint8_t{in_anchor(recipe, p_m)}; });
    const auto count = std::count(organ.anchored.begin(), organ.anchored.end(), 1);
    if (count < 3) {
        throw RecipeError(fmt::format("{}: anchor_sphere and anchor_box hold {} of {} nodes: "
                                      "accepted: at least 3, or the body would float",
                                      recipe.name, count, mesh.rest_m.size()));
    }
}

} // namespace bake
