#include "assets/bake/bake.h"

#include "assets/bake/anchors.h"
#include "assets/bake/fit.h"
#include "assets/bake/local_terms.h"
#include "assets/bake/nearest.h"
#include "assets/bake/quadratic.h"
#include "assets/bake/remesh.h"
#include "tissue/response/mesh_term.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <fmt/format.h>
#include <glm/vector_relational.hpp>

namespace bake {
namespace {

constexpr double kMm = 1e-3;
constexpr double kCellPerSkin = 0.6;   // sampling of the implicit body, of the skin's edge
constexpr double kShortestShare = 0.6; // of boundary edges where it is curved, of the edge
constexpr double kBoxCreaseDeg = 40.0; // a box has edges, an organ has none
constexpr int kFitRounds = 20;         // the distance stops falling well before
constexpr int kImproveSweeps = 4;

class PhaseClock {
  public:
    PhaseClock(const BakeOptions& options, BakeReport& report)
        : options_(options), report_(report) {}
    void begin(const std::string& name) {
        end();
        report_.phases.push_back({name, 0.0});
        start_ = std::chrono::steady_clock::now();
        open_ = true;
    }
    void end() {
        if (open_) {
            Phase& phase = report_.phases.back();
            phase.seconds =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
            tell(fmt::format("{}: {:.2f} s", phase.name, phase.seconds));
        }
        open_ = false;
    }
    void tell(const std::string& line) const {
        if (options_.tell) {
            options_.tell(line);
        }
    }

  private:
    const BakeOptions& options_;
    BakeReport& report_;
    std::chrono::steady_clock::time_point start_;
    bool open_ = false;
};

void require_good(const Surface& surface, const char* what) {
    const auto problems = describe(check_surface(surface));
    if (!problems.empty()) {
        throw Refused(fmt::format("{}: {}", what, problems.front()));
    }
}

SizeAt even(double edge_m) {
    return [edge_m](const glm::dvec3&) { return edge_m; };
}

Surface lobed_skin(const Recipe& recipe, const LobedShape& shape) {
    const double skin_m = kMm * recipe.skin_mm;
    const auto bounds = lobed_bounds_m(shape);
    const Surface raw = polygonise(lobed_field(shape), bounds[0], bounds[1], kCellPerSkin * skin_m);
    require_good(raw, "the body of the recipe");
    return remesh(raw, even(skin_m), {});
}

Surface lobed_boundary(const Recipe& recipe, const Surface& skin) {
    const double edge_m = kMm * recipe.edge_mm;
    const SizeAt size = with_spots(
        curvature_size(skin, edge_m, recipe.radii_per_edge, kShortestShare), recipe.fine);
    Surface boundary = remesh(skin, size, {});
    fit_to_skin(skin, kFitRounds, 180.0, boundary);
    return boundary;
}

Surface box_boundary(const Recipe& recipe, const BoxShape& shape) {
    const double edge_m = kMm * recipe.edge_mm;
    return remesh(box_surface(kMm * shape.size_mm, edge_m), with_spots(even(edge_m), recipe.fine),
                  {.crease_deg = kBoxCreaseDeg});
}

Surface scenery_surface(const Recipe& recipe) {
    const double skin_m = kMm * recipe.skin_mm;
    const auto* vault = std::get_if<VaultShape>(&recipe.shape);
    return vault != nullptr ? vault_surface(*vault, skin_m)
                            : ground_surface(std::get<GroundShape>(recipe.shape), skin_m);
}

Surface body_skin(const Recipe& recipe) {
    const double skin_m = kMm * recipe.skin_mm;
    if (const auto* box = std::get_if<BoxShape>(&recipe.shape)) { // may be open
        const glm::dvec3 size_m = kMm * box->size_mm;
        return box->skin_on_top_only ? box_top(size_m, skin_m) : box_surface(size_m, skin_m);
    }
    const auto* lobed = std::get_if<LobedShape>(&recipe.shape);
    const auto* sheet = std::get_if<SheetShape>(&recipe.shape);
    Surface skin = lobed != nullptr   ? lobed_skin(recipe, *lobed)
                   : sheet != nullptr ? sheet_surface(*sheet, skin_m)
                                      : tube_surface(std::get<TubeShape>(recipe.shape), skin_m);
    require_good(skin, "the skin");
    return skin;
}

// Empty if the tetrahedra are made with the shape, not from a boundary.
Surface body_boundary(const Recipe& recipe, const Surface& skin, PhaseClock& clock) {
    const auto* lobed = std::get_if<LobedShape>(&recipe.shape);
    const auto* box = std::get_if<BoxShape>(&recipe.shape);
    if (lobed == nullptr && (box == nullptr || box->cells)) {
        return {};
    }
    clock.begin("boundary");
    Surface boundary = lobed != nullptr ? lobed_boundary(recipe, skin) : box_boundary(recipe, *box);
    require_good(boundary, "the boundary of the tetrahedra");
    return boundary;
}

std::optional<tissue::TetMesh> regular_mesh(const Recipe& recipe) {
    if (const auto* box = std::get_if<BoxShape>(&recipe.shape); box != nullptr && box->cells) {
        return tissue::box_mesh(kMm * box->size_mm, *box->cells);
    }
    if (const auto* sheet = std::get_if<SheetShape>(&recipe.shape)) {
        return sheet_mesh(*sheet);
    }
    if (const auto* tube = std::get_if<TubeShape>(&recipe.shape)) {
        return tube_mesh(*tube, kMm * recipe.edge_mm);
    }
    return {};
}

tissue::TetMesh make_mesh(const Recipe& recipe, const Surface& boundary, PhaseClock& clock,
                          const BakeOptions& options, BakeReport& report) {
    clock.begin("tetrahedra");
    if (auto regular = regular_mesh(recipe)) {
        tissue::check_mesh(*regular);
        return std::move(*regular);
    }
    TetAnswer answer =
        tetrahedralise(boundary, {.edge_m = kMm * recipe.edge_mm,
                                  .quality_ratio = recipe.quality_ratio,
                                  .quality_dihedral_deg = recipe.quality_dihedral_deg,
                                  .time_limit_s = options.time_limit_s});
    report.attempts = answer.attempts;
    for (const auto& a : answer.attempts) {
        clock.tell(fmt::format("  {}: {}, {:.2f} s", a.what, a.outcome, a.seconds));
    }
    if (!answer.mesh) {
        std::string why = "no tetrahedra";
        why += answer.problem.empty() ? "" : "; " + answer.problem;
        for (const auto& a : answer.attempts) {
            why += fmt::format("; {}: {}", a.what, a.outcome);
        }
        throw Refused(why);
    }
    improve_inner_nodes(*answer.mesh, kImproveSweeps);
    tissue::check_mesh(*answer.mesh);
    return std::move(*answer.mesh);
}

void measure(const Surface& skin, const Surface& boundary, const tissue::TetMesh& mesh,
             BakeReport& report) {
    const NearestOnSurface to_mesh(boundary), to_skin(skin);
    report.quality = tet_quality(mesh);
    report.mesh_volume_m3 = tissue::volume_m3(mesh, mesh.rest_m);
    report.skin_to_mesh_m = sampled_hausdorff_m(skin, to_mesh);
    if (check_surface(skin).open_edges == 0) { // an open skin covers only part of the mesh
        report.skin_volume_m3 = volume_m3(skin);
        report.mesh_to_skin_m = sampled_hausdorff_m(boundary, to_skin);
    }
}

/// FNV-1a over what decides the organ: text, overridden sizes, order, version of this program.
std::uint64_t recipe_hash(const Recipe& recipe, int order) {
    std::uint64_t hash = recipe.text_hash;
    std::vector<std::uint64_t> words{kBakeVersion, std::bit_cast<std::uint64_t>(recipe.edge_mm),
                                     std::bit_cast<std::uint64_t>(recipe.skin_mm)};
    if (order != 1) {
        words.push_back(static_cast<std::uint64_t>(order));
    }
    for (const std::uint64_t word : words) {
        for (int byte = 0; byte < 8; ++byte) {
            hash = (hash ^ (word >> (8 * byte) & 0xFF)) * 0x100000001B3ULL;
        }
    }
    return hash;
}

/// Rows and terms of the skin that is there.
void add_response(const Recipe& recipe, const BakeOptions& options, PhaseClock& clock,
                  tissue::BakedOrgan& organ) {
    clock.begin("footprints");
    const tissue::FootprintOptions footprint{.order = organ.order,
                                             .tip_radius_max_m = organ.tip_radius_max_m};
    tissue::make_footprints(organ.mesh, organ.anchored, footprint, organ.surface);
    if (organ.order != 1) {
        return;
    }
    clock.begin("mesh terms");
    tissue::make_mesh_terms(organ.mesh, organ.material.poisson, organ.anchored, footprint,
                            organ.surface, organ.bed, options.mesh_term_progress);
    if (is_slender(recipe.kind) || recipe.local_terms) {
        keep_terms_local(organ.material.poisson, organ.surface);
    }
}

} // namespace

Baked bake(const Recipe& asked, const BakeOptions& options) {
    Baked baked;
    PhaseClock clock(options, baked.report);
    tissue::BakedOrgan& organ = baked.organ;
    organ.name = asked.name;
    organ.order = options.order;
    organ.material = asked.material;
    organ.tip_radius_max_m = kMm * asked.tip_radius_max_mm;
    organ.rigid = is_rigid(asked.kind);
    if (organ.rigid && options.order != 1) {
        throw Refused("scenery has no tetrahedra, so there are none with quadratic shapes");
    }
    if (asked.rod && options.order != 1) {
        throw Refused("a tube is a rod, which has no shapes that could be quadratic");
    }

    clock.begin("skin");
    const Surface skin = organ.rigid ? scenery_surface(asked) : body_skin(asked);
    organ.surface.rest_m = skin.point_m;
    organ.surface.triangles = skin.triangles;
    organ.surface.neighbours = tissue::triangle_neighbours(skin.triangles);
    const Recipe recipe = options.order == 2 ? quadratic_recipe(asked, skin) : asked;
    organ.recipe_hash = recipe_hash(recipe, options.order);
    if (organ.rigid) {
        clock.end();
        return baked;
    }

    baked.report.edge_mm = recipe.edge_mm;
    if (recipe.rod) {
        clock.begin("rod");
        organ.line = tube_line(std::get<TubeShape>(recipe.shape), kMm * recipe.edge_mm);
        make_anchors(recipe, organ);
        baked.report.skin_volume_m3 = volume_m3(skin);
        baked.report.mesh_volume_m3 = tissue::volume_m3(organ.line);
        clock.end();
        return baked;
    }
    organ.mesh =
        make_mesh(recipe, body_boundary(recipe, skin, clock), clock, options, baked.report);
    make_anchors(recipe, organ);
    baked.boundary = {organ.mesh.rest_m, tissue::boundary_triangles(organ.mesh)};
    clock.begin("distances");
    measure(skin, baked.boundary, organ.mesh, baked.report);
    add_response(recipe, options, clock, organ);
    clock.end();
    return baked;
}

} // namespace bake
