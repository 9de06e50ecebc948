#include "assets/bake/quality.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>

namespace bake {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

std::array<glm::dvec3, 4> corners(const tissue::TetMesh& mesh, const tissue::Tet& t) {
    return {mesh.rest_m[t[0]], mesh.rest_m[t[1]], mesh.rest_m[t[2]], mesh.rest_m[t[3]]};
}

double six_volumes(const std::array<glm::dvec3, 4>& c) {
    return glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), c[3] - c[0]);
}

/// Face opposite corner k, outwards for positive volume.
constexpr std::array<std::array<std::size_t, 3>, 4> kFace{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

std::array<glm::dvec3, 4> face_normals(const std::array<glm::dvec3, 4>& c) {
    std::array<glm::dvec3, 4> n{};
    for (std::size_t k = 0; k < 4; ++k) {
        n[k] = glm::cross(c[kFace[k][1]] - c[kFace[k][0]], c[kFace[k][2]] - c[kFace[k][0]]);
    }
    return n;
}

double aspect(const std::array<glm::dvec3, 4>& c) {
    double longest = 0.0, largest_face = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) {
            longest = std::max(longest, glm::length(c[i] - c[j]));
        }
    }
    for (const auto& n : face_normals(c)) {
        largest_face = std::max(largest_face, glm::length(n));
    }
    const double smallest_height = six_volumes(c) / largest_face;
    return longest / smallest_height * std::sqrt(2.0 / 3.0);
}

double smallest_around(const tissue::TetMesh& mesh, const std::vector<std::uint32_t>& star) {
    double smallest = std::numbers::pi;
    for (const auto t : star) {
        const auto c = corners(mesh, mesh.tets[t]);
        if (six_volumes(c) <= 0.0) {
            return -1.0;
        }
        for (const double angle : dihedrals_rad(c)) {
            // both a flat and a straight angle make a sliver
            smallest = std::min({smallest, angle, std::numbers::pi - angle});
        }
    }
    return smallest;
}

double mean_edge_m(const tissue::TetMesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& t : mesh.tets) {
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = i + 1; j < 4; ++j) {
                edges.insert(std::minmax(t[i], t[j]));
            }
        }
    }
    double sum_m = 0.0;
    for (const auto& [a, b] : edges) {
        sum_m += glm::length(mesh.rest_m[a] - mesh.rest_m[b]);
    }
    return edges.empty() ? 0.0 : sum_m / static_cast<double>(edges.size());
}

} // namespace

std::array<double, 6> dihedrals_rad(const std::array<glm::dvec3, 4>& c) {
    const auto n = face_normals(c);
    std::array<double, 6> angle{};
    std::size_t e = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) {
            const double cosine = -glm::dot(n[i], n[j]) / (glm::length(n[i]) * glm::length(n[j]));
            angle[e++] = std::acos(std::clamp(cosine, -1.0, 1.0));
        }
    }
    return angle;
}

TetQuality tet_quality(const tissue::TetMesh& mesh) {
    TetQuality q{.worst_dihedral_deg = 180.0};
    for (const auto& t : mesh.tets) {
        const auto c = corners(mesh, t);
        for (const double angle : dihedrals_rad(c)) {
            q.worst_dihedral_deg = std::min(q.worst_dihedral_deg, angle * kDegPerRad);
            q.largest_dihedral_deg = std::max(q.largest_dihedral_deg, angle * kDegPerRad);
        }
        const double a = aspect(c);
        q.worst_aspect = std::max(q.worst_aspect, a);
        q.mean_aspect += a / static_cast<double>(mesh.tets.size());
    }
    q.mean_edge_m = mean_edge_m(mesh);
    return q;
}

void improve_inner_nodes(tissue::TetMesh& mesh, int sweeps) {
    std::vector<std::vector<std::uint32_t>> star(mesh.rest_m.size());
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
        for (const auto v : mesh.tets[t]) {
            star[v].push_back(t);
        }
    }
    std::vector<char> fixed(mesh.rest_m.size(), 0);
    for (const auto& triangle : tissue::boundary_triangles(mesh)) {
        for (const auto v : triangle) {
            fixed[v] = 1;
        }
    }
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (std::uint32_t v = 0; v < mesh.rest_m.size(); ++v) {
            if (fixed[v] || star[v].empty()) {
                continue;
            }
            double edge_m = 1e9;
            for (const auto t : star[v]) {
                for (const auto w : mesh.tets[t]) {
                    if (w != v) {
                        edge_m = std::min(edge_m, glm::length(mesh.rest_m[w] - mesh.rest_m[v]));
                    }
                }
            }
            for (const double step : {0.3, 0.1, 0.03, 0.01}) {
                double best = smallest_around(mesh, star[v]);
                const glm::dvec3 start = mesh.rest_m[v];
                glm::dvec3 best_at = start;
                for (int code = 0; code < 27; ++code) {
                    const glm::dvec3 way{code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
                    if (code == 13) {
                        continue; // no move
                    }
                    mesh.rest_m[v] = start + glm::normalize(way) * (step * edge_m);
                    const double now = smallest_around(mesh, star[v]);
                    if (now > best) {
                        best = now;
                        best_at = mesh.rest_m[v];
                    }
                }
                mesh.rest_m[v] = best_at;
            }
        }
    }
}

} // namespace bake
