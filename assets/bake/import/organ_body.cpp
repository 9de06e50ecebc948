#include "assets/bake/import/organ_body.h"

#include "assets/bake/edge_for_nodes.h"
#include "assets/bake/import/boundary.h"
#include "assets/bake/import/distance.h"
#include "assets/bake/import/improve.h"
#include "assets/bake/import/size_field.h"
#include "assets/bake/import/skin.h"
#include "assets/bake/quadratic.h"
#include "tissue/response/mesh_term.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bake {
namespace {

constexpr double kSkinLeast = 1.0 / 3.0, kSkinMost = 0.6; // skin edge, of the tetrahedra's
constexpr double kSkinAway = 0.3;      // from the surface given, of the edge, that is aimed at
constexpr double kSkinPoints = 3000.0; // before grading; each has its own mesh term, and is drawn
constexpr double kMostVolumeChange = 0.01;
constexpr double kMostAway = 0.5; // Hausdorff distance, of the edge
constexpr double kAway = 0.4;     // of the boundary from the skin, of the edge, that is aimed at
constexpr double kReach = 0.25;   // of boundary nodes that are moved, of the edge
constexpr double kAskedDihedralDeg = 12.0; // of TetGen
constexpr double kMostNodesShare = 1.6, kMostGrowth = 1.4;
constexpr int kImproveSweeps = 6;

struct Solid {
    tissue::TetMesh mesh;
    Surface boundary;
    TetQuality quality;
    double volume_m3 = 0.0;
    double away_m = 0.0; // Hausdorff distance of the boundary from the surface given
};

/// Half the edge that was aimed at; where thin parts made edges shorter, half of what they are.
double most_away_m(const Solid& s, double edge_m) {
    return kMostAway * std::min(edge_m, s.quality.mean_edge_m);
}

/// What an imported organ must be; how far the worst of the three is off, 1: just good.
double shortfall(const Solid& s, double given_m3, double edge_m) {
    return std::max({kLeastDihedralDeg / std::max(s.quality.worst_dihedral_deg, 1e-3),
                     std::abs(s.volume_m3 / given_m3 - 1.0) / kMostVolumeChange,
                     s.away_m / most_away_m(s, edge_m)});
}

struct Shape {
    const Surface& seen; // of the file
    const Surface& skin;
    const NearestOnSurface& nearest;
    const Body& body;
    RemeshOptions keep;
    // Edges where the body is strongly curved: five around a slender end, whose section then bends
    // as the circle of its area to 2 %; that of four is 5 % too stiff, that of three 21 %.
    double radii_per_edge = 1.25;
};

/// One boundary, all attempts of TetGen; nothing if none succeeds.
std::optional<Solid> solid_of(const Surface& boundary, const Shape& shape, double edge_m,
                              const ImportOptions& options, PhaseClock& clock,
                              std::vector<TetAttempt>& attempts) {
    TetAnswer answer = tetrahedralise(boundary, {.edge_m = edge_m,
                                                 .quality_dihedral_deg = kAskedDihedralDeg,
                                                 .time_limit_s = options.time_limit_s,
                                                 .cavity_m = shape.body.cavity_m});
    for (auto& a : answer.attempts) {
        clock.say(fmt::format("  {}: {}, {:.2f} s", a.what, a.outcome, a.seconds));
        attempts.push_back(std::move(a));
    }
    if (!answer.mesh) {
        return {};
    }
    improve_inner_nodes(*answer.mesh, kImproveSweeps);
    improve_nodes(*answer.mesh, shape.nearest,
                  {.reach_m = kReach * std::min(edge_m, mean_edge_m(boundary)),
                   .volume_m3 = shape.body.volume_m3});
    Solid solid{.mesh = std::move(*answer.mesh), .boundary = {}, .quality = {}};
    solid.boundary = {solid.mesh.rest_m, tissue::boundary_triangles(solid.mesh)};
    solid.quality = tet_quality(solid.mesh);
    solid.volume_m3 = tissue::volume_m3(solid.mesh, solid.mesh.rest_m);
    solid.away_m = hausdorff(shape.seen, solid.boundary).distance_m;
    clock.say(fmt::format(
        "  {} nodes, {} tetrahedra, smallest dihedral {:.1f} degrees, volume "
        "{:+.2f} %, {:.2f} mm from the surface given",
        solid.mesh.rest_m.size(), solid.mesh.tets.size(), solid.quality.worst_dihedral_deg,
        100.0 * (solid.volume_m3 / shape.body.volume_m3 - 1.0), 1e3 * solid.away_m));
    return solid;
}

/// Grading may cost so many more nodes than even edges would; then edges grow, but not by more than
/// half. An edge that was asked for stays.
double bounded_edge_m(const Shape& shape, double edge_m, const ImportOptions& options) {
    if (options.edge_mm > 0.0) {
        return edge_m;
    }
    const double even =
        nodes_for(shape.skin, shape.body.volume_m3, [edge_m](const glm::dvec3&) { return edge_m; });
    double longer_m = edge_m;
    while (longer_m < kMostGrowth * edge_m &&
           nodes_for(shape.skin, shape.body.volume_m3,
                     shape_size(shape.skin, longer_m, shape.radii_per_edge, shape.keep)) >
               kMostNodesShare * even) {
        longer_m *= 1.1;
    }
    return longer_m;
}

/// Other edges are tried until angles, volume and distance are good enough.
Solid make_solid(const Shape& shape, const BodyPlan& plan, const ImportOptions& options,
                 const Notes& notes, PhaseClock& clock, ImportedBody& made) {
    Solid best;
    double least = std::numeric_limits<double>::max(); // shortfall of the best
    std::string problem;
    made.edge_m = bounded_edge_m(shape, made.edge_m, options);
    for (const double share : {1.0, 0.9, 0.8, 1.1, 0.7, 0.6}) {
        const double edge_m = share * made.edge_m;
        clock.begin(fmt::format("boundary {:.3g} mm", 1e3 * edge_m));
        const Boundary boundary = make_boundary(
            shape.skin, shape_size(shape.skin, edge_m, shape.radii_per_edge, shape.keep),
            {.edge_m = edge_m,
             .volume_m3 = shape.body.volume_m3,
             .farthest = kAway,
             .keep = shape.keep,
             .fine = options.fine},
            notes);
        if (!boundary.problem.empty()) {
            problem = boundary.problem;
            clock.say(fmt::format("  after {} tries: {}", boundary.tries, problem));
        }
        if (boundary.crossings > 0) {
            continue; // TetGen could only fail
        }
        clock.begin("tetrahedra");
        auto solid = solid_of(boundary.surface, shape, made.edge_m, options, clock, made.attempts);
        if (solid) {
            const double short_by = shortfall(*solid, shape.body.volume_m3, made.edge_m);
            if (short_by < least) {
                least = short_by;
                best = std::move(*solid);
            }
        }
        if (least <= 1.0) {
            return best;
        }
    }
    if (best.mesh.tets.empty()) {
        throw ImportRefused(fmt::format(
            "{}: no tetrahedra{}{}: accepted: a body that is nowhere thinner than "
            "about {} (--edge for finer, --rigid for scenery)",
            plan.name, problem.empty() ? "" : ": ", problem, notes.length(0.25 * made.edge_m)));
    }
    throw ImportRefused(fmt::format(
        "{}: after {} tries the best tetrahedra have a smallest dihedral angle of {:.1f} degrees, "
        "{:+.2f} % of the volume, and are {} from the surface given, at {}: accepted: {}, {:.0f} % "
        "and {} (--edge for finer, --rigid for scenery)",
        plan.name, made.attempts.size(), best.quality.worst_dihedral_deg,
        100.0 * (best.volume_m3 / shape.body.volume_m3 - 1.0), notes.length(best.away_m),
        notes.place(hausdorff(shape.seen, best.boundary).at_m), kLeastDihedralDeg,
        100.0 * kMostVolumeChange, notes.length(most_away_m(best, made.edge_m))));
}

/// The edge at which even triangles have kSkinPoints points, sqrt(3)/2 h^2 each, within limits.
double skin_edge_m(double area_m2, double edge_m) {
    return std::clamp(std::sqrt(area_m2 / (0.5 * std::sqrt(3.0) * kSkinPoints)),
                      kSkinLeast * edge_m, kSkinMost * edge_m);
}

/// make_mesh_terms calls a plain function; this is whom it tells.
PhaseClock* listener = nullptr;

void tell_share(double share) {
    static int said = 0; // tenths
    const int now = static_cast<int>(10.0 * share);
    said = std::min(said, now); // the next body begins again
    if (now > said && listener != nullptr) {
        said = now;
        listener->say(fmt::format("  mesh terms {} %", 10 * now));
    }
}

/// The organ floats: where it is held is the scene's to say, and what linear tetrahedra owe under a
/// tip is solved for again then. Until it is held, a weak bed stands in
/// (tissue/mesh/elastic_bed.h).
void add_response(ImportedBody& made, PhaseClock& clock) {
    tissue::BakedOrgan& organ = made.organ;
    organ.anchored.assign(organ.mesh.rest_m.size(), 0);
    clock.begin("footprints");
    const tissue::FootprintOptions footprint{.tip_radius_max_m = organ.tip_radius_max_m};
    tissue::make_footprints(organ.mesh, organ.anchored, footprint, organ.surface);
    clock.begin("mesh terms");
    listener = &clock;
    tissue::make_mesh_terms(organ.mesh, organ.material.poisson, organ.anchored, footprint,
                            organ.surface, tissue::weak_bed(organ.mesh), tell_share);
    listener = nullptr;
}

/// Never finer than the linear tetrahedra. A body that is too thin for coarse ones stays without.
void add_quadratic(const Shape& shape, const BodyPlan& plan, const ImportOptions& options,
                   const Notes& notes, PhaseClock& clock, ImportedBody& made) {
    ImportedBody coarse;
    coarse.edge_m = std::max(
        made.edge_m, edge_for_nodes(made.given_m3, area_m2(shape.body.surface), kQuadraticNodes));
    ImportOptions wider = options;
    wider.edge_mm = 0.0;
    for (FineSpot& spot : wider.fine) {
        spot.edge_mm *= coarse.edge_m / made.edge_m;
    }
    clock.begin(plan.name + ": coarser, for quadratic shapes");
    try {
        Solid solid = make_solid(shape, plan, wider, notes, clock, coarse);
        tissue::BakedOrgan organ = made.organ;
        organ.order = 2;
        organ.recipe_hash = (plan.hash ^ 2) * 0x100000001B3ULL; // one more word of FNV-1a
        organ.mesh = std::move(solid.mesh);
        tissue::check_mesh(organ.mesh);
        organ.anchored.assign(organ.mesh.rest_m.size(), 0);
        clock.begin("footprints");
        tissue::make_footprints(organ.mesh, organ.anchored,
                                {.order = 2, .tip_radius_max_m = organ.tip_radius_max_m},
                                organ.surface);
        made.quadratic = {.organ = std::move(organ),
                          .quality = solid.quality,
                          .edge_m = coarse.edge_m,
                          .volume_m3 = solid.volume_m3,
                          .boundary_distance_m = solid.away_m};
    } catch (const ImportRefused& e) {
        made.no_quadratic = fmt::format("no tetrahedra for quadratic shapes: {}", e.what());
    }
}

} // namespace

ImportedBody make_organ(const Body& body, const Surface& seen, const BodyPlan& plan,
                        const ImportOptions& options, const Notes& notes, PhaseClock& clock) {
    ImportedBody made;
    made.given = body.surface;
    made.given_m3 = body.volume_m3;
    made.skin_m = skin_edge_m(area_m2(body.surface), plan.edge_m);
    made.edge_m = options.rigid ? made.skin_m : plan.edge_m;
    tissue::BakedOrgan& organ = made.organ;
    organ.name = plan.name;
    organ.rigid = options.rigid;
    organ.recipe_hash = plan.hash;
    organ.material = options.material;

    clock.begin(plan.name + ": skin");
    const RemeshOptions keep = edges_to_keep(body.surface, made.skin_m);
    const Surface skin =
        make_skin(body.surface, made.skin_m, (options.rigid ? kAway : kSkinAway) * made.edge_m,
                  1 + body.cavity_m.size(), keep);
    organ.surface.rest_m = skin.point_m;
    organ.surface.triangles = skin.triangles;
    organ.surface.neighbours = tissue::triangle_neighbours(skin.triangles);
    made.skin_distance_m = hausdorff(seen, skin).distance_m;
    made.volume_m3 = volume_m3(skin);
    if (!options.rigid) {
        const NearestOnSurface nearest(skin);
        const Shape shape{
            .seen = seen, .skin = skin, .nearest = nearest, .body = body, .keep = keep};
        Solid solid = make_solid(shape, plan, options, notes, clock, made);
        made.quality = solid.quality;
        made.boundary = std::move(solid.boundary);
        made.volume_m3 = solid.volume_m3;
        made.boundary_distance_m = solid.away_m;
        organ.mesh = std::move(solid.mesh);
        tissue::check_mesh(organ.mesh);
        add_response(made, clock);
        Shape rounder = shape;
        rounder.radii_per_edge = kQuadraticRadiiPerEdge;
        add_quadratic(rounder, plan, options, notes, clock, made);
    }
    clock.end();
    if (made.skin_distance_m > kMostAway * made.edge_m) {
        throw ImportRefused(fmt::format(
            "{}: the skin is {} from the surface given at {}: accepted: half an edge, "
            "{} (--edge for finer)",
            plan.name, notes.length(made.skin_distance_m), notes.place(hausdorff(seen, skin).at_m),
            notes.length(kMostAway * made.edge_m)));
    }
    return made;
}

} // namespace bake
