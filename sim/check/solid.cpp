#include "sim/check/solid.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace sim {
namespace {

using glm::dvec3;
using tissue::BoundaryPoint;

bool is_closed(const std::vector<std::array<std::int32_t, 3>>& neighbours) {
    return std::all_of(neighbours.begin(), neighbours.end(), [](const auto& across) {
        return std::all_of(across.begin(), across.end(), [](int n) { return n >= 0; });
    });
}

Solid make_solid(const tissue::BakedOrgan& organ) {
    const tissue::ContactSurface& skin = organ.surface;
    Solid solid;
    solid.closed = is_closed(skin.neighbours);
    if (!solid.closed && !organ.rigid) {
        solid.skin = tissue::make_boundary_tree(organ.mesh);
        solid.closed = true;
    } else {
        solid.skin = tissue::make_surface_tree(skin.rest_m, skin.triangles);
    }
    solid.rim_vertex.assign(solid.skin.node_m.size(), 0);
    solid.rim_edges.assign(solid.skin.triangle.size(), 0);
    for (std::size_t t = 0; !solid.closed && t < skin.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (skin.neighbours[t][k] >= 0)
                continue;
            solid.rim_edges[t] = static_cast<std::uint8_t>(solid.rim_edges[t] | 1u << k);
            solid.rim_vertex[skin.triangles[t][(k + 1) % 3]] = 1;
            solid.rim_vertex[skin.triangles[t][(k + 2) % 3]] = 1;
        }
    }
    solid.low_m = solid.skin.box[0].low;
    solid.high_m = solid.skin.box[0].high;
    solid.sample_m = solid.skin.node_m;
    for (const tissue::Tet& tet : organ.mesh.tets) {
        const auto& x = organ.mesh.rest_m;
        solid.sample_m.push_back(0.25 * (x[tet[0]] + x[tet[1]] + x[tet[2]] + x[tet[3]]));
    }
    return solid;
}

// Odd number of hits on the way out. Three directions vote, for a line through an edge counts
// twice; none is along an axis or a diagonal of anything people draw.
bool inside_closed(const Solid& solid, const dvec3& p) {
    const std::array<dvec3, 3> ways{glm::normalize(dvec3{0.5377, 0.8339, -0.2588}),
                                    glm::normalize(dvec3{-0.3188, 0.4336, 0.9426}),
                                    glm::normalize(dvec3{0.7254, -0.6631, 0.2147})};
    const double far_m = 2.0 * glm::distance(solid.low_m, solid.high_m);
    return std::count_if(ways.begin(), ways.end(), [&](const dvec3& way) {
               return tissue::line_hits(solid.skin, p, way, 0.0, far_m).size() % 2 == 1;
           }) >= 2;
}

// Beyond a rim the nearest point is on it, and neither side is meant.
bool on_rim(const Solid& solid, const BoundaryPoint& at) {
    constexpr double kNone = 1e-9;
    std::size_t corners = 0, with = 0, without = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const bool counts = at.weight[static_cast<int>(k)] > kNone;
        corners += counts;
        (counts ? with : without) = k;
    }
    if (corners == 3)
        return false;
    if (corners == 2)
        return (solid.rim_edges[at.triangle] >> without & 1) != 0;
    return solid.rim_vertex[solid.skin.triangle[at.triangle][with]] != 0;
}

void deepest(const Solid& of, const Solid& in, Overlap& worst) {
    for (const dvec3& p : of.sample_m) {
        const double depth_m = depth_in_m(in, p);
        if (depth_m > worst.depth_m)
            worst = {depth_m, p};
    }
}

// First place of a segment within `radius_m` of a surface. The distance to a surface changes no
// faster than one moves, so steps of that length miss nothing.
std::optional<dvec3> first_near(const Solid& solid, const dvec3& from_m, const dvec3& to_m,
                                double radius_m) {
    constexpr double kLeastStep_m = 0.2e-3;
    const double length_m = glm::distance(from_m, to_m);
    const dvec3 along = (to_m - from_m) / std::max(length_m, 1e-12);
    for (double s = 0.0; s <= length_m;) {
        const dvec3 p = from_m + s * along;
        const double distance_m = tissue::nearest_point(solid.skin, p).distance_m;
        if (distance_m < radius_m)
            return p;
        s += std::max(kLeastStep_m, distance_m - radius_m);
    }
    return std::nullopt;
}

} // namespace

std::vector<Solid> make_solids(const LoadedScene& scene) {
    std::vector<Solid> solids;
    for (const auto& organ : scene.organ)
        solids.push_back(make_solid(*organ));
    return solids;
}

double depth_in_m(const Solid& solid, const dvec3& p) {
    if (solid.closed) {
        const bool outside_box =
            glm::clamp(p, solid.low_m, solid.high_m) != p; // most are, and it is cheap
        if (outside_box || !inside_closed(solid, p))
            return 0.0;
        return tissue::nearest_point(solid.skin, p).distance_m;
    }
    const BoundaryPoint at = tissue::nearest_point(solid.skin, p);
    const dvec3 away = p - tissue::position_m(solid.skin, at);
    if (on_rim(solid, at) || glm::dot(away, solid.skin.normal[at.triangle]) >= 0.0)
        return 0.0;
    return at.distance_m;
}

Overlap overlap_of(const Solid& a, const Solid& b) {
    Overlap worst;
    if (!a.closed && !b.closed)
        return worst; // sheets have no inside
    deepest(a, b, worst);
    deepest(b, a, worst);
    return worst;
}

Obstacle shaft_obstacle(std::span<const Solid> solids, const haptics::Trocar& trocar,
                        const dvec3& tip_m, int touched, int lifted) {
    const dvec3 way = tip_m - trocar.fulcrum_m;
    const double length_m = glm::length(way);
    if (length_m <= trocar.min_insertion_m)
        return {};
    const dvec3 from_m = trocar.fulcrum_m + way * (trocar.min_insertion_m / length_m);
    for (std::size_t b = 0; b < solids.size(); ++b) {
        if (static_cast<int>(b) == lifted)
            continue;
        if (static_cast<int>(b) == touched) {
            const auto hits = tissue::line_hits(solids[b].skin, from_m, way / length_m, 0.0,
                                                length_m - trocar.min_insertion_m);
            if (!hits.empty())
                return {static_cast<int>(b), tissue::position_m(solids[b].skin, hits.front())};
        } else if (const auto at = first_near(solids[b], from_m, tip_m, kShaftRadius_m)) {
            return {static_cast<int>(b), *at};
        }
    }
    return {};
}

Obstacle sight_obstacle(std::span<const Solid> solids, const dvec3& eye_m, const dvec3& place_m,
                        const dvec3& normal, int lifted) {
    constexpr double kOffSkin_m = 0.5e-3; // a marker stands out by this much
    const dvec3 seen_m = place_m + kOffSkin_m * normal;
    const double length_m = glm::distance(eye_m, seen_m);
    for (std::size_t b = 0; b < solids.size(); ++b) {
        if (static_cast<int>(b) == lifted)
            continue;
        const auto hits =
            tissue::line_hits(solids[b].skin, eye_m, (seen_m - eye_m) / length_m, 0.0, length_m);
        if (!hits.empty())
            return {static_cast<int>(b), tissue::position_m(solids[b].skin, hits.front())};
    }
    return {};
}

} // namespace sim
