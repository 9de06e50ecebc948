// sim/view/camera_matrix.h
// The endoscope's picture as matrices, and how large things are in it. Pure; render thread.
#pragma once

#include "sim/view/frame.h"
#include "sim/view/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

namespace view {

inline constexpr double kNear_m = 0.005, kFar_m = 1.0;

/// Wider windows see more at the sides, never less in height.
inline double field_of_view_rad(const Camera& camera) noexcept {
    return std::clamp(camera.field_of_view_deg, 10.0, 120.0) * std::numbers::pi / 180.0;
}

inline glm::dmat4 view_matrix(const Camera& camera) {
    return glm::lookAt(camera.eye_m, camera.look_at_m, camera.up);
}

/// The pinhole's picture that the lens looks at.
inline glm::dmat4 projection_matrix(const Camera& camera, const Lens& lens) {
    const glm::dvec2 half_m = kNear_m * std::tan(0.5 * field_of_view_rad(camera)) * lens.reach;
    return glm::frustum(-half_m.x, half_m.x, -half_m.y, half_m.y, kNear_m, kFar_m);
}

/// Diameter in pixels of a disc that faces a pinhole camera: h 2r / (2 d tan(fov/2)), d the
/// distance along the optical axis; 0 behind the camera.
inline double disc_px(const Camera& camera, const glm::dvec3& centre_m, double radius_m,
                      int height_px) {
    const double ahead_m =
        glm::dot(centre_m - camera.eye_m, glm::normalize(camera.look_at_m - camera.eye_m));
    if (!(ahead_m > kNear_m))
        return 0.0;
    return height_px * radius_m / (ahead_m * std::tan(0.5 * field_of_view_rad(camera)));
}

/// Cosine between a mark and the line of sight: its surface's, but turned at most 35 degrees away.
inline constexpr double kLeastFacing = 0.82;
inline double mark_facing(const Camera& camera, const TargetView& target) noexcept {
    const glm::dvec3 to_eye = glm::normalize(camera.eye_m - target.position_m);
    return std::clamp(glm::dot(target.normal, to_eye), kLeastFacing, 1.0);
}

/// The drawn radius of a target: its tolerance, never under 3 mm, nor under what makes a mark of
/// kLeastMark_px, turned as it is, where the lens draws it.
inline constexpr double kLeastMark_px = 12.0;
inline double drawn_radius_m(const Camera& camera, const Lens& lens, const TargetView& target,
                             int height_px) {
    const double wish_m = std::max(3e-3, target.radius_m);
    const double px_per_m = disc_px(camera, target.position_m, 1.0, height_px);
    if (!(px_per_m > 0.0))
        return wish_m;
    const glm::dvec3 ray = target.position_m - camera.eye_m;
    const double along = glm::dot(ray, glm::normalize(camera.look_at_m - camera.eye_m));
    const double aside = std::sqrt(std::max(0.0, glm::dot(ray, ray) - along * along));
    const double r = aside / along / std::tan(0.5 * field_of_view_rad(camera));
    const double shrunk = mark_facing(camera, target) * radial_scale(lens, seen_radius(lens, r));
    return std::max(wish_m, kLeastMark_px / (px_per_m * shrunk));
}

} // namespace view
