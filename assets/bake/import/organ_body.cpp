#include "assets/bake/import/organ_body.h"

#include "assets/bake/import/boundary.h"
#include "assets/bake/import/distance.h"
#include "assets/bake/import/size_field.h"
#include "assets/bake/remesh.h"
#include "tissue/response/mesh_term.h"

#include <algorithm>

namespace bake {
namespace {

constexpr double kSkinPerEdge = 1.0 / 3.0; // skin edge, of the tetrahedra's
constexpr double kDense = 0.5;             // mean edge of a scan over the skin's: coarsened first
constexpr double kSkinRadiiPerEdge = 0.9, kSkinShare = 0.5;
constexpr double kSkinAway = 0.3; // from the surface given, of the skin's edge
constexpr int kSkinTries = 4;
constexpr std::size_t kMostSpots = 300;
constexpr double kMostAway = 0.5; // Hausdorff distance, of the edge
constexpr int kImproveSweeps = 6;

/// Where tissue is held. To be replaced when an organ may float: then nothing is held.
std::vector<std::uint8_t> hold(const tissue::TetMesh& mesh) {
    double low = mesh.rest_m[0].z, high = low;
    for (const auto& p : mesh.rest_m) {
        low = std::min(low, p.z);
        high = std::max(high, p.z);
    }
    std::vector<std::uint8_t> held;
    for (const auto& p : mesh.rest_m) {
        held.push_back(p.z < 0.5 * (low + high) ? 1 : 0);
    }
    return held;
}

double mean_edge_m(const Surface& s) {
    const double each_m2 = area_m2(s) / static_cast<double>(s.triangles.size());
    return std::sqrt(each_m2 * 4.0 / std::sqrt(3.0)); // of equilateral triangles
}

/// Finer again where it keeps away from the surface given: tips and edges wear off in remeshing.
Surface make_skin(const Surface& given, double skin_m) {
    const Surface shape =
        mean_edge_m(given) < kDense * skin_m ? coarsen(given, kDense * skin_m) : given;
    const Surface even =
        remesh(shape, [skin_m](const glm::dvec3&) { return skin_m; }, {.rounds = 5});
    const SizeAt by_shape = curvature_size(even, skin_m, kSkinRadiiPerEdge, kSkinShare);
    std::vector<FineSpot> spots;
    for (int tries = 0;; ++tries) {
        const SizeAt size = with_spots(by_shape, spots);
        Surface skin = remesh(shape, size, {});
        std::vector<glm::dvec3> places;
        add_far_places(given, skin, kSkinAway * skin_m, places);
        if (places.empty() || tries == kSkinTries || places.size() > kMostSpots) {
            return skin;
        }
        add_spots(places, size, spots);
    }
}

void require_good(const Surface& s, std::size_t shells, const char* what) {
    SurfaceProblems problems = check_surface(s);
    problems.shells = problems.shells == static_cast<int>(shells) ? 1 : problems.shells;
    const auto lines = describe(problems);
    if (!lines.empty()) {
        throw ImportRefused(fmt::format("{}: {}", what, lines.front()));
    }
}

struct Solid {
    tissue::TetMesh mesh;
    TetQuality quality;
};

/// One boundary, all attempts of TetGen; nothing if none succeeds.
std::optional<Solid> solid_of(const Surface& boundary, const Body& body, double edge_m,
                              const ImportOptions& options, PhaseClock& clock,
                              std::vector<TetAttempt>& attempts) {
    TetAnswer answer = tetrahedralise(boundary, {.edge_m = edge_m,
                                                 .quality_dihedral_deg = 12.0,
                                                 .time_limit_s = options.time_limit_s,
                                                 .cavity_m = body.cavity_m});
    for (auto& a : answer.attempts) {
        clock.say(fmt::format("  {}: {}, {:.2f} s", a.what, a.outcome, a.seconds));
        attempts.push_back(std::move(a));
    }
    if (!answer.mesh) {
        return {};
    }
    improve_inner_nodes(*answer.mesh, kImproveSweeps);
    const TetQuality quality = tet_quality(*answer.mesh);
    clock.say(fmt::format("  {} nodes, {} tetrahedra, smallest dihedral {:.1f} degrees",
                          answer.mesh->rest_m.size(), answer.mesh->tets.size(),
                          quality.worst_dihedral_deg));
    return Solid{std::move(*answer.mesh), quality};
}

/// Other edges are tried until the smallest dihedral is large enough; the best is taken.
Solid make_solid(const Surface& skin, const Body& body, const BodyPlan& plan,
                 const ImportOptions& options, const Notes& notes, PhaseClock& clock,
                 ImportedBody& made) {
    std::optional<Solid> best;
    std::string problem;
    for (const double share : {1.0, 0.9, 0.8, 1.1, 0.7}) {
        clock.begin(fmt::format("boundary {:.3g} mm", 1e3 * share * plan.edge_m));
        const Boundary boundary = make_boundary(skin,
                                                {.edge_m = share * plan.edge_m,
                                                 .volume_m3 = body.volume_m3,
                                                 .farthest_m = 0.8 * kMostAway * plan.edge_m,
                                                 .fine = options.fine},
                                                notes);
        if (!boundary.problem.empty()) {
            problem = boundary.problem;
            clock.say(fmt::format("  after {} tries: {}", boundary.tries, problem));
        }
        clock.begin("tetrahedra");
        auto solid = solid_of(boundary.surface, body, plan.edge_m, options, clock, made.attempts);
        if (solid &&
            (!best || solid->quality.worst_dihedral_deg > best->quality.worst_dihedral_deg)) {
            best = std::move(solid);
        }
        if (best && best->quality.worst_dihedral_deg >= kLeastDihedralDeg) {
            return std::move(*best);
        }
    }
    if (!best) {
        throw ImportRefused(fmt::format(
            "{}: no tetrahedra{}{}: accepted: a body that is nowhere thinner than about {} (--edge "
            "for finer, --rigid for scenery)",
            plan.name, problem.empty() ? "" : ": ", problem, notes.length(0.25 * plan.edge_m)));
    }
    throw ImportRefused(fmt::format(
        "{}: the smallest dihedral angle stays at {:.1f} degrees: accepted: {} (--edge for finer, "
        "--rigid for scenery)",
        plan.name, best->quality.worst_dihedral_deg, kLeastDihedralDeg));
}

void add_response(ImportedBody& made, PhaseClock& clock) {
    tissue::BakedOrgan& organ = made.organ;
    organ.anchored = hold(organ.mesh);
    clock.begin("footprints");
    const tissue::FootprintOptions footprint{.tip_radius_max_m = organ.tip_radius_max_m};
    tissue::make_footprints(organ.mesh, organ.anchored, footprint, organ.surface);
    clock.begin("mesh terms");
    tissue::make_mesh_terms(organ.mesh, organ.material.poisson, organ.anchored, footprint,
                            organ.surface);
}

} // namespace

ImportedBody make_organ(const Body& body, const Surface& seen, const BodyPlan& plan,
                        const ImportOptions& options, const Notes& notes, PhaseClock& clock) {
    ImportedBody made;
    made.given = body.surface;
    made.given_m3 = body.volume_m3;
    made.edge_m = plan.edge_m;
    made.skin_m = kSkinPerEdge * plan.edge_m;
    tissue::BakedOrgan& organ = made.organ;
    organ.name = plan.name;
    organ.rigid = options.rigid;
    organ.recipe_hash = plan.hash;
    organ.material = options.material;

    clock.begin(plan.name + ": skin");
    const Surface skin = make_skin(body.surface, made.skin_m);
    require_good(skin, 1 + body.cavity_m.size(), "the skin");
    organ.surface.rest_m = skin.point_m;
    organ.surface.triangles = skin.triangles;
    organ.surface.neighbours = tissue::triangle_neighbours(skin.triangles);
    made.skin_distance_m = hausdorff(seen, skin).distance_m;
    made.volume_m3 = volume_m3(skin);
    if (!options.rigid) {
        Solid solid = make_solid(skin, body, plan, options, notes, clock, made);
        organ.mesh = std::move(solid.mesh);
        made.quality = solid.quality;
        tissue::check_mesh(organ.mesh);
        made.boundary = {organ.mesh.rest_m, tissue::boundary_triangles(organ.mesh)};
        made.volume_m3 = tissue::volume_m3(organ.mesh, organ.mesh.rest_m);
        clock.begin("distances");
        made.boundary_distance_m = hausdorff(seen, made.boundary).distance_m;
        add_response(made, clock);
    }
    clock.end();
    const double away_m = std::max(made.skin_distance_m, made.boundary_distance_m);
    if (away_m > kMostAway * plan.edge_m) {
        const Far far =
            hausdorff(seen, made.boundary_distance_m > made.skin_distance_m ? made.boundary : skin);
        throw ImportRefused(fmt::format("{}: the result is {} from the surface given at {}: "
                                        "accepted: half an edge, {} (--edge for finer)",
                                        plan.name, notes.length(away_m), notes.place(far.at_m),
                                        notes.length(kMostAway * plan.edge_m)));
    }
    return made;
}

} // namespace bake
