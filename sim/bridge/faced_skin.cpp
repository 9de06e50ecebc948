#include "sim/bridge/faced_skin.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace sim {
namespace {

using glm::dvec3;

constexpr double kAcross = 0.1;         // cosine: turned away more than this, it does not face
constexpr double kCrease = 0.707106781; // cosine of 45 degrees: smooth up to there

dvec3 area_of(const Body& body, std::uint32_t t) noexcept {
    const auto [a, b, c] = body.organ->surface.triangles[t];
    return glm::cross(body.skin_m[b] - body.skin_m[a], body.skin_m[c] - body.skin_m[a]);
}

// As haptics::ClosestSearch, among the triangles that face.
struct FacingSearch {
    const Body& body;
    haptics::MeshView mesh;
    dvec3 outward;
    haptics::Reach reach;
    double best2_m2;
    haptics::SurfaceHit best{};

    void operator()(std::uint32_t t) noexcept {
        const dvec3 area = area_of(body, t);
        if (!(glm::dot(area, outward) < -kAcross * glm::length(area)))
            return;
        const haptics::TrianglePoint near =
            haptics::nearest_on_triangle(mesh.corners(t), reach.from_m);
        if (!(near.distance2_m2 < best2_m2 || (near.distance2_m2 == best2_m2 && t < best.triangle)))
            return;
        best2_m2 = near.distance2_m2;
        best = {t, near.weight, near.place_m, std::sqrt(best2_m2)};
        reach.radius_m = best.distance_m;
    }
};

// Mixed from the corners, each the mean of what is around it on this side of any crease.
dvec3 normal_at(const Body& body, const SkinTree& skin, const haptics::SurfaceHit& hit) noexcept {
    const dvec3 own = glm::normalize(area_of(body, hit.triangle));
    const tissue::Triangle& corner = body.organ->surface.triangles[hit.triangle];
    dvec3 sum{0.0};
    for (int k = 0; k < 3; ++k) {
        dvec3 mean{0.0};
        for (std::uint32_t i = skin.start[corner[k]]; i < skin.start[corner[k] + 1]; ++i) {
            const dvec3 area = area_of(body, skin.around[i]);
            if (glm::dot(area, own) > kCrease * glm::length(area))
                mean += area;
        }
        const double size = glm::length(mean);
        sum += hit.weight[k] * (size > 0.0 ? mean / size : own);
    }
    return glm::normalize(sum);
}

void find_box(SkinTree& skin, const Body& body) noexcept {
    skin.low_m = skin.high_m = body.skin_m[0];
    for (const dvec3& x : body.skin_m) {
        skin.low_m = glm::min(skin.low_m, x);
        skin.high_m = glm::max(skin.high_m, x);
    }
}

} // namespace

haptics::MeshView view_of(const Body& body) noexcept {
    return {body.skin_m, body.organ->surface.triangles, {}};
}

SkinTree make_skin_tree(const Body& body) {
    SkinTree skin;
    skin.tree = haptics::make_wide_tree(view_of(body));
    skin.was_m = body.skin_m;
    const auto& triangles = body.organ->surface.triangles;
    skin.start.assign(body.skin_m.size() + 1, 0);
    for (const tissue::Triangle& t : triangles) {
        for (const std::uint32_t v : t)
            ++skin.start[v + 1];
    }
    for (std::size_t v = 0; v < body.skin_m.size(); ++v)
        skin.start[v + 1] += skin.start[v];
    skin.around.resize(3 * triangles.size());
    std::vector<std::uint32_t> next(skin.start.begin(), skin.start.end() - 1);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        for (const std::uint32_t v : triangles[t])
            skin.around[next[v]++] = t;
    }
    find_box(skin, body);
    return skin;
}

double refit(SkinTree& skin, const Body& body) noexcept {
    double moved2 = 0.0;
    for (std::size_t v = 0; v < skin.was_m.size(); ++v) {
        const dvec3 d = body.skin_m[v] - skin.was_m[v];
        moved2 = std::max(moved2, glm::dot(d, d));
    }
    if (moved2 == 0.0)
        return 0.0;
    std::copy(body.skin_m.begin(), body.skin_m.end(), skin.was_m.begin());
    haptics::refit(skin.tree, view_of(body));
    find_box(skin, body);
    return std::sqrt(moved2);
}

FacedSkin skin_facing(const Body& body, const SkinTree& skin, const dvec3& place_m,
                      const dvec3& outward, double within_m) noexcept {
    FacingSearch search{
        body, view_of(body), outward, {place_m, place_m, within_m}, within_m * within_m};
    haptics::visit(skin.tree, search.reach, search);
    FacedSkin out;
    if (!search.best.hit())
        return out;
    const dvec3 away_m = place_m - search.best.place_m;
    out.found = true;
    out.at = {static_cast<int>(search.best.triangle), search.best.weight};
    out.normal = normal_at(body, skin, search.best);
    out.gap_m = glm::dot(out.normal, away_m);
    out.beside_m = glm::length(away_m - out.gap_m * out.normal);
    out.facing = -glm::dot(out.normal, outward);
    return out;
}

} // namespace sim
