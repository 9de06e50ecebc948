// What bake says about an organ, as JSON and as OBJ. Called by bake's main.
#include "assets/bake/bake.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <nlohmann/json.hpp>

namespace bake {
namespace {

void append_object(std::string& out, const char* name, const std::vector<glm::dvec3>& point_m,
                   const std::vector<tissue::Triangle>& triangles, std::size_t first) {
    auto to = std::back_inserter(out);
    fmt::format_to(to, "o {}\n", name);
    for (const auto& p : point_m) {
        fmt::format_to(to, "v {} {} {}\n", p.x, p.y, p.z);
    }
    for (const auto& t : triangles) { // OBJ counts from 1, through the whole file
        fmt::format_to(to, "f {} {} {}\n", t[0] + first, t[1] + first, t[2] + first);
    }
}

} // namespace

std::string report_json(const Recipe& recipe, const Baked& baked) {
    const auto& organ = baked.organ;
    const auto& r = baked.report;
    nlohmann::ordered_json j;
    j["name"] = organ.name;
    j["rigid"] = organ.rigid;
    j["recipe_hash"] = fmt::format("{:016x}", organ.recipe_hash);
    j["skin_mm"] = recipe.skin_mm;
    j["skin_vertices"] = organ.surface.rest_m.size();
    j["skin_triangles"] = organ.surface.triangles.size();
    if (tissue::is_rod(organ)) {
        const auto& line = organ.line;
        j["edge_mm"] = r.edge_mm;
        j["nodes"] = line.node_m.size();
        j["held_nodes"] = std::count(line.held.begin(), line.held.end(), 1);
        j["hold_npm"] = tissue::hold_npm(line, organ.material.young_pa);
        j["free_unknowns"] = tissue::make_rod(line, organ.material, glm::dvec3{0.0}).unknowns;
        j["volume_m3"] = r.mesh_volume_m3;
        j["skin_volume_m3"] = r.skin_volume_m3;
        j["volume_change"] = r.mesh_volume_m3 / r.skin_volume_m3 - 1.0;
    } else if (!organ.rigid) {
        const auto anchored =
            static_cast<std::size_t>(std::count(organ.anchored.begin(), organ.anchored.end(), 1));
        j["order"] = organ.order;
        j["edge_mm"] = r.edge_mm;
        j["nodes"] = organ.mesh.rest_m.size();
        j["tets"] = organ.mesh.tets.size();
        j["anchored_nodes"] = anchored;
        double hold_m = 0.0;
        for (const auto& sample : organ.bed) {
            hold_m += sample.stiffness_m;
        }
        j["hold_npm"] = hold_m * organ.material.young_pa;
        j["free_unknowns"] = 3 * (organ.mesh.rest_m.size() - anchored);
        j["volume_m3"] = r.mesh_volume_m3;
        j["worst_dihedral_deg"] = r.quality.worst_dihedral_deg;
        j["largest_dihedral_deg"] = r.quality.largest_dihedral_deg;
        j["worst_aspect"] = r.quality.worst_aspect;
        j["mean_aspect"] = r.quality.mean_aspect;
        j["skin_to_mesh_m"] = r.skin_to_mesh_m;
        if (r.skin_volume_m3 > 0.0) {
            j["skin_volume_m3"] = r.skin_volume_m3;
            j["volume_change"] = r.mesh_volume_m3 / r.skin_volume_m3 - 1.0;
            j["mesh_to_skin_m"] = r.mesh_to_skin_m;
        }
        for (const auto& a : r.attempts) {
            j["attempts"].push_back(
                {{"what", a.what}, {"outcome", a.outcome}, {"seconds", a.seconds}});
        }
    }
    for (const auto& phase : r.phases) {
        j["seconds"][phase.name] = phase.seconds;
    }
    return j.dump(2) + "\n";
}

std::string obj_text(const Baked& baked) {
    std::string out;
    const auto& skin = baked.organ.surface;
    append_object(out, "skin", skin.rest_m, skin.triangles, 1);
    append_object(out, "boundary", baked.boundary.point_m, baked.boundary.triangles,
                  1 + skin.rest_m.size());
    return out;
}

} // namespace bake
