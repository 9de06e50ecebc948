// tissue/mesh/quadratic_mesh.cpp
// From corners to edge nodes. Called at setup.
#include "tissue/mesh/quadratic_mesh.h"

#include <algorithm>
#include <utility>

namespace tissue {
namespace {

using Edge = std::array<std::uint32_t, 2>; // lower node first

Edge edge_of(std::uint32_t a, std::uint32_t b) noexcept {
    return {std::min(a, b), std::max(a, b)};
}

// Ascending, each once.
std::vector<Edge> edges_of(const TetMesh& mesh) {
    std::vector<Edge> edges;
    edges.reserve(6 * mesh.tets.size());
    for (const Tet& t : mesh.tets) {
        for (const auto& [a, b] : kEdge)
            edges.push_back(edge_of(t[a], t[b]));
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

} // namespace

std::array<double, 6> triangle_shapes(const glm::dvec3& l) noexcept {
    return {l[0] * (2.0 * l[0] - 1.0), l[1] * (2.0 * l[1] - 1.0), l[2] * (2.0 * l[2] - 1.0),
            4.0 * l[0] * l[1],         4.0 * l[1] * l[2],         4.0 * l[2] * l[0]};
}

QuadraticMesh quadratic_mesh(const TetMesh& mesh) {
    check_mesh(mesh);
    const std::vector<Edge> edges = edges_of(mesh);
    QuadraticMesh quadratic{mesh.rest_m, {}};
    for (const auto& [a, b] : edges)
        quadratic.rest_m.push_back(0.5 * (mesh.rest_m[a] + mesh.rest_m[b]));
    quadratic.tets.reserve(mesh.tets.size());
    for (const Tet& t : mesh.tets) {
        Tet10 q{t[0], t[1], t[2], t[3]};
        for (std::size_t k = 0; k < kEdge.size(); ++k) {
            const auto at = std::lower_bound(edges.begin(), edges.end(),
                                             edge_of(t[kEdge[k][0]], t[kEdge[k][1]]));
            q[4 + k] = static_cast<std::uint32_t>(mesh.rest_m.size() + (at - edges.begin()));
        }
        quadratic.tets.push_back(q);
    }
    return quadratic;
}

std::size_t quadratic_node_count(const TetMesh& mesh) {
    return mesh.rest_m.size() + edges_of(mesh).size();
}

std::vector<Triangle6> boundary_triangles(const QuadraticMesh& mesh) {
    TetMesh corners{mesh.rest_m, {}};
    std::vector<std::pair<Edge, std::uint32_t>> middle;
    for (const Tet10& t : mesh.tets) {
        corners.tets.push_back({t[0], t[1], t[2], t[3]});
        for (std::size_t k = 0; k < kEdge.size(); ++k)
            middle.emplace_back(edge_of(t[kEdge[k][0]], t[kEdge[k][1]]), t[4 + k]);
    }
    std::sort(middle.begin(), middle.end());
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
        return std::lower_bound(middle.begin(), middle.end(), std::pair{edge_of(a, b), 0u})->second;
    };
    std::vector<Triangle6> faces;
    for (const Triangle& t : boundary_triangles(corners)) {
        faces.push_back(
            {t[0], t[1], t[2], between(t[0], t[1]), between(t[1], t[2]), between(t[2], t[0])});
    }
    return faces;
}

} // namespace tissue
