// haptics/device/trocar.h
// A tool through the abdominal wall: the handle outside, the tip inside, the shaft through a
// fixed point (fulcrum). World frame. Pitch, yaw, insertion; roll turns about the shaft.
//   u = (f - h)/|f - h|,  tip = h + L u                    h handle, f fulcrum, L shaft length
//   J = d tip / d h = u u^T - (s/|f - h|)(I - u u^T),  s = L - |f - h| insertion  (J symmetric)
//   F_handle = J^T F_tip: power F_tip . v_tip = F_handle . v_handle, fulcrum sign as in reality
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace haptics {

struct Trocar {
    glm::dvec3 fulcrum_m{0.0};
    double shaft_m = 0.33;
    double min_insertion_m = 0.020; // below: insertion is clamped, the handle only turns the tip
    double min_outside_m = 0.030;   // nearer to the fulcrum: clamped, and the lever frozen there
};

struct ShaftPose {
    glm::dvec3 tip_m{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0}; // unit, handle to tip
    double insertion_m = 0.0;
    glm::dmat3 jacobian{1.0}; // d tip / d handle, of the clamped map
};

/// Any handle position, also absurd ones, gives a finite pose. Real-time safe.
ShaftPose shaft_pose(const Trocar& trocar, const glm::dvec3& handle_m) noexcept;

/// The handle position that puts the tip there (inverse of shaft_pose where not clamped).
glm::dvec3 handle_for_tip(const Trocar& trocar, const glm::dvec3& tip_m) noexcept;

/// Force on the handle for a force on the tip.
glm::dvec3 force_at_handle(const ShaftPose& pose, const glm::dvec3& tip_force_n) noexcept;

} // namespace haptics
