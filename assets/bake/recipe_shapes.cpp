#include "assets/bake/recipe_shapes.h"

#include "assets/bake/centreline.h"
#include "assets/bake/recipe_table.h"

#include <algorithm>
#include <fmt/format.h>
#include <numbers>

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
        box.cells = read_cells(top, "cells");
    }
    box.skin_on_top_only = top.word("skin", {"top", "whole"}, "top") == "top";
    return box;
}

Pit read_pit(const Table& t, const GroundShape& ground) {
    Pit pit{.centre_mm = t.pair("centre_mm", -1e3, 1e3),
            .radius_mm = t.pair("radius_mm", 1.0, 1e3),
            .depth_mm = t.number("depth_mm", 0.1, 200.0)};
    // further in than the radius of the rim's curvature, the walls would meet in a crease
    const double small = std::min(pit.radius_mm.x, pit.radius_mm.y),
                 large = std::max(pit.radius_mm.x, pit.radius_mm.y);
    pit.wall_mm = t.number("wall_mm", 0.1, small * small / large);
    const glm::dvec2 room = 0.5 * ground.size_mm - pit.radius_mm - ground.flat_mm;
    const glm::dvec2 off = glm::abs(pit.centre_mm - glm::dvec2{ground.centre_mm});
    if (off.x > room.x || off.y > room.y) {
        t.refuse("centre_mm", "a place where the pit and flat_mm around it lie within size_mm");
    }
    t.no_other_keys();
    return pit;
}

GroundShape read_ground(const Table& top) {
    const Noise noise = read_noise(top, 60.0);
    GroundShape ground{.centre_mm = top.vector("centre_mm", -1e3, 1e3, glm::dvec3{0.0}),
                       .size_mm = top.pair("size_mm", 10.0, 2e3),
                       .bowl_mm = top.number("bowl_mm", 0.0, 500.0, 0.0),
                       .flat_mm = top.number("flat_mm", 0.0, 500.0, 0.0),
                       .noise_mm = noise.noise_mm,
                       .noise_wavelength_mm = noise.wavelength_mm,
                       .seed = noise.seed,
                       .pits = {}};
    for (const Table& t : top.tables("pit")) {
        ground.pits.push_back(read_pit(t, ground));
    }
    return ground;
}

SheetShape read_sheet(const Table& top) {
    const Noise noise = read_noise(top, 40.0);
    SheetShape sheet{.centre_mm = top.vector("centre_mm", -1e3, 1e3),
                     .size_mm = top.vector("size_mm", 0.5, 1e3),
                     .tilt_deg = top.vector("tilt_deg", -180.0, 180.0, glm::dvec3{0.0}),
                     .cells = read_cells(top, "cells"),
                     .bulge_mm = top.number("bulge_mm", 0.0, 100.0, 0.0),
                     .noise_mm = noise.noise_mm,
                     .noise_wavelength_mm = noise.wavelength_mm,
                     .seed = noise.seed};
    // the corners' roundings may meet, not overlap; the edge is thinned, not to a blade
    const double half_mm = std::min(0.5 * sheet.size_mm.x, sheet.size_mm.y);
    const double thick_mm = sheet.size_mm.z;
    sheet.corner_mm = top.number("corner_mm", 0.0, half_mm / kCornerReach, 0.0);
    sheet.edge_thickness_mm = top.number("edge_thickness_mm", 0.3 * thick_mm, thick_mm, thick_mm);
    sheet.taper_mm = top.number("taper_mm", 0.5, half_mm, std::min(thick_mm, half_mm));
    return sheet;
}

TubeShape read_tube(const Table& top) {
    TubeShape tube{.point_mm = top.vectors("point_mm", 2, -1e3, 1e3),
                   .radius_mm = top.number("radius_mm", 0.5, 100.0)};
    tube.radius_end_mm = top.number("radius_end_mm", 0.5, 100.0, tube.radius_mm);
    tube.sides = static_cast<int>(top.integer("sides", 5, 24, tube.sides));
    const double widest_mm = std::max(tube.radius_mm, tube.radius_end_mm);
    for (std::size_t i = 1; i < tube.point_mm.size(); ++i) {
        if (glm::distance(tube.point_mm[i - 1], tube.point_mm[i]) < widest_mm) {
            top.refuse("point_mm", fmt::format("points at least a radius ({} mm) apart; {} and {} "
                                               "are nearer",
                                               widest_mm, i - 1, i));
        }
    }
    const double bend_mm = tightest_bend_mm(tube.point_mm), least_mm = kTightestBend * widest_mm;
    if (bend_mm < least_mm) {
        top.refuse("point_mm",
                   fmt::format("a line that bends no tighter than {} radii, {:.2f} mm; this one: "
                               "{:.2f} mm",
                               kTightestBend, least_mm, bend_mm));
    }
    // half a turn of the tightest bend brings two places as near as a tube may come to itself
    const double back_mm = nearest_return_mm(tube.point_mm, std::numbers::pi * least_mm);
    if (back_mm < 2.0 * widest_mm) {
        top.refuse("point_mm", fmt::format("a line that keeps clear of itself by two radii, {:.2f} "
                                           "mm; this one: {:.2f} mm",
                                           2.0 * widest_mm, back_mm));
    }
    return tube;
}

} // namespace

std::array<int, 3> read_cells(const Table& top, const char* key) {
    const glm::dvec3 n = top.vector(key, 1.0, 100.0);
    std::array<int, 3> cells{};
    for (int d = 0; d < 3; ++d) {
        cells[d] = static_cast<int>(n[d]);
        if (cells[d] != n[d]) {
            top.refuse(key, "three whole numbers from 1 to 100");
        }
    }
    return cells;
}

std::pair<Kind, AnyShape> read_shape(const Table& top) {
    const std::string kind = top.word("kind", {"liver", "wall", "box", "ground", "sheet", "tube"});
    if (kind == "liver") {
        return {Kind::liver, read_lobed(top)};
    }
    if (kind == "wall") {
        return {Kind::wall, read_vault(top)};
    }
    if (kind == "ground") {
        return {Kind::ground, read_ground(top)};
    }
    if (kind == "sheet") {
        return {Kind::sheet, read_sheet(top)};
    }
    if (kind == "tube") {
        return {Kind::tube, read_tube(top)};
    }
    return {Kind::box, read_box(top)};
}

} // namespace bake
