#include "assets/bake/fit.h"

#include "assets/bake/nearest.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bake {
namespace {

std::vector<double> point_areas(const Surface& s) {
    std::vector<double> area(s.point_m.size(), 0.0);
    for (const auto& t : s.triangles) {
        const double sixth = glm::length(glm::cross(s.point_m[t[1]] - s.point_m[t[0]],
                                                    s.point_m[t[2]] - s.point_m[t[0]])) /
                             6.0;
        for (const auto v : t) {
            area[v] += sixth;
        }
    }
    return area;
}

struct Segment {
    glm::dvec3 from_m, to_m;
};

std::vector<Segment> creases_of(const Surface& s, double crease_deg) {
    std::vector<Segment> creases;
    if (crease_deg >= 180.0) {
        return creases;
    }
    const HalfEdgeMesh mesh = make_half_edges(s);
    for (const auto e : mesh.edges()) {
        const auto h = mesh.halfedge_handle(e, 0);
        if (std::abs(mesh.calc_dihedral_angle(h)) > crease_deg * std::numbers::pi / 180.0) {
            creases.push_back({s.point_m[mesh.from_vertex_handle(h).idx()],
                               s.point_m[mesh.to_vertex_handle(h).idx()]});
        }
    }
    return creases;
}

double distance_m(const glm::dvec3& p, const Segment& s) {
    const glm::dvec3 along = s.to_m - s.from_m;
    const double at = glm::dot(p - s.from_m, along) / glm::dot(along, along);
    return glm::length(p - (s.from_m + std::clamp(at, 0.0, 1.0) * along));
}

// Remeshing leaves the points of a crease on it; where the crease is round, a little beside.
std::vector<char> points_on(const std::vector<Segment>& creases, const Surface& s) {
    constexpr double kBeside = 0.1; // of the crease's edge
    std::vector<char> on(s.point_m.size(), 0);
    for (std::size_t v = 0; v < on.size(); ++v) {
        on[v] = std::ranges::any_of(creases, [&](const Segment& c) {
            return distance_m(s.point_m[v], c) <= kBeside * glm::length(c.to_m - c.from_m);
        });
    }
    return on;
}

} // namespace

void fit_to_skin(const Surface& skin, int rounds, double crease_deg, Surface& coarse) {
    const auto area = point_areas(skin);
    const auto crease = points_on(creases_of(skin, crease_deg), coarse);
    for (int round = 0; round < rounds; ++round) {
        const NearestOnSurface nearest(coarse);
        std::vector<glm::dvec3> sum(coarse.point_m.size(), glm::dvec3{0.0});
        std::vector<double> weight(coarse.point_m.size(), 0.0);
        for (std::size_t i = 0; i < skin.point_m.size(); ++i) {
            const auto near = nearest(skin.point_m[i]);
            const auto& t = coarse.triangles[near.triangle];
            for (int k = 0; k < 3; ++k) {
                sum[t[k]] += area[i] * near.weight[k] * (skin.point_m[i] - near.point_m);
                weight[t[k]] += area[i] * near.weight[k];
            }
        }
        for (std::size_t v = 0; v < coarse.point_m.size(); ++v) {
            if (weight[v] > 0.0 && !crease[v]) {
                coarse.point_m[v] += sum[v] / weight[v];
            }
        }
    }
}

} // namespace bake
