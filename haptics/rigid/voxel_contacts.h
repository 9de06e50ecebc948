// haptics/rigid/voxel_contacts.h
// Contact of a tool made of points with a voxel map: constant time, whatever the scenery. The
// alternative to pairs of convex pieces in step_rigid, for scenery of many concave pieces; 1 kHz.
//
// Point shell and tangent-plane force of McNeely, Puterbaugh, Troy 1999. There each point is a
// spring, so n points are n times as stiff; here each point stands for its area and hands a patch
// to contact_clusters, whose stiffness does not depend on n.
#pragma once

#include "haptics/rigid/contact_clusters.h"
#include "haptics/rigid/rigid_pose.h"
#include "haptics/rigid/voxel_map.h"

namespace haptics {

/// Frame of the tool. A point stands for the triangle that it is the middle of.
struct ShellPoint {
    glm::dvec3 place_m{0.0};
    glm::dvec3 normal{0.0}; // outward, unit
    std::array<glm::dvec3, 3> corner_m{};
    double reach_m = 0.0; // to the farthest corner
};
using PointShell = std::vector<ShellPoint>;

/// Load time. One point for each part of a triangle, halved until no side is above `spacing_m`.
/// Throws std::invalid_argument naming the surface: spacing not above 0, more than 10^5 points.
PointShell make_point_shell(const RigidSurface& surface, double spacing_m);

/// Reused; `patch` must have room for all points of the shell (reserve_for), others are left out.
struct VoxelScratch {
    std::vector<ContactPatch> patch;
};
VoxelScratch reserve_for(const PointShell& shell);

/// Contacts of the tool (the second body) with the map's body (the first), in the world. The plane
/// that a point is under is that of the distance read at it; what counts of its triangle is what is
/// below the plane, and faces it. Real-time safe: one look-up per point.
void voxel_contacts(const VoxelMap& map, const RigidPose& map_pose, const PointShell& shell,
                    const RigidPose& tool_pose, const ClusterParams& params, VoxelScratch& scratch,
                    ContactList& out) noexcept;

} // namespace haptics
