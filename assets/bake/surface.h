// assets/bake/surface.h
// A triangle surface as bake passes it from step to step, the facts one can check about it, and
// its half-edge form (OpenMesh). Every source of surfaces (recipe now, files later) ends here.
#pragma once

#include "tissue/mesh/tet_mesh.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace bake {

struct Surface {
    std::vector<glm::dvec3> point_m;
    std::vector<tissue::Triangle> triangles; // counter-clockwise seen from outside
};

/// Wanted edge length at a place, in metres.
using SizeAt = std::function<double(const glm::dvec3&)>;

struct MeshTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::PrevHalfedge);
    FaceAttributes(OpenMesh::Attributes::Status);
};
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<MeshTraits>;

inline glm::dvec3 to_glm(const OpenMesh::Vec3d& p) {
    return {p[0], p[1], p[2]};
}
inline OpenMesh::Vec3d to_openmesh(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

/// What is wrong with a surface; all zero: closed, manifold, oriented, without slivers.
struct SurfaceProblems {
    int refused_triangles = 0; // not manifold, not consistently oriented, or a corner twice
    int open_edges = 0;
    int pinched_vertices = 0; // two fans of triangles meet in one vertex
    int flat_triangles = 0;   // smallest height below 1e-4 of the longest edge
    int shells = 0;           // connected pieces
    bool inside_out = false;  // negative volume
};
/// One line per problem, empty when the surface is fit for tetrahedra (one closed shell).
std::vector<std::string> describe(const SurfaceProblems& problems);

SurfaceProblems check_surface(const Surface& surface);

/// Throws std::invalid_argument naming the triangle that does not fit.
HalfEdgeMesh make_half_edges(const Surface& surface);
Surface make_surface(const HalfEdgeMesh& mesh);

double area_m2(const Surface& surface);
double volume_m3(const Surface& surface);

/// Edge of equilateral triangles of the same area and number.
double mean_edge_m(const Surface& surface);

/// Area-weighted unit normal of every vertex.
std::vector<glm::dvec3> vertex_normals(const Surface& surface);

} // namespace bake
