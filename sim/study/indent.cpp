#include "sim/study/indent.h"

#include "haptics/contact/surface_walk.h"
#include "sim/bridge/mesh_lean.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <stdexcept>

namespace sim {
namespace {

constexpr double kStep_s = 0.02; // a quadratic body wants one; statics do not depend on it

constexpr double kHeld = 0.5; // of what a place moves with: more lies against what holds it

using Nodes = std::vector<std::uint8_t>; // 1: chosen

// Nodes of the tets that a bed holds for the most part.
Nodes bedded_nodes(const tissue::BakedOrgan& organ) {
    const tissue::TetMesh& mesh = organ.mesh;
    Nodes bedded(mesh.rest_m.size(), 0);
    std::vector<double> stiffness_1pm2(mesh.tets.size(), 0.0);
    for (const tissue::BedSample& sample : organ.bed) {
        const auto [a, b, c, d] = mesh.tets[sample.tet];
        const glm::dvec3 o = mesh.rest_m[a];
        const double six_volumes_m3 =
            glm::dot(mesh.rest_m[b] - o, glm::cross(mesh.rest_m[c] - o, mesh.rest_m[d] - o));
        stiffness_1pm2[sample.tet] += 6.0 * sample.stiffness_m / six_volumes_m3;
    }
    const auto [least, most] = std::ranges::minmax(stiffness_1pm2);
    const double half_1pm2 = 0.5 * most;
    for (std::size_t t = 0; t < mesh.tets.size() && least < half_1pm2; ++t) {
        for (const std::uint32_t node : mesh.tets[t]) {
            if (stiffness_1pm2[t] > half_1pm2)
                bedded[node] = 1;
        }
    }
    return bedded;
}

// Share of the three corners' rows that lies on chosen nodes; quadratic rows name nodes on edges,
// too, which are none.
double share_on(const tissue::ContactSurface& skin, const tissue::Triangle& corners,
                const Nodes& nodes) {
    double sum = 0.0;
    for (const std::uint32_t v : corners) {
        for (std::uint32_t k = skin.row_start[v]; k < skin.row_start[v + 1]; ++k) {
            if (skin.row_node[k] < nodes.size() && nodes[skin.row_node[k]])
                sum += std::abs(static_cast<double>(skin.row_weight[k])) / 3.0;
        }
    }
    return sum;
}

} // namespace

Indenter::Indenter(std::shared_ptr<const tissue::BakedOrgan> organ,
                   const tissue::Material& material, double tip_radius_m, tissue::Tier tier)
    : body_(make_body(
          std::move(organ), material, TipRadii{tip_radius_m, tip_radius_m, tip_radius_m},
          tier == tissue::Tier::quadratic ? kStep_s : std::numeric_limits<double>::infinity(),
          tier)),
      feel_(body_), radius_m_(tip_radius_m) {
    if (!body_.soft)
        throw std::invalid_argument("a rigid organ cannot be indented");
    if (!feel_.firm())
        throw std::invalid_argument("an organ that nothing holds has no static stiffness");
}

IndentPoint Indenter::press(const glm::dvec3& near_m, std::span<const double> depth_m) {
    return press(near_m, normal_on(body_, nearest_on(body_, near_m).at), depth_m);
}

IndentPoint Indenter::press(const glm::dvec3& near_m, const glm::dvec3& out,
                            std::span<const double> depth_m) {
    const Foot foot = nearest_on(body_, near_m);
    IndentPoint point{.place_m = place_on(body_, foot.at), .normal = out};
    const glm::dmat3 compliance = feel_.mesh_compliance(foot.at) + lean_on(body_, foot.at);
    point.mesh_mpn = glm::dot(out, compliance * out);
    point.tangential_mpn =
        0.5 * (compliance[0][0] + compliance[1][1] + compliance[2][2] - point.mesh_mpn);
    const haptics::LocalLaw law = law_on(body_, foot.at, 0, 0.0);
    point.linear_mpn = law.normal_mpn;
    for (const double d : depth_m)
        point.force_n.push_back(press_force_n(law, point.mesh_mpn, d, radius_m_));
    return point;
}

std::vector<glm::dvec3> random_places(const Body& body, int count, std::uint64_t seed,
                                      PressedSkin pressed) {
    const tissue::ContactSurface& skin = body.organ->surface;
    const bool free =
        pressed == PressedSkin::free && !body.organ->bed.empty() && !body.organ->mesh.tets.empty();
    const Nodes bedded = free ? bedded_nodes(*body.organ) : Nodes{};
    std::vector<double> area_sum;
    std::vector<std::size_t> triangle;
    double sum = 0.0, free_sum = 0.0;
    for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
        const tissue::Triangle& c = skin.triangles[t];
        if (share_on(skin, c, body.organ->anchored) > 0.0)
            continue;
        const double area = glm::length(glm::cross(skin.rest_m[c[1]] - skin.rest_m[c[0]],
                                                   skin.rest_m[c[2]] - skin.rest_m[c[0]]));
        sum += area;
        if (!free || share_on(skin, c, bedded) <= kHeld)
            free_sum += area;
        area_sum.push_back(sum);
        triangle.push_back(t);
    }
    constexpr double kTooLittle = 1e-3; // of the skin: places are drawn until one is free
    if (!(free_sum > kTooLittle * sum))
        throw std::invalid_argument("no skin is free of held tissue");
    std::mt19937_64 random(seed);
    const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
    std::vector<glm::dvec3> places;
    while (static_cast<int>(places.size()) < count) {
        const auto at = std::lower_bound(area_sum.begin(), area_sum.end(), unit() * sum);
        const tissue::Triangle& c = skin.triangles[triangle[at - area_sum.begin()]];
        double a = unit(), b = unit();
        if (a + b > 1.0) {
            a = 1.0 - a;
            b = 1.0 - b;
        }
        if (free && share_on(skin, c, bedded) > kHeld)
            continue;
        places.push_back((1.0 - a - b) * skin.rest_m[c[0]] + a * skin.rest_m[c[1]] +
                         b * skin.rest_m[c[2]]);
    }
    return places;
}

std::vector<glm::dvec3> slide_places(const Body& body, const glm::dvec3& from_m,
                                     const glm::dvec3& heading, double length_m, int steps) {
    haptics::SurfacePoint at = nearest_on(body, from_m).at;
    std::vector<glm::dvec3> places{place_on(body, at)};
    glm::dvec3 direction = glm::normalize(heading);
    for (int i = 0; i < steps; ++i) {
        const glm::dvec3 n = normal_on(body, at);
        direction = glm::normalize(direction - glm::dot(direction, n) * n);
        at = haptics::walk(BodySurface{body}, at, length_m / steps * direction).point;
        places.push_back(place_on(body, at));
    }
    return places;
}

} // namespace sim
