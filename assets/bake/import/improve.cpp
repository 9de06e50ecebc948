#include "assets/bake/import/improve.h"

#include "assets/bake/import/crossing.h"
#include "assets/bake/quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bake {
namespace {

using Star = std::vector<std::uint32_t>;

/// Smallest distance of a dihedral angle from 0 or 180 degrees; negative: turned over.
double worst_deg(const tissue::TetMesh& mesh, const tissue::Tet& t) {
    const std::array<glm::dvec3, 4> c{mesh.rest_m[t[0]], mesh.rest_m[t[1]], mesh.rest_m[t[2]],
                                      mesh.rest_m[t[3]]};
    if (glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), c[3] - c[0]) <= 0.0) {
        return -1.0;
    }
    double worst = std::numbers::pi;
    for (const double angle : dihedrals_rad(c)) {
        worst = std::min({worst, angle, std::numbers::pi - angle});
    }
    return worst * 180.0 / std::numbers::pi;
}

double worst_deg(const tissue::TetMesh& mesh, const Star& star) {
    double worst = 180.0;
    for (const auto t : star) {
        worst = std::min(worst, worst_deg(mesh, mesh.tets[t]));
    }
    return worst;
}

double shortest_edge_m(const tissue::TetMesh& mesh, std::uint32_t v, const Star& star) {
    double shortest = 1e9;
    for (const auto t : star) {
        for (const auto w : mesh.tets[t]) {
            if (w != v) {
                shortest = std::min(shortest, glm::length(mesh.rest_m[w] - mesh.rest_m[v]));
            }
        }
    }
    return shortest;
}

struct Climber {
    tissue::TetMesh& mesh;
    const NearestOnSurface& skin;
    std::vector<Star> star;
    std::vector<char> outside; // nodes of the boundary

    /// True if the node moved.
    bool climb(std::uint32_t v, double reach_m) {
        bool moved = false;
        const double edge_m = shortest_edge_m(mesh, v, star[v]);
        for (const double step : {0.3, 0.1, 0.03}) {
            double best = worst_deg(mesh, star[v]);
            const glm::dvec3 start = mesh.rest_m[v];
            glm::dvec3 best_at = start;
            for (int code = 0; code < 27; ++code) {
                if (code == 13) {
                    continue; // no move
                }
                const glm::dvec3 way{code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
                mesh.rest_m[v] = start + glm::normalize(way) * (step * edge_m);
                const double now = worst_deg(mesh, star[v]);
                if (now > best + 1e-6 &&
                    (!outside[v] || skin(mesh.rest_m[v]).distance_m <= reach_m)) {
                    best = now;
                    best_at = mesh.rest_m[v];
                }
            }
            mesh.rest_m[v] = best_at;
            moved = moved || best_at != start;
        }
        return moved;
    }
};

void sweep(Climber& climber, const ImproveOptions& o, double wanted_deg, bool boundary_too) {
    tissue::TetMesh& mesh = climber.mesh;
    for (int round = 0; round < o.sweeps; ++round) {
        std::vector<char> bad(mesh.rest_m.size(), 0);
        for (const auto& t : mesh.tets) {
            if (worst_deg(mesh, t) < wanted_deg) {
                for (const auto v : t) {
                    bad[v] = 1;
                }
            }
        }
        bool moved = false;
        for (std::uint32_t v = 0; v < mesh.rest_m.size(); ++v) {
            if (bad[v] && (boundary_too || !climber.outside[v])) {
                moved = climber.climb(v, o.reach_m) || moved;
            }
        }
        if (!moved) {
            break;
        }
    }
}

double worst_deg(const tissue::TetMesh& mesh) {
    double worst = 180.0;
    for (const auto& t : mesh.tets) {
        worst = std::min(worst, worst_deg(mesh, t));
    }
    return worst;
}

/// First order, as often as it takes; taken back by half while it makes bad tetrahedra.
void hold_volume(tissue::TetMesh& mesh, const std::vector<tissue::Triangle>& boundary,
                 const ImproveOptions& o) {
    const double worst = std::min(worst_deg(mesh), o.hold_deg);
    for (int round = 0; round < 3; ++round) {
        const Surface s{mesh.rest_m, boundary};
        const auto normal = vertex_normals(s);
        const double offset_m = (o.volume_m3 - volume_m3(s)) / area_m2(s);
        for (const double share : {1.0, 0.5, 0.25}) {
            std::vector<char> moved(mesh.rest_m.size(), 0);
            for (const auto& t : boundary) {
                for (const auto v : t) {
                    if (!moved[v]) {
                        mesh.rest_m[v] = s.point_m[v] + share * offset_m * normal[v];
                        moved[v] = 1;
                    }
                }
            }
            if (worst_deg(mesh) >= worst) {
                break;
            }
            mesh.rest_m = s.point_m;
        }
    }
}

} // namespace

void improve_nodes(tissue::TetMesh& mesh, const NearestOnSurface& skin,
                   const ImproveOptions& options) {
    Climber climber{.mesh = mesh, .skin = skin, .star = {}, .outside = {}};
    climber.star.resize(mesh.rest_m.size());
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
        for (const auto v : mesh.tets[t]) {
            climber.star[v].push_back(t);
        }
    }
    const auto boundary = tissue::boundary_triangles(mesh);
    climber.outside.assign(mesh.rest_m.size(), 0);
    for (const auto& t : boundary) {
        for (const auto v : t) {
            climber.outside[v] = 1;
        }
    }
    sweep(climber, options, options.wanted_deg, false);
    const auto inner_only = mesh.rest_m;
    sweep(climber, options, options.boundary_deg, true);
    hold_volume(mesh, boundary, options);
    sweep(climber, options, options.wanted_deg, false);
    if (!find_crossings({mesh.rest_m, boundary}, 1).empty()) {
        mesh.rest_m = inner_only;
    }
}

} // namespace bake
