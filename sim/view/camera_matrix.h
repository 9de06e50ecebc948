// sim/view/camera_matrix.h
// The endoscope's picture as matrices, and how large things are in it. Pure; any thread.
#pragma once

#include "sim/view/frame.h"

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

inline glm::dmat4 projection_matrix(const Camera& camera, int width_px, int height_px) {
    const double aspect = static_cast<double>(width_px) / std::max(1, height_px);
    return glm::perspective(field_of_view_rad(camera), aspect, kNear_m, kFar_m);
}

/// Diameter in pixels of a disc that faces the camera: h 2r / (2 d tan(fov/2)), d the distance
/// along the optical axis; 0 behind the camera.
inline double disc_px(const Camera& camera, const glm::dvec3& centre_m, double radius_m,
                      int height_px) {
    const double ahead_m =
        glm::dot(centre_m - camera.eye_m, glm::normalize(camera.look_at_m - camera.eye_m));
    if (!(ahead_m > kNear_m))
        return 0.0;
    return height_px * radius_m / (ahead_m * std::tan(0.5 * field_of_view_rad(camera)));
}

/// The drawn radius of a target: its tolerance, never under 3 mm.
inline double drawn_radius_m(const TargetView& target) noexcept {
    return std::max(3e-3, target.radius_m);
}

} // namespace view
