// tissue/response/boundary_tree.h
// Nearest points and line hits on the boundary of a tetrahedral body: a box tree over its
// triangles. Called by footprint.cpp and mesh_term.cpp at bake time, any thread, not real time.
#pragma once

#include "tissue/mesh/tet_mesh.h"

namespace tissue {

struct BoundaryTree {
    struct Box {
        glm::dvec3 low{0.0}, high{0.0};
        std::uint32_t first = 0, count = 0; // leaf: range of `order`
        std::uint32_t right = 0;            // inner: left child is the next box
    };
    std::vector<glm::dvec3> node_m; // of the mesh
    std::vector<Triangle> triangle; // outward
    std::vector<glm::dvec3> normal; // unit, outward, per triangle
    std::vector<std::uint32_t> order;
    std::vector<Box> box;
};
/// Throws std::invalid_argument if the mesh has no boundary.
BoundaryTree make_boundary_tree(const TetMesh& mesh);
/// The same over any surface, outward triangles. Throws if there is none.
BoundaryTree make_surface_tree(std::span<const glm::dvec3> node_m,
                               std::span<const Triangle> triangles);

struct BoundaryPoint {
    std::uint32_t triangle = 0;
    glm::dvec3 weight{0.0};  // barycentric
    double distance_m = 0.0; // nearest_point: from the query; line_hits: along the line, signed
};

/// Ties go to the triangle found first, so the answer is deterministic.
BoundaryPoint nearest_point(const BoundaryTree& tree, const glm::dvec3& point_m);

/// Hits of the line from + t direction, low <= t <= high, ascending in t; `direction` is unit.
/// A line through an edge may hit both of its triangles.
std::vector<BoundaryPoint> line_hits(const BoundaryTree& tree, const glm::dvec3& from_m,
                                     const glm::dvec3& direction, double low_m, double high_m);

/// Weights of the point of a triangle that is nearest to `p` (Ericson 2005, 5.1.5). Real-time safe.
glm::dvec3 closest_weight(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                          const glm::dvec3& p) noexcept;

glm::dvec3 position_m(const BoundaryTree& tree, const BoundaryPoint& at);

} // namespace tissue
