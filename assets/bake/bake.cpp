#include "assets/bake/bake.h"

#include "assets/bake/anchors.h"
#include "assets/bake/fit.h"
#include "assets/bake/local_terms.h"
#include "assets/bake/nearest.h"
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
constexpr double kRadiiPerEdge = 1.8;  // boundary edges where the body is strongly curved
constexpr double kShortestShare = 0.6; // and the shortest of them, of the edge
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

struct Surfaces {
    Surface skin, boundary;
};

Surfaces liver_surfaces(const Recipe& recipe, const LobedShape& shape, PhaseClock& clock) {
    clock.begin("skin");
    const double skin_m = kMm * recipe.skin_mm, edge_m = kMm * recipe.edge_mm;
    const auto bounds = lobed_bounds_m(shape);
    const Surface raw = polygonise(lobed_field(shape), bounds[0], bounds[1], kCellPerSkin * skin_m);
    require_good(raw, "the body of the recipe");
    Surfaces s{.skin = remesh(raw, even(skin_m), {}), .boundary = {}};
    require_good(s.skin, "the skin");

    clock.begin("boundary");
    const SizeAt size =
        with_spots(curvature_size(s.skin, edge_m, kRadiiPerEdge, kShortestShare), recipe.fine);
    s.boundary = remesh(s.skin, size, {});
    fit_to_skin(s.skin, kFitRounds, 180.0, s.boundary);
    require_good(s.boundary, "the boundary of the tetrahedra");
    return s;
}

Surfaces box_surfaces(const Recipe& recipe, const BoxShape& shape, PhaseClock& clock) {
    clock.begin("skin");
    const glm::dvec3 size_m = kMm * shape.size_mm;
    const double skin_m = kMm * recipe.skin_mm, edge_m = kMm * recipe.edge_mm;
    Surfaces s{.skin =
                   shape.skin_on_top_only ? box_top(size_m, skin_m) : box_surface(size_m, skin_m),
               .boundary = {}};
    if (!shape.cells) {
        clock.begin("boundary");
        const Surface start = box_surface(size_m, edge_m);
        s.boundary =
            remesh(start, with_spots(even(edge_m), recipe.fine), {.crease_deg = kBoxCreaseDeg});
        require_good(s.boundary, "the boundary of the tetrahedra");
    }
    return s;
}

Surface scenery_surface(const Recipe& recipe) {
    const double skin_m = kMm * recipe.skin_mm;
    const auto* vault = std::get_if<VaultShape>(&recipe.shape);
    return vault != nullptr ? vault_surface(*vault, skin_m)
                            : ground_surface(std::get<GroundShape>(recipe.shape), skin_m);
}

// Without a boundary if the tetrahedra are made with the shape, not from it.
Surfaces body_surfaces(const Recipe& recipe, PhaseClock& clock) {
    if (const auto* lobed = std::get_if<LobedShape>(&recipe.shape)) {
        return liver_surfaces(recipe, *lobed, clock);
    }
    if (const auto* box = std::get_if<BoxShape>(&recipe.shape)) {
        return box_surfaces(recipe, *box, clock);
    }
    clock.begin("skin");
    const double skin_m = kMm * recipe.skin_mm;
    const auto* sheet = std::get_if<SheetShape>(&recipe.shape);
    Surfaces s{.skin = sheet != nullptr ? sheet_surface(*sheet, skin_m)
                                        : tube_surface(std::get<TubeShape>(recipe.shape), skin_m),
               .boundary = {}};
    require_good(s.skin, "the skin");
    return s;
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

void measure(const Surfaces& s, const tissue::TetMesh& mesh, BakeReport& report) {
    const Surface boundary{mesh.rest_m, tissue::boundary_triangles(mesh)};
    const NearestOnSurface to_mesh(boundary), to_skin(s.skin);
    report.quality = tet_quality(mesh);
    report.mesh_volume_m3 = tissue::volume_m3(mesh, mesh.rest_m);
    report.skin_to_mesh_m = sampled_hausdorff_m(s.skin, to_mesh);
    if (check_surface(s.skin).open_edges == 0) { // an open skin covers only part of the mesh
        report.skin_volume_m3 = volume_m3(s.skin);
        report.mesh_to_skin_m = sampled_hausdorff_m(boundary, to_skin);
    }
}

/// FNV-1a over what decides the organ: text, overridden sizes, version of this program.
std::uint64_t recipe_hash(const Recipe& recipe) {
    std::uint64_t hash = recipe.text_hash;
    for (const std::uint64_t word : {kBakeVersion, std::bit_cast<std::uint64_t>(recipe.edge_mm),
                                     std::bit_cast<std::uint64_t>(recipe.skin_mm)}) {
        for (int byte = 0; byte < 8; ++byte) {
            hash = (hash ^ (word >> (8 * byte) & 0xFF)) * 0x100000001B3ULL;
        }
    }
    return hash;
}

} // namespace

Baked bake(const Recipe& recipe, const BakeOptions& options) {
    Baked baked;
    PhaseClock clock(options, baked.report);
    tissue::BakedOrgan& organ = baked.organ;
    organ.name = recipe.name;
    organ.material = recipe.material;
    organ.tip_radius_max_m = kMm * recipe.tip_radius_max_mm;
    organ.recipe_hash = recipe_hash(recipe);

    if (is_rigid(recipe.kind)) {
        clock.begin("skin");
        const Surface skin = scenery_surface(recipe);
        organ.rigid = true;
        organ.surface.rest_m = skin.point_m;
        organ.surface.triangles = skin.triangles;
        organ.surface.neighbours = tissue::triangle_neighbours(skin.triangles);
        clock.end();
        return baked;
    }

    const Surfaces surfaces = body_surfaces(recipe, clock);
    organ.mesh = make_mesh(recipe, surfaces.boundary, clock, options, baked.report);
    make_anchors(recipe, organ);
    baked.boundary = {organ.mesh.rest_m, tissue::boundary_triangles(organ.mesh)};

    clock.begin("distances");
    measure(surfaces, organ.mesh, baked.report);

    clock.begin("footprints");
    organ.surface.rest_m = surfaces.skin.point_m;
    organ.surface.triangles = surfaces.skin.triangles;
    organ.surface.neighbours = tissue::triangle_neighbours(surfaces.skin.triangles);
    const tissue::FootprintOptions footprint{.tip_radius_max_m = organ.tip_radius_max_m};
    tissue::make_footprints(organ.mesh, organ.anchored, footprint, organ.surface);
    clock.begin("mesh terms");
    tissue::make_mesh_terms(organ.mesh, organ.material.poisson, organ.anchored, footprint,
                            organ.surface, organ.bed, options.mesh_term_progress);
    if (is_slender(recipe.kind) || recipe.local_terms) {
        keep_terms_local(organ.material.poisson, organ.surface);
    }
    clock.end();
    return baked;
}

} // namespace bake
