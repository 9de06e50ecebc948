// haptics/rigid/rigid_pose.h
// Where a rigid body stands. Used by everything in haptics/rigid, in any thread.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace haptics {

/// x_world = rotation * x_body + position. The rotation is orthonormal with determinant 1; nobody
/// checks that.
struct RigidPose {
    glm::dmat3 rotation{1.0};
    glm::dvec3 position_m{0.0};
};

inline glm::dvec3 to_world(const RigidPose& pose, const glm::dvec3& body_m) noexcept {
    return pose.rotation * body_m + pose.position_m;
}

/// Pose of `b` as seen from `a`: differences of positions are taken first, so that two bodies
/// 1000 m from the origin meet as they do at the origin, up to the rounding of their positions.
inline RigidPose relative_pose(const RigidPose& a, const RigidPose& b) noexcept {
    const glm::dmat3 back = glm::transpose(a.rotation);
    return {back * b.rotation, back * (b.position_m - a.position_m)};
}

} // namespace haptics
