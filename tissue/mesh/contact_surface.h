// tissue/mesh/contact_surface.h
// The skin of an organ: a surface finer than its tetrahedra, on which tools touch and which is
// drawn. It follows the tissue through footprint rows: vertex v moves with the nodes under a
// kernel of radius r around it, so that stiffness does not depend on where in the mesh one
// presses. Geometry is that of the smooth rest surface, rigid motion is exact:
//   x_v = sum_i w_vi x_i + R_v offset_v,   offset_v = X_v - sum_i w_vi X_i
#pragma once

#include "tissue/mesh/tet_mesh.h"

#include <glm/mat3x3.hpp>

namespace tissue {

using SymmetricTensor = std::array<double, 6>; // xx, yy, zz, yz, xz, xy

struct ContactSurface {
    std::vector<glm::dvec3> rest_m;
    std::vector<Triangle> triangles;
    std::vector<std::array<std::int32_t, 3>> neighbours; // across the edge opposite corner k; -1

    // footprint rows, one per vertex, compressed: nodes[row_start[v] .. row_start[v+1])
    std::vector<std::uint32_t> row_start;
    std::vector<std::uint32_t> row_node;
    std::vector<double> row_weight;                       // sums to 1 in each row
    std::vector<glm::dvec3> offset_m;                     // rest frame
    std::vector<std::array<std::uint32_t, 3>> frame_node; // tissue nodes whose triangle turns R_v

    // what the mesh cannot resolve under the kernel, per vertex
    std::vector<double> footprint_radius_m;   // r of the kernel here
    std::vector<double> thickness_m;          // of the tissue below, along the normal
    std::vector<double> mesh_term_n_m;        // dW_n * E: softening that linear tets owe, m/N * Pa
    std::vector<double> mesh_term_t_m;        // dW_t * E
    std::vector<SymmetricTensor> mesh_lean_m; // rest of dW * E, a tensor: see mesh_term.h
};

/// Triangle adjacency; throws naming the edge if the surface is not manifold.
std::vector<std::array<std::int32_t, 3>> triangle_neighbours(std::span<const Triangle> triangles);

/// What of R_v never changes: the frame triangles at rest, and the offsets of the vertices that
/// turn with them as they see them.
struct SkinFrame {
    std::array<std::uint32_t, 3> node{};
    double edge_1pm = 0.0, skew = 0.0, height_1pm = 0.0; // 1/p, q/p, 1/r of edges (p,0), (q,r)
    std::uint32_t stop = 0; // its vertices: from the stop of the one before
};
struct SkinFrames {
    std::vector<SkinFrame> frame;
    std::vector<std::uint32_t> vertex;
    std::vector<glm::dvec3> offset_m; // of each of them; edge_1pm 0: degenerate, world
};
/// None for rigid scenery. Made once at load.
SkinFrames make_skin_frames(const ContactSurface& surface, std::span<const glm::dvec3> rest_node_m);

/// Rotation of a triangle from rest to now: its normal turns into the new normal, and within the
/// plane it turns by the rotation part of its deformation. 1 if degenerate. Real-time safe.
glm::dmat3 triangle_turn(const std::array<glm::dvec3, 3>& rest_m,
                         const std::array<glm::dvec3, 3>& now_m) noexcept;

/// Positions and unit normals of every vertex for nodes at `node_m`. Sizes must fit.
void place_surface(const ContactSurface& surface, const SkinFrames& frames,
                   std::span<const glm::dvec3> node_m, std::span<glm::dvec3> position_m,
                   std::span<glm::dvec3> normal) noexcept;

} // namespace tissue
