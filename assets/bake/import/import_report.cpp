// What import says about a surface and its organs, as JSON and as text. Called by import_main.
#include "assets/bake/import/import.h"
#include "assets/bake/quadratic.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace bake {
namespace {

using Json = nlohmann::ordered_json;

double change_percent(const ImportedBody& b) {
    return 100.0 * (b.volume_m3 / b.given_m3 - 1.0);
}

double hausdorff_m(const ImportedBody& b) {
    return std::max(b.skin_distance_m, b.boundary_distance_m);
}

struct Total {
    std::size_t tets = 0, nodes = 0, skin_triangles = 0;
    double volume_m3 = 0.0, change_percent = 0.0, hausdorff_m = 0.0;
    double worst_dihedral_deg = 180.0, worst_aspect = 0.0;
};

Total total_of(const Imported& imported) {
    Total t;
    for (const auto& b : imported.bodies) {
        t.tets += b.organ.mesh.tets.size();
        t.nodes += b.organ.mesh.rest_m.size();
        t.skin_triangles += b.organ.surface.triangles.size();
        t.volume_m3 += b.volume_m3;
        t.hausdorff_m = std::max(t.hausdorff_m, hausdorff_m(b));
        t.worst_dihedral_deg = std::min(t.worst_dihedral_deg, b.quality.worst_dihedral_deg);
        t.worst_aspect = std::max(t.worst_aspect, b.quality.worst_aspect);
        if (std::abs(change_percent(b)) > std::abs(t.change_percent)) {
            t.change_percent = change_percent(b);
        }
    }
    return t;
}

Json quadratic_json(const QuadraticBody& b, double given_m3) {
    Json j;
    j["file"] = b.organ.name + kQuadraticEnding;
    j["hash"] = fmt::format("{:016x}", b.organ.recipe_hash);
    j["edge_mm"] = 1e3 * b.edge_m;
    j["mean_edge_mm"] = 1e3 * b.quality.mean_edge_m;
    j["nodes"] = b.organ.mesh.rest_m.size(); // corners
    j["tets"] = b.organ.mesh.tets.size();
    j["volume_change_percent"] = 100.0 * (b.volume_m3 / given_m3 - 1.0);
    j["boundary_hausdorff_m"] = b.boundary_distance_m;
    j["worst_dihedral_deg"] = b.quality.worst_dihedral_deg;
    return j;
}

Json body_json(const ImportedBody& b, bool with_times) {
    Json j;
    j["name"] = b.organ.name;
    j["file"] = b.organ.name + ".organ";
    j["hash"] = fmt::format("{:016x}", b.organ.recipe_hash);
    j["triangles_given"] = b.given.triangles.size();
    j["skin_mm"] = 1e3 * b.skin_m;
    j["skin_vertices"] = b.organ.surface.rest_m.size();
    j["skin_triangles"] = b.organ.surface.triangles.size();
    j["volume_given_m3"] = b.given_m3;
    j["volume_m3"] = b.volume_m3;
    j["volume_change_percent"] = change_percent(b);
    j["skin_hausdorff_m"] = b.skin_distance_m;
    if (b.organ.rigid) {
        return j;
    }
    j["edge_mm"] = 1e3 * b.edge_m;
    j["mean_edge_mm"] = 1e3 * b.quality.mean_edge_m;
    j["nodes"] = b.organ.mesh.rest_m.size();
    j["tets"] = b.organ.mesh.tets.size();
    j["boundary_hausdorff_m"] = b.boundary_distance_m;
    j["worst_dihedral_deg"] = b.quality.worst_dihedral_deg;
    j["largest_dihedral_deg"] = b.quality.largest_dihedral_deg;
    j["aspect"] = {{"worst", b.quality.worst_aspect}, {"mean", b.quality.mean_aspect}};
    if (b.quadratic) {
        j["quadratic"] = quadratic_json(*b.quadratic, b.given_m3);
    }
    for (const auto& a : b.attempts) {
        j["attempts"].push_back({{"what", a.what}, {"outcome", a.outcome}});
        if (with_times) {
            j["attempts"].back()["seconds"] = a.seconds;
        }
    }
    return j;
}

} // namespace

std::string import_json(const Imported& imported, const ImportOptions& options, bool with_times) {
    const Total total = total_of(imported);
    Json j;
    j["bodies"] = imported.found;
    j["organs"] = imported.bodies.size();
    j["triangles"] = imported.triangles;
    j["repairs"] = imported.notes.repairs;
    j["problems"] = imported.notes.problems;
    j["tets"] = total.tets;
    j["nodes"] = total.nodes;
    j["volume_m3"] = total.volume_m3;
    j["worst_dihedral_deg"] = options.rigid ? Json() : Json(total.worst_dihedral_deg);
    if (with_times) {
        j["seconds"] = imported.seconds;
    }
    j["aspect"] = options.rigid ? Json() : Json(total.worst_aspect);
    j["volume_change_percent"] = total.change_percent;
    j["hausdorff_m"] = total.hausdorff_m;
    j["edge_mm"] = imported.bodies.empty() ? 0.0 : 1e3 * imported.bodies[0].edge_m;
    j["unit"] = options.unit.name;
    j["rigid"] = options.rigid;
    j["format"] = imported.format;
    if (!options.rigid) {
        j["material"] = {{"young_pa", options.material.young_pa},
                         {"poisson", options.material.poisson},
                         {"density_kgpm3", options.material.density_kgpm3},
                         {"source", options.material.source}};
    }
    for (const auto& b : imported.bodies) {
        j["files"].push_back(b.organ.name + ".organ");
        if (b.quadratic) {
            j["files"].push_back(b.organ.name + kQuadraticEnding);
        }
        j["body"].push_back(body_json(b, with_times));
    }
    j["files"].push_back("report.json");
    j["files"].push_back("report.txt");
    if (with_times) {
        for (const auto& phase : imported.phases) {
            j["phases"].push_back({{"name", phase.name}, {"seconds", phase.seconds}});
        }
    }
    return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string import_text(const Imported& imported, const ImportOptions& options) {
    std::string text =
        fmt::format("{} triangles ({}), {} {}, {} {}\n", imported.triangles, imported.format,
                    imported.found, imported.found == 1 ? "body" : "bodies", imported.bodies.size(),
                    imported.bodies.size() == 1 ? "organ" : "organs");
    for (const auto& line : imported.notes.repairs) {
        text += fmt::format("repaired: {}\n", line);
    }
    for (const auto& line : imported.notes.problems) {
        text += fmt::format("problem: {}\n", line);
    }
    if (imported.notes.repairs.empty() && imported.notes.problems.empty()) {
        text += "nothing was wrong with it\n";
    }
    for (const auto& b : imported.bodies) {
        text += fmt::format("{}.organ: {:.4g} ml ({:+.2f} %), skin of {} triangles, at most {:.2f} "
                            "mm from the surface given\n",
                            b.organ.name, 1e6 * b.volume_m3, change_percent(b),
                            b.organ.surface.triangles.size(), 1e3 * b.skin_distance_m);
        if (b.organ.rigid) {
            continue;
        }
        text += fmt::format(
            "  {} nodes, {} tetrahedra of {:.1f} mm (mean {:.1f}), their boundary at most {:.2f} "
            "mm from the surface given\n",
            b.organ.mesh.rest_m.size(), b.organ.mesh.tets.size(), 1e3 * b.edge_m,
            1e3 * b.quality.mean_edge_m, 1e3 * b.boundary_distance_m);
        text += fmt::format("  dihedral angles {:.1f} to {:.1f} degrees, worst aspect {:.1f}, mean "
                            "{:.1f}\n",
                            b.quality.worst_dihedral_deg, b.quality.largest_dihedral_deg,
                            b.quality.worst_aspect, b.quality.mean_aspect);
        if (b.quadratic) {
            const auto& q = *b.quadratic;
            text += fmt::format(
                "  {}{}: the same skin for quadratic shapes, {} corners, {} tetrahedra of {:.1f} "
                "mm, {:.2f} mm away, dihedral angles from {:.1f} degrees\n",
                q.organ.name, kQuadraticEnding, q.organ.mesh.rest_m.size(),
                q.organ.mesh.tets.size(), 1e3 * q.edge_m, 1e3 * q.boundary_distance_m,
                q.quality.worst_dihedral_deg);
        }
        for (const auto& a : b.attempts) {
            text += a.outcome == "done" ? "" : fmt::format("  {}: {}\n", a.what, a.outcome);
        }
    }
    if (!options.rigid) {
        text += fmt::format("material: {:.0f} Pa, Poisson's ratio {}, {} kg/m3; {}\n",
                            options.material.young_pa, options.material.poisson,
                            options.material.density_kgpm3, options.material.source);
    }
    return text;
}

} // namespace bake
