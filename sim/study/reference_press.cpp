#include "sim/study/reference_press.h"

#include "tissue/mesh/refine.h"
#include "tissue/reference/indenter.h"
#include "tissue/reference/onto_skin.h"
#include "tissue/response/boundary_tree.h"

#include <algorithm>
#include <ctime>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace sim {
namespace {

using glm::dvec3;

constexpr double kTolerance = 1e-5; // of Newton's relative residual: forces to 1e-4
constexpr int kProducts = 30;       // cost about as much as a factor of 100 000 unknowns
constexpr double kGrowth = 1.0;     // of edges per distance
constexpr double kOff = 0.1;        // tip radii that a facet may stay off the skin
constexpr int kCoarsest = 16;       // times the edges: the first of refinements laid on the skin
constexpr double kWhole = 3.0;      // tip radii within which facets lie on the skin: all it touches

std::vector<std::uint8_t> held_flags(const tissue::QuadraticMesh& mesh,
                                     const tissue::RefinedMesh& fine) {
    std::vector<std::uint8_t> held(mesh.rest_m.size(), 0);
    for (std::size_t i = 0; i < fine.anchored.size(); ++i)
        held[i] = fine.anchored[i] ? tissue::kHeld : 0;
    for (const tissue::Tet10& t : mesh.tets) {
        for (std::size_t k = 0; k < tissue::kEdge.size(); ++k) {
            const auto [a, b] = tissue::kEdge[k];
            held[t[4 + k]] = held[t[a]] & held[t[b]];
        }
    }
    return held;
}

// Coarser refinements first, each laid on the skin, so that no facet moves by much of its edge. The
// place goes there too.
tissue::RefinedMesh refined_at(const tissue::BakedOrgan& organ, const ReferencePressOptions& o,
                               const dvec3& near_m, const dvec3& into, dvec3& place_m) {
    tissue::RefineSize size{.edge_m = o.edge_share * o.radius_m,
                            .core_m = o.core_share * o.radius_m,
                            .growth = kGrowth,
                            .down_m = o.down_share * o.depth_m.back() * into};
    if (!o.onto_skin)
        return tissue::refined(organ.mesh, organ.anchored, organ.bed, place_m, size);
    const tissue::SmoothSkin skin = tissue::make_smooth_skin(organ.surface);
    place_m = tissue::on_smooth_skin(skin, near_m);
    tissue::RefinedMesh fine{organ.mesh, organ.anchored, organ.bed};
    size.edge_m *= kCoarsest;
    double off_m = 0.0;
    for (int coarser = kCoarsest; coarser >= 1; coarser /= 2, size.edge_m /= 2) {
        fine = tissue::refined(fine.mesh, fine.anchored, fine.bed, place_m, size);
        off_m = tissue::lay_onto_skin(skin, place_m, kWhole * o.radius_m, fine.mesh);
    }
    if (off_m > kOff * o.radius_m) {
        throw std::invalid_argument(fmt::format(
            "reference press: a facet of '{}' stays {:.2f} mm off its skin, where {:.2f} are "
            "allowed: want the organ in smaller tetrahedra",
            organ.name, 1e3 * off_m, 1e3 * kOff * o.radius_m));
    }
    return fine;
}

std::string why_stopped(const tissue::PressReport& report) {
    const tissue::NewtonReport& n = report.failed;
    return fmt::format("at {:.2f} mm: residual {:.0e} after {} solves, tangent indefinite in {}, "
                       "least det F {:.2f}",
                       1e3 * report.failed_at_m, n.relative_residual, n.iterations, n.projected,
                       n.min_det_f);
}

} // namespace

ReferencePress press_reference(const tissue::BakedOrgan& organ, const tissue::Material& material,
                               const dvec3& place_m, const dvec3& into,
                               const ReferencePressOptions& o,
                               const std::function<void(double, double)>& progress) {
    if (tissue::is_rod(organ))
        throw std::invalid_argument("reference press: '" + organ.name +
                                    "' is a rod and has no tetrahedra");
    const bool fixed = std::count(organ.anchored.begin(), organ.anchored.end(), 1) >= 3;
    if (organ.rigid || (organ.bed.empty() && !fixed))
        throw std::invalid_argument("reference press: nothing holds the organ '" + organ.name +
                                    "'");
    if (o.depth_m.empty())
        throw std::invalid_argument("reference press: want at least one depth");
    const std::clock_t began = std::clock();
    const tissue::BoundaryTree facets = tissue::make_boundary_tree(organ.mesh);
    tissue::Press press{.place_m =
                            tissue::position_m(facets, tissue::nearest_point(facets, place_m)),
                        .into = into,
                        .radius_m = o.radius_m,
                        .depth_m = o.depth_m,
                        .friction = o.friction,
                        .step_m = o.step_share * o.radius_m};
    press.newton = {
        .tolerance = kTolerance, .max_iterations = 20, .max_halvings = 0, .products = kProducts};
    press.step_halvings = 2;
    const tissue::RefinedMesh fine = refined_at(organ, o, place_m, into, press.place_m);
    const tissue::QuadraticMesh mesh = tissue::quadratic_mesh(fine.mesh);
    press.place_m += tissue::touch_depth_m(mesh, press) * into;

    const tissue::ReferenceModel model = tissue::make_reference(
        mesh, material, tissue::Law::neo_hooke, held_flags(mesh, fine), dvec3{0.0}, fine.bed);
    tissue::ReferenceSystem system = tissue::make_system(model);
    tissue::ReferenceState state = tissue::rest_state(model);
    const tissue::PressReport report =
        tissue::press(model, press, system, state, [&](const tissue::PressPoint& p) {
            if (progress)
                progress(p.depth_m, glm::length(p.force_n));
        });

    ReferencePress out{.reached_m = report.reached_m,
                       .nodes = static_cast<int>(mesh.rest_m.size()),
                       .tets = static_cast<int>(mesh.tets.size()),
                       .iterations = report.iterations};
    if (report.failed_at_m > 0.0)
        out.stopped = why_stopped(report);
    for (const tissue::PressPoint& p : report.point) {
        out.force_n.push_back(p.force_n);
        out.penetration_m = std::max(out.penetration_m, p.penetration_m);
        out.least_det_f = p.min_det_f;
    }
    out.cpu_s = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
    return out;
}

} // namespace sim
