#include "assets/bake/recipe.h"

#include "assets/bake/recipe_table.h"

#include <fmt/format.h>

namespace bake {
namespace {

std::vector<Ellipsoid> read_ellipsoids(const Table& top, const char* key) {
    std::vector<Ellipsoid> list;
    for (const Table& t : top.tables(key)) {
        list.push_back({.centre_mm = t.vector("centre_mm", -1e3, 1e3),
                        .radius_mm = t.vector("radius_mm", 0.5, 1e3),
                        .tilt_deg = t.vector("tilt_deg", -180.0, 180.0, glm::dvec3{0.0}),
                        .blend_mm = t.number("blend_mm", 0.0, 100.0, 0.0)});
        t.no_other_keys();
    }
    return list;
}

struct Noise {
    double noise_mm, wavelength_mm;
    std::uint64_t seed;
};
Noise read_noise(const Table& top, double usual_wavelength_mm) {
    return {top.number("noise_mm", 0.0, 20.0, 0.0),
            top.number("noise_wavelength_mm", 5.0, 500.0, usual_wavelength_mm),
            static_cast<std::uint64_t>(top.integer("seed", 0, 1'000'000'000, 1))};
}

LobedShape read_lobed(const Table& top) {
    const Noise noise = read_noise(top, 30.0);
    LobedShape shape{.lobes = read_ellipsoids(top, "lobe"),
                     .hollows = read_ellipsoids(top, "hollow"),
                     .noise_mm = noise.noise_mm,
                     .noise_wavelength_mm = noise.wavelength_mm,
                     .seed = noise.seed};
    if (shape.lobes.empty()) {
        top.missing("lobe", "at least one [[lobe]] table");
    }
    return shape;
}

VaultShape read_vault(const Table& top) {
    const Noise noise = read_noise(top, 60.0);
    return {.centre_mm = top.vector("centre_mm", -1e3, 1e3),
            .radius_mm = top.vector("radius_mm", 10.0, 1e3),
            .opening_deg = top.number("opening_deg", 10.0, 170.0, 90.0),
            .noise_mm = noise.noise_mm,
            .noise_wavelength_mm = noise.wavelength_mm,
            .seed = noise.seed};
}

BoxShape read_box(const Table& top) {
    BoxShape box{.size_mm = top.vector("size_mm", 1.0, 1e3), .cells = {}};
    if (top.has("cells")) {
        const glm::dvec3 n = top.vector("cells", 1.0, 100.0);
        std::array<int, 3> cells{};
        for (int d = 0; d < 3; ++d) {
            cells[d] = static_cast<int>(n[d]);
            if (cells[d] != n[d]) {
                top.refuse("cells", "three whole numbers from 1 to 100");
            }
        }
        box.cells = cells;
    }
    box.skin_on_top_only = top.word("skin", {"top", "whole"}, "top") == "top";
    return box;
}

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

    const std::string kind = top.word("kind", {"liver", "wall", "box"});
    if (kind == "wall") {
        recipe.kind = Kind::wall;
        recipe.shape = read_vault(top);
    } else {
        recipe.kind = kind == "liver" ? Kind::liver : Kind::box;
        if (kind == "liver") {
            recipe.shape = read_lobed(top);
        } else {
            recipe.shape = read_box(top);
        }
        recipe.tip_radius_max_mm = top.number("tip_radius_max_mm", 0.1, 20.0, 3.0);
        recipe.quality_ratio = top.number("quality_ratio", 1.05, 10.0, recipe.quality_ratio);
        recipe.quality_dihedral_deg =
            top.number("quality_dihedral_deg", 0.0, 25.0, recipe.quality_dihedral_deg);
        read_anchors(top, recipe);
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
