#include "haptics/rigid/voxel_contacts.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace haptics {
namespace {

using glm::dvec3;

constexpr std::size_t kMostPoints = 100000;

using Corners = std::array<dvec3, 3>;

ShellPoint point_of(const Corners& t) {
    ShellPoint p{.place_m = (t[0] + t[1] + t[2]) / 3.0,
                 .normal = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0])),
                 .corner_m = t};
    for (const dvec3& v : t)
        p.reach_m = std::max(p.reach_m, glm::length(v - p.place_m));
    return p;
}

// Across the middle of its longest side.
void halve(Corners t, double spacing_m, PointShell& shell) {
    const auto side_m = [&](std::size_t i) { return glm::length(t[(i + 1) % 3] - t[i]); };
    std::size_t longest = 0;
    for (const std::size_t i : {1u, 2u})
        if (side_m(i) > side_m(longest))
            longest = i;
    if (side_m(longest) <= spacing_m || shell.size() > kMostPoints) {
        shell.push_back(point_of(t));
        return;
    }
    const dvec3 from = t[longest], to = t[(longest + 1) % 3], top = t[(longest + 2) % 3];
    const dvec3 middle = 0.5 * (from + to);
    halve({top, from, middle}, spacing_m, shell);
    halve({to, top, middle}, spacing_m, shell);
}

} // namespace

PointShell make_point_shell(const RigidSurface& surface, double spacing_m) {
    if (!(spacing_m > 0.0))
        throw std::invalid_argument("point shell of " + surface.name +
                                    ": the spacing must be above 0");
    PointShell shell;
    for (const auto& [a, b, c] : surface.triangle)
        halve({surface.vertex_m[a], surface.vertex_m[b], surface.vertex_m[c]}, spacing_m, shell);
    if (shell.size() > kMostPoints)
        throw std::invalid_argument("point shell of " + surface.name + ": more than " +
                                    std::to_string(kMostPoints) + " points");
    return shell;
}

VoxelScratch reserve_for(const PointShell& shell) {
    VoxelScratch scratch;
    scratch.patch.reserve(shell.size());
    return scratch;
}

void voxel_contacts(const VoxelMap& map, const RigidPose& map_pose, const PointShell& shell,
                    const RigidPose& tool_pose, const ClusterParams& params, VoxelScratch& scratch,
                    ContactList& out) noexcept {
    const RigidPose tool_in_map = relative_pose(map_pose, tool_pose);
    const glm::dmat3& turn = tool_pose.rotation;
    scratch.patch.clear();
    for (const ShellPoint& point : shell) {
        const VoxelDistance read = distance_at(map, to_world(tool_in_map, point.place_m));
        const double steep = glm::length(read.gradient);
        if (read.distance_m > point.reach_m || !(steep > 0.0))
            continue;
        const dvec3 normal = map_pose.rotation * (read.gradient / steep);
        const dvec3 face = turn * point.normal;
        const double facing = -glm::dot(face, normal);
        if (facing <= 0.0 || scratch.patch.size() == scratch.patch.capacity())
            continue;
        std::array<dvec3, 3> corner_m;
        for (std::size_t i = 0; i < 3; ++i)
            corner_m[i] = to_world(tool_pose, point.corner_m[i]);
        const dvec3 slope = -(normal + facing * face);
        const double depth_m =
            glm::dot(slope, corner_m[0] - to_world(tool_pose, point.place_m)) - read.distance_m;
        ContactPatch patch = part_in_contact(corner_m, normal, depth_m, slope);
        patch.area_m2 *= facing;
        patch.spread_m4 *= facing;
        if (patch.area_m2 > 0.0)
            scratch.patch.push_back(patch);
    }
    cluster_contacts(scratch.patch, params, out);
}

} // namespace haptics
