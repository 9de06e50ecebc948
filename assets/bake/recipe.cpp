#include "assets/bake/recipe.h"

#include "assets/bake/recipe_shapes.h"
#include "assets/bake/recipe_table.h"

#include <fmt/format.h>
#include <tuple>

namespace bake {
namespace {

void read_anchors(const Table& top, Recipe& recipe) {
    for (const Table& t : top.tables("anchor_sphere")) {
        recipe.anchor_spheres.push_back({.centre_mm = t.vector("centre_mm", -1e3, 1e3),
                                         .radius_mm = t.number("radius_mm", 0.0, 1e3)});
        t.no_other_keys();
    }
    for (const Table& t : top.tables("anchor_box")) {
        recipe.anchor_boxes.push_back(
            {.low_mm = t.vector("low_mm", -1e3, 1e3), .high_mm = t.vector("high_mm", -1e3, 1e3)});
        t.no_other_keys();
    }
    recipe.hold_length_mm = top.number("hold_length_mm", 0.0, 100.0, 0.0);
}

void read_fine(const Table& top, Recipe& recipe) {
    for (const Table& t : top.tables("fine")) {
        recipe.fine.push_back({.centre_mm = t.vector("centre_mm", -1e3, 1e3),
                               .radius_mm = t.number("radius_mm", 0.0, 1e3),
                               .edge_mm = t.number("edge_mm", 0.5, 100.0),
                               .growth = t.number("growth", 0.05, 2.0, 0.5)});
        t.no_other_keys();
    }
}

void read_quadratic(const Table& top, Recipe& recipe) {
    const auto* box = std::get_if<BoxShape>(&recipe.shape);
    if (recipe.kind == Kind::sheet || (box != nullptr && box->cells)) {
        if (top.has("quadratic_cells")) {
            recipe.quadratic_cells = read_cells(top, "quadratic_cells");
        }
    } else if (top.has("quadratic_edge_mm")) {
        recipe.quadratic_edge_mm = top.number("quadratic_edge_mm", 1.0, 100.0);
    }
}

tissue::Material read_material(const Table& t) {
    tissue::Material m;
    m.young_pa = t.number("young_pa", 1.0, 1e9, m.young_pa);
    m.poisson = t.number("poisson", 0.0, 0.499, m.poisson);
    m.density_kgpm3 = t.number("density_kgpm3", 1.0, 1e5, m.density_kgpm3);
    m.damping_mass_1ps = t.number("damping_mass_1ps", 0.0, 1e3, m.damping_mass_1ps);
    m.damping_stiffness_s = t.number("damping_stiffness_s", 0.0, 1.0, m.damping_stiffness_s);
    m.friction = t.number("friction", 0.0, 2.0, m.friction);
    m.source = t.text("source");
    t.no_other_keys();
    return m;
}

std::uint64_t fnv1a(std::string_view text) {
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    for (const char c : text) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
    }
    return hash;
}

} // namespace

Recipe parse_recipe(const std::string& text, const std::string& file_name) {
    const Table top = Table::parse(text, file_name);
    Recipe recipe;
    recipe.text_hash = fnv1a(text);
    recipe.name = top.text("name");
    recipe.edge_mm = top.number("edge_mm", 1.0, 100.0, recipe.edge_mm);
    recipe.skin_mm = top.number("skin_mm", 0.5, 50.0, recipe.skin_mm);

    std::tie(recipe.kind, recipe.shape) = read_shape(top);
    if (!is_rigid(recipe.kind)) {
        recipe.tip_radius_max_mm = top.number("tip_radius_max_mm", 0.1, 20.0, 3.0);
        read_anchors(top, recipe);
        read_quadratic(top, recipe);
    }
    if (recipe.kind == Kind::tube) {
        recipe.rod = top.word("inside", {"rod", "tetrahedra"}, "rod") == "rod";
        recipe.bed_kpa = recipe.rod ? top.number("bed_kpa", 0.0, 1e3, 0.0) : 0.0;
    }
    if (recipe.kind == Kind::liver || recipe.kind == Kind::box) { // by TetGen
        recipe.quality_ratio = top.number("quality_ratio", 1.05, 10.0, recipe.quality_ratio);
        recipe.quality_dihedral_deg =
            top.number("quality_dihedral_deg", 0.0, 25.0, recipe.quality_dihedral_deg);
        recipe.local_terms = top.word("mesh_terms", {"whole", "local"}, "whole") == "local";
        read_fine(top, recipe);
    }
    if (top.has("material")) {
        recipe.material = read_material(top.table("material"));
    }
    top.no_other_keys();
    return recipe;
}

tissue::Material find_material(const std::string& text, const std::string& file_name,
                               const std::string& name) {
    const Table all = Table::parse(text, file_name);
    if (!all.has(name.c_str())) {
        std::string names;
        for (const auto& key : all.keys()) {
            names += (names.empty() ? "" : ", ") + key;
        }
        throw RecipeError(
            fmt::format("{}: there is no material \"{}\": accepted: {}", file_name, name, names));
    }
    return read_material(all.table(name.c_str()));
}

} // namespace bake
