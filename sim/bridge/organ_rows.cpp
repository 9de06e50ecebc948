#include "sim/bridge/organ_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace sim {
namespace {

using glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFlat_m = 0.1e-3;  // depth at a pressure of E
constexpr double kNear_m = 0.5e-3;  // a row is there before it pushes
constexpr double kFaster = 1.5;     // than in the last step
constexpr double kSeek_m = 10e-3;   // how far nearest skin is looked for
constexpr double kDeepest_m = 6e-3; // how deep a vertex may be found
constexpr double kBeside_m = 1.5e-3;
constexpr double kFromFacing = 0.1, kToFacing = 0.4; // cosines: counts from there, fully

double smooth(double from, double to, double x) noexcept {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

std::vector<double> vertex_areas(const Body& body) {
    std::vector<double> area(body.skin_m.size());
    for (const tissue::Triangle& t : body.organ->surface.triangles) {
        const double third = glm::length(glm::cross(body.skin_m[t[1]] - body.skin_m[t[0]],
                                                    body.skin_m[t[2]] - body.skin_m[t[0]])) /
                             6.0;
        for (const std::uint32_t v : t)
            area[v] += third;
    }
    return area;
}

// Half of the way through the body from each vertex: from beyond it, skin that faces is another's.
std::vector<double> depths(const Body& body, const SkinTree& skin) {
    std::vector<double> deep(body.skin_m.size(), kDeepest_m);
    constexpr double kOff_m = 1e-6;
    for (std::size_t v = 0; v < deep.size(); ++v) {
        const dvec3 &x = body.skin_m[v], in = -body.skin_normal[v];
        const haptics::SurfaceHit hit = haptics::cast_segment(
            skin.tree, view_of(body), x + kOff_m * in, x + 2.0 * kDeepest_m * in);
        if (hit.hit())
            deep[v] = std::min(kDeepest_m, 0.5 * hit.distance_m);
    }
    return deep;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double v : values)
        sum += v;
    return sum / static_cast<double>(values.size());
}

// Where the vertex is in the other body at rest, the least gap at which it may push.
double rest_zero_m(const Body& other, const SkinTree& skin, const dvec3& place_m,
                   const dvec3& outward, double deep_m) {
    constexpr double kFar_m = 30e-3;
    const haptics::SurfaceHit near =
        haptics::closest_within(skin.tree, view_of(other), place_m, kFar_m);
    if (!near.hit())
        return 0.0;
    const haptics::SurfacePoint at{static_cast<int>(near.triangle), near.weight};
    const double gap_m = glm::dot(place_m - near.place_m, normal_on(other, at));
    if (gap_m < 0.0 && near.distance_m > std::min(kBuried_m, deep_m))
        return -kInfinity;
    const FacedSkin faced = skin_facing(other, skin, place_m, outward, deep_m);
    return faced.found ? std::min(0.0, faced.gap_m) : 0.0;
}

SkinPair make_pair(std::span<const Body> bodies, const OrganRows& rows, std::size_t a,
                   std::size_t b) {
    const Body &own = bodies[a], &other = bodies[b];
    const double young_pa = own.soft && other.soft
                                ? std::min(own.material.young_pa, other.material.young_pa)
                                : (own.soft ? own : other).material.young_pa;
    SkinPair pair;
    pair.vertex_of = static_cast<std::int32_t>(a);
    pair.skin_of = static_cast<std::int32_t>(b);
    pair.pressure_npm3 = young_pa / kFlat_m;
    pair.most_area_m2 = 4.0 * (own.soft ? mean_of(rows.area_m2[a]) : mean_of(rows.area_m2[b]));
    const std::size_t n = own.skin_m.size();
    pair.force_n.assign(n, 0.0);
    pair.clear_m.assign(n, 0.0);
    pair.clear_way_m.assign(n, 0.0);
    pair.clear_at_m = own.skin_m;
    for (std::size_t v = 0; v < n; ++v) {
        pair.zero_m.push_back(
            rest_zero_m(other, rows.skin[b], own.skin_m[v], own.skin_normal[v], rows.deep_m[a][v]));
        if (pair.zero_m[v] == -kInfinity)
            pair.clear_m[v] = kInfinity;
    }
    return pair;
}

bool is_still(const Body& body) noexcept {
    return !body.soft || body.soft->resting;
}

bool apart(const SkinTree& a, const SkinTree& b, double reach_m) noexcept {
    for (int k = 0; k < 3; ++k) {
        if (a.low_m[k] - b.high_m[k] > reach_m || b.low_m[k] - a.high_m[k] > reach_m)
            return true;
    }
    return false;
}

void find_turns(std::span<const Body> bodies, OrganRow& row) noexcept {
    const auto turn = [&](const Body& body, std::uint32_t v) {
        return tissue::skin_turn(body.organ->surface, tissue::position_m(body.soft->solid), v,
                                 body.skin_m[v], row.normal);
    };
    const Body &own = bodies[row.vertex_of], &other = bodies[row.skin_of];
    if (own.soft)
        row.own_turn = turn(own, row.vertex);
    if (!other.soft)
        return;
    for (int k = 0; k < 3; ++k)
        row.at_turn[k] = turn(other, other.organ->surface.triangles[row.at.triangle][k]);
}

// The row of one vertex, if it has one.
bool look(std::span<const Body> bodies, const OrganRows& rows, SkinPair& pair, std::uint32_t v,
          double reach_m, OrganRow& row) noexcept {
    const Body &own = bodies[pair.vertex_of], &other = bodies[pair.skin_of];
    const SkinTree& skin = rows.skin[pair.skin_of];
    const dvec3& place_m = own.skin_m[v];
    const double seek_m = std::max(kSeek_m, reach_m);
    const haptics::SurfaceHit near =
        haptics::closest_within(skin.tree, view_of(other), place_m, seek_m);
    pair.clear_m[v] = near.hit() ? near.distance_m : seek_m;
    pair.clear_way_m[v] = rows.way_m[pair.skin_of];
    pair.clear_at_m[v] = place_m;
    const double zero_m = -pair.zero_m[v]; // a vertex that lay deep is as near as that
    if ((!near.hit() || near.distance_m - zero_m > reach_m) && pair.force_n[v] == 0.0)
        return false;
    const double deep_m = rows.deep_m[pair.vertex_of][v];
    const FacedSkin faced =
        skin_facing(other, skin, place_m, own.skin_normal[v], std::max(reach_m, deep_m));
    if (faced.found && faced.gap_m < 0.0) // its way is to where it pushes, not to the skin above
        pair.clear_m[v] = std::max(0.0, faced.gap_m - pair.zero_m[v]);
    if (!faced.found || faced.gap_m > reach_m || faced.gap_m < -deep_m)
        return false;
    const double share = smooth(kFromFacing, kToFacing, faced.facing) *
                         (1.0 - smooth(0.0, kBeside_m, faced.beside_m)) *
                         smooth(-deep_m, -0.8 * deep_m, faced.gap_m);
    const double area_m2 = std::min(rows.area_m2[pair.vertex_of][v], pair.most_area_m2);
    if (!(share > 0.0))
        return false;
    row = {.vertex_of = pair.vertex_of,
           .skin_of = pair.skin_of,
           .vertex = v,
           .at = tissue_point(faced.at),
           .normal = faced.normal,
           .gap_m = faced.gap_m - pair.zero_m[v],
           .share = share,
           .stiffness_npm = share * area_m2 * pair.pressure_npm3,
           .force_n = pair.force_n[v],
           .own_turn = {},
           .at_turn = {}};
    find_turns(bodies, row);
    return true;
}

void keep_rows(OrganRows& rows, SkinPair& pair) noexcept {
    const std::size_t first = rows.row.size();
    for (std::size_t r = 0; r < pair.count && rows.row.size() < kMostRows; ++r) {
        rows.row.push_back(rows.before[pair.first + r]);
        rows.row.back().force_n = pair.force_n[rows.row.back().vertex];
    }
    pair.first = first;
    pair.count = rows.row.size() - first;
}

// No skin is nearer to the vertex than this.
double left_m(std::span<const Body> bodies, const OrganRows& rows, const SkinPair& pair,
              std::uint32_t v) noexcept {
    return pair.clear_m[v] - (rows.way_m[pair.skin_of] - pair.clear_way_m[v]) -
           glm::distance(bodies[pair.vertex_of].skin_m[v], pair.clear_at_m[v]);
}

void find_rows(std::span<const Body> bodies, OrganRows& rows, SkinPair& pair) noexcept {
    const std::size_t a = pair.vertex_of, b = pair.skin_of;
    const double way_m = rows.way_m[a] + rows.way_m[b];
    const double reach_m =
        kNear_m + kFaster * (rows.last_m[a] + rows.last_m[b]) + rows.tool_m[a] + rows.tool_m[b];
    const bool had_rows = pair.count > 0;
    pair.first = rows.row.size();
    pair.count = 0;
    if (pair.next_m - way_m > reach_m || apart(rows.skin[a], rows.skin[b], reach_m)) {
        if (had_rows)
            std::fill(pair.force_n.begin(), pair.force_n.end(), 0.0);
        return;
    }
    pair.next_m = kInfinity;
    for (std::uint32_t v = 0; v < pair.force_n.size(); ++v) {
        if (left_m(bodies, rows, pair, v) <= reach_m || pair.force_n[v] > 0.0) {
            ++rows.looked;
            OrganRow row;
            if (!look(bodies, rows, pair, v, reach_m, row))
                pair.force_n[v] = 0.0;
            else if (rows.row.size() < kMostRows)
                rows.row.push_back(row);
            else
                ++rows.left_out;
        }
        pair.next_m = std::min(pair.next_m, way_m + left_m(bodies, rows, pair, v));
    }
    pair.count = rows.row.size() - pair.first;
}

} // namespace

OrganRows make_organ_rows(std::span<const Body> bodies) {
    OrganRows rows;
    for (const Body& body : bodies) {
        rows.skin.push_back(make_skin_tree(body));
        rows.area_m2.push_back(vertex_areas(body));
        rows.deep_m.push_back(depths(body, rows.skin.back()));
    }
    rows.way_m.assign(bodies.size(), 0.0);
    rows.last_m = rows.tool_m = rows.way_m;
    rows.still.assign(bodies.size(), 0);
    for (std::size_t a = 0; a < bodies.size(); ++a) {
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            if (a != b && (bodies[a].soft || bodies[b].soft))
                rows.pair.push_back(make_pair(bodies, rows, a, b));
        }
    }
    rows.row.reserve(kMostRows);
    rows.before.reserve(kMostRows);
    return rows;
}

void find_organ_rows(std::span<const Body> bodies, OrganRows& rows) noexcept {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const bool still = is_still(bodies[b]);
        rows.last_m[b] = still && rows.still[b] ? 0.0 : refit(rows.skin[b], bodies[b]);
        rows.way_m[b] += rows.last_m[b];
        rows.still[b] = still;
    }
    std::swap(rows.row, rows.before);
    rows.row.clear();
    for (SkinPair& pair : rows.pair) {
        const std::size_t a = pair.vertex_of, b = pair.skin_of;
        const bool still = rows.still[a] && rows.still[b] && rows.last_m[a] == 0.0 &&
                           rows.last_m[b] == 0.0 && rows.tool_m[a] + rows.tool_m[b] == 0.0 &&
                           pair.next_m > -1.0;
        if (still)
            keep_rows(rows, pair);
        else
            find_rows(bodies, rows, pair);
    }
}

} // namespace sim
