#include "sim/bridge/body.h"

#include "sim/bridge/mesh_lean.h"
#include "tissue/response/boundary_tree.h"
#include "tissue/response/finite_sphere.h"
#include "tissue/response/footprint.h"
#include "tissue/response/subgrid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>

namespace sim {
namespace {

std::shared_ptr<const haptics::IndenterTable> make_table(const tissue::Material& material,
                                                         double tip_radius_m) {
    using Table = haptics::IndenterTable;
    const tissue::SphereLaw law = tissue::make_finite_sphere_law(
        tip_radius_m, material.young_pa, material.poisson, Table::kLevels, Table::kEntries);
    auto table = std::make_shared<Table>();
    table->force_scale_n = law.force_scale_n;
    table->x_step = law.x_step;
    for (int level = 0; level < Table::kLevels; ++level) {
        table->radius_over_thickness[level] = law.radius_over_thickness[level];
        table->punch_mpn[level] =
            tissue::punch_compliance_mpn(material.young_pa, material.poisson, tip_radius_m,
                                         tip_radius_m / law.radius_over_thickness[level]);
        std::copy_n(law.depth_over_x_m[level].begin(), Table::kEntries,
                    table->depth_over_x_m[level].begin());
        std::copy_n(law.contact_radius_m[level].begin(), Table::kEntries,
                    table->contact_radius_m[level].begin());
    }
    // tangential punch compliance times its radius: ratio * (1 - nu^2) / (2 E)
    table->tangential_m2pn =
        tissue::tangential_ratio(material.poisson) *
        tissue::punch_compliance_mpn(material.young_pa, material.poisson, tip_radius_m,
                                     std::numeric_limits<double>::infinity()) *
        tip_radius_m;
    return table;
}

// Linear part of the sub-grid law: what linear tetrahedra owe, less the kernel's own compliance,
// which the rows of the mesh already carry.
void fill_law(Body& body) {
    const tissue::ContactSurface& skin = body.organ->surface;
    const tissue::Material& m = body.material;
    const double ratio_t = tissue::tangential_ratio(m.poisson);
    for (std::size_t v = 0; v < skin.rest_m.size(); ++v) {
        const double thickness = skin.thickness_m[v];
        const double r = skin.footprint_radius_m[v];
        const double infinite = std::numeric_limits<double>::infinity();
        body.thinness_1pm[v] = 1.0 / thickness;
        if (tissue::is_rod(*body.organ))
            continue; // no kernel is in the rows
        body.normal_mpn[v] = skin.mesh_term_n_m[v] / m.young_pa -
                             tissue::kernel_compliance_mpn(m.young_pa, m.poisson, r, thickness);
        body.tangential_mpn[v] =
            skin.mesh_term_t_m[v] / m.young_pa -
            ratio_t * tissue::kernel_compliance_mpn(m.young_pa, m.poisson, r, infinite);
    }
}

void fill_tips(Body& body, const TipRadii& tip_radius_m) {
    for (std::size_t i = 0; i < tip_radius_m.size(); ++i) {
        const auto first = std::find(tip_radius_m.begin(), tip_radius_m.end(), tip_radius_m[i]);
        const auto same = static_cast<std::size_t>(first - tip_radius_m.begin());
        body.tip[i] = same < i
                          ? body.tip[same]
                          : TipLaw{make_table(body.material, tip_radius_m[i]), tip_radius_m[i]};
    }
}

// The skin of an organ as rigid scenery.
std::shared_ptr<const tissue::BakedOrgan> scenery_of(const tissue::BakedOrgan& organ) {
    auto rigid = std::make_shared<tissue::BakedOrgan>();
    rigid->name = organ.name;
    rigid->rigid = true;
    rigid->surface.rest_m = organ.surface.rest_m;
    rigid->surface.triangles = organ.surface.triangles;
    rigid->surface.neighbours = organ.surface.neighbours;
    rigid->material = organ.material;
    rigid->tip_radius_max_m = organ.tip_radius_max_m;
    return rigid;
}

// The same tetrahedra with quadratic shapes carry the skin by other rows and owe no mesh term.
std::shared_ptr<const tissue::BakedOrgan> quadratic_of(const tissue::BakedOrgan& organ) {
    auto quadratic = std::make_shared<tissue::BakedOrgan>(organ);
    quadratic->order = 2;
    tissue::make_footprints(quadratic->mesh, quadratic->anchored,
                            {.order = 2, .tip_radius_max_m = organ.tip_radius_max_m},
                            quadratic->surface);
    return quadratic;
}

// A rod carries the skin itself: every vertex is a point of it. Nothing of what yields under a tip
// is in the rod, so that all of it is the local law's, of a layer that lies on the axis, which the
// rod moves. tests/sim/tube_press_test.cpp has the reference solver beside it: the whole tube as
// the layer's thickness would be 15 % too soft.
std::shared_ptr<const tissue::BakedOrgan> rod_of(const tissue::BakedOrgan& organ) {
    auto rod = std::make_shared<tissue::BakedOrgan>(organ);
    tissue::ContactSurface& skin = rod->surface;
    const auto vertices = static_cast<std::uint32_t>(skin.rest_m.size());
    rod->anchored.assign(vertices, 0);
    for (std::uint32_t v = 0; v <= vertices; ++v)
        skin.row_start.push_back(v);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        std::size_t nearest = 0;
        for (std::size_t i = 1; i < organ.line.node_m.size(); ++i) {
            if (glm::distance(organ.line.node_m[i], skin.rest_m[v]) <
                glm::distance(organ.line.node_m[nearest], skin.rest_m[v]))
                nearest = i;
        }
        const double thick_m = organ.line.radius_m[nearest];
        skin.row_node.push_back(v);
        skin.row_weight.push_back(1.0);
        skin.offset_m.emplace_back(0.0);
        skin.frame_node.push_back({v, v, v});
        skin.footprint_radius_m.push_back(thick_m);
        skin.thickness_m.push_back(thick_m);
        skin.mesh_term_n_m.push_back(0.0);
        skin.mesh_term_t_m.push_back(0.0);
        skin.mesh_lean_m.emplace_back();
    }
    return rod;
}

std::shared_ptr<const tissue::BakedOrgan> for_tier(std::shared_ptr<const tissue::BakedOrgan> organ,
                                                   tissue::Tier tier) {
    if (organ->rigid)
        return organ;
    if (tier == tissue::Tier::rigid)
        return scenery_of(*organ);
    if (tissue::is_rod(*organ))
        return rod_of(*organ);
    if (tier == tissue::Tier::quadratic && organ->order == 1)
        return quadratic_of(*organ);
    if (tier != tissue::Tier::quadratic && organ->order != 1)
        throw std::invalid_argument("organ " + organ->name + " was baked for quadratic shapes");
    return organ;
}

double mixed(const std::vector<double>& values, const tissue::Triangle& t,
             const glm::dvec3& w) noexcept {
    return w.x * values[t[0]] + w.y * values[t[1]] + w.z * values[t[2]];
}

glm::dvec3 mixed(const std::vector<glm::dvec3>& values, const tissue::Triangle& t,
                 const glm::dvec3& w) noexcept {
    return w.x * values[t[0]] + w.y * values[t[1]] + w.z * values[t[2]];
}

} // namespace

Body make_body(std::shared_ptr<const tissue::BakedOrgan> organ, const tissue::Material& material,
               const TipRadii& tip_radius_m, double dt_s, tissue::Tier tier) {
    Body body;
    body.organ = for_tier(std::move(organ), tier);
    body.material = material;
    const tissue::ContactSurface& skin = body.organ->surface;
    const std::size_t vertices = skin.rest_m.size();
    body.skin_m = skin.rest_m;
    body.skin_normal.resize(vertices);
    for (const tissue::Triangle& t : skin.triangles)
        for (int k = 0; k < 3; ++k)
            body.longest_edge_m = std::max(
                body.longest_edge_m, glm::distance(skin.rest_m[t[k]], skin.rest_m[t[(k + 1) % 3]]));
    body.thinness_1pm.assign(vertices, 0.0);
    body.normal_mpn.assign(vertices, 0.0);
    body.tangential_mpn.assign(vertices, 0.0);
    if (body.organ->rigid) {
        tissue::place_surface(skin, {}, {}, body.skin_m, body.skin_normal);
        return body;
    }
    fill_tips(body, tip_radius_m);
    fill_law(body);
    body.lean_mpn = rest_lean(body);
    tissue::Solid solid =
        tissue::make_solid(tier,
                           {.mesh = body.organ->mesh,
                            .anchored = body.organ->anchored,
                            .bed = body.organ->bed,
                            .line = tissue::is_rod(*body.organ) ? &body.organ->line : nullptr,
                            .skin_m = skin.rest_m},
                           material, glm::dvec3{0.0}, dt_s);
    const int unknowns = tissue::unknowns(solid);
    const auto n = static_cast<std::size_t>(unknowns);
    tissue::SkinFrames frame = tissue::make_skin_frames(skin, tissue::rest_m(solid));
    const std::vector<double> rows(n * 3 * haptics::kTools), unknown(n);
    body.soft.emplace(SoftBody{.solid = std::move(solid),
                               .basis = tissue::make_contact_basis(unknowns),
                               .skin_frame = std::move(frame),
                               .shape_by_unknown = std::vector<double>(n * tissue::kMaxBasis),
                               .motion_m = unknown,
                               .rows = rows,
                               .answer_m = rows,
                               .load_n = unknown,
                               .drift_m = unknown});
    tissue::place_surface(skin, body.soft->skin_frame, tissue::position_m(body.soft->solid),
                          body.skin_m, body.skin_normal);
    return body;
}

haptics::LocalLaw law_on(const Body& body, const haptics::SurfacePoint& at, int tool,
                         double floor_mpn) noexcept {
    const tissue::Triangle& t = body.organ->surface.triangles[at.triangle];
    const TipLaw& tip = body.tip[tool];
    return {.table = tip.table.get(),
            .radius_over_thickness = tip.radius_m * mixed(body.thinness_1pm, t, at.weight),
            .normal_mpn = mixed(body.normal_mpn, t, at.weight),
            .tangential_mpn = mixed(body.tangential_mpn, t, at.weight),
            .floor_mpn = floor_mpn};
}

glm::dvec3 place_on(const Body& body, const haptics::SurfacePoint& at) noexcept {
    return mixed(body.skin_m, body.organ->surface.triangles[at.triangle], at.weight);
}

glm::dvec3 normal_on(const Body& body, const haptics::SurfacePoint& at) noexcept {
    return glm::normalize(
        mixed(body.skin_normal, body.organ->surface.triangles[at.triangle], at.weight));
}

Foot nearest_on(const Body& body, const glm::dvec3& from_m, double within_m) noexcept {
    double nearest2 = std::numeric_limits<double>::max(); // of the vertices, then of triangles
    for (const glm::dvec3& v : body.skin_m) {
        const glm::dvec3 d = v - from_m;
        nearest2 = std::min(nearest2, glm::dot(d, d));
    }
    // a triangle so near has its corners within an edge of there
    constexpr double kStretched = 1.5;
    const double edge_m = kStretched * body.longest_edge_m, vertex_m = std::sqrt(nearest2);
    if (vertex_m - edge_m > within_m)
        return {.at = {0, {1.0, 0.0, 0.0}}, .distance_m = vertex_m};
    const double near_m = std::min(vertex_m, within_m) + edge_m;
    const std::vector<tissue::Triangle>& triangles = body.organ->surface.triangles;
    Foot foot{.at = {0, {1.0, 0.0, 0.0}}}; // of a place that is not a number
    nearest2 = std::numeric_limits<double>::max();
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const glm::dvec3& a = body.skin_m[triangles[t][0]];
        const glm::dvec3 first = a - from_m;
        if (glm::dot(first, first) > near_m * near_m)
            continue;
        const glm::dvec3 &b = body.skin_m[triangles[t][1]], &c = body.skin_m[triangles[t][2]];
        const glm::dvec3 w = tissue::closest_weight(a, b, c, from_m);
        const glm::dvec3 d = w.x * a + w.y * b + w.z * c - from_m;
        if (glm::dot(d, d) < nearest2) {
            nearest2 = glm::dot(d, d);
            foot.at = {static_cast<int>(t), w};
        }
    }
    foot.distance_m = std::sqrt(nearest2);
    return foot;
}

} // namespace sim
