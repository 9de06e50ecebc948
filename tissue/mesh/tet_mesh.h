// tissue/mesh/tet_mesh.h
// Tetrahedra in their rest shape, and the facts about them that everything else needs.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace tissue {

using Tet = std::array<std::uint32_t, 4>;      // positive volume when ordered
using Triangle = std::array<std::uint32_t, 3>; // counter-clockwise seen from outside

struct TetMesh {
    std::vector<glm::dvec3> rest_m;
    std::vector<Tet> tets;
};

/// Outward triangles of the boundary, in a fixed order.
std::vector<Triangle> boundary_triangles(const TetMesh& mesh);

double volume_m3(const TetMesh& mesh, std::span<const glm::dvec3> position_m);

/// Throws std::invalid_argument naming the tet if one has no positive volume, or names a node
/// out of range.
void check_mesh(const TetMesh& mesh);

/// Box [0,size] in nx x ny x nz cells, six tets a cell around the main diagonal (Kuhn).
/// `jitter`: interior nodes move by up to this share of the cell, seeded.
TetMesh box_mesh(const glm::dvec3& size_m, const std::array<int, 3>& cells, double jitter = 0.0,
                 std::uint64_t seed = 1);

} // namespace tissue
