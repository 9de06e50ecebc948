// tissue/mesh/quadratic_mesh.h
// Ten-node tetrahedra in their rest shape: a TetMesh with a node on every edge. Called at setup by
// the quadratic and the reference solver, studies and tests; any thread.
#pragma once

#include "tissue/mesh/tet_mesh.h"

namespace tissue {

/// Corners as in Tet, then the nodes on the edges of kEdge in that order: the order of C3D10 in
/// Abaqus and CalculiX and of VTK_QUADRATIC_TETRA.
using Tet10 = std::array<std::uint32_t, 10>;

/// Corners of edge k, whose node is the tet's node 4 + k.
inline constexpr std::array<std::array<int, 2>, 6> kEdge{
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

/// Three corners counter-clockwise seen from outside, then the nodes between 0-1, 1-2, 2-0.
using Triangle6 = std::array<std::uint32_t, 6>;

/// Shapes of the six nodes at barycentric `l`: l_i (2 l_i - 1), then 4 l_i l_j. They sum to 1; a
/// corner's is negative where l_i < 1/2.
std::array<double, 6> triangle_shapes(const glm::dvec3& l) noexcept;

struct QuadraticMesh {
    std::vector<glm::dvec3> rest_m;
    std::vector<Tet10> tets;
};

/// The nodes of `mesh` keep their numbers; the edge nodes follow, one in the middle of each edge,
/// by ascending (lower, higher) corner. Throws std::invalid_argument as check_mesh() does.
QuadraticMesh quadratic_mesh(const TetMesh& mesh);

/// How many nodes that has. Only the numbers of the corners are looked at.
std::size_t quadratic_node_count(const TetMesh& mesh);

/// Outward triangles of the boundary, in the order of boundary_triangles().
std::vector<Triangle6> boundary_triangles(const QuadraticMesh& mesh);

} // namespace tissue
