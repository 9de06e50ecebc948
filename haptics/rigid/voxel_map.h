// haptics/rigid/voxel_map.h
// Signed distance of a closed surface on a grid: asked for a point it answers in constant time,
// however many triangles there were. Built at load; voxel_contacts asks it at 1 kHz.
//
// After the voxmap of McNeely, Puterbaugh, Troy 1999 (Six degree-of-freedom haptic rendering using
// voxel sampling), with distances in place of their four classes of voxels: their tangent plane
// goes through the middle of a voxel, so that a point feels steps of up to a voxel; a distance read
// between the voxels has the plane where the surface is.
#pragma once

#include "haptics/rigid/surface_query.h"

#include <glm/vec3.hpp>

namespace haptics {

/// Frame of the surface.
struct VoxelMap {
    double voxel_m = 0.0;
    glm::dvec3 first_m{0.0};             // of node 0, 0, 0
    std::array<std::uint32_t, 3> size{}; // nodes per axis
    std::vector<float> distance_m{};     // x runs fastest; negative inside
};

/// Load time: some seconds for 10^7 nodes. Two voxels of margin all round. Distances are exact
/// within a voxel of the surface; beyond, to the nearest of the neighbours' nearest triangles.
/// Throws std::invalid_argument, naming the surface: open, voxel_m not above 0, or more than
/// `most_bytes` (4 per node) needed; the message says which voxel would fit.
VoxelMap make_voxel_map(const RigidSurface& surface, double voxel_m,
                        std::size_t most_bytes = std::size_t{256} << 20);

/// Distance and its gradient (not of unit length) between the nodes, trilinear. Off the grid: far
/// outside. Exact at plane faces, off by up to voxel^2 / (2 r) at curvature 1 / r, and rounder than
/// the surface within a voxel of an edge. Real-time safe.
struct VoxelDistance {
    double distance_m = 1e300;
    glm::dvec3 gradient{0.0};
};
VoxelDistance distance_at(const VoxelMap& map, const glm::dvec3& place_m) noexcept;

} // namespace haptics
