#include "haptics/device/trocar.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace haptics {
namespace {

// Direction and length of v; straight down if there is none. Scaled first: a handle a light year
// away still has a direction.
struct Ray {
    glm::dvec3 direction;
    double length_m;
};

Ray ray_of(const glm::dvec3& v) noexcept {
    const double size = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(size > 0.0 && size < 1e300) || !std::isfinite(v.x + v.y + v.z))
        return {{0.0, 0.0, -1.0}, 0.0};
    const glm::dvec3 scaled = v / size;
    const double length = glm::length(scaled);
    return {scaled / length, length * size};
}

} // namespace

ShaftPose shaft_pose(const Trocar& trocar, const glm::dvec3& handle_m) noexcept {
    const Ray to_fulcrum = ray_of(trocar.fulcrum_m - handle_m);
    const glm::dvec3& u = to_fulcrum.direction;
    const double longest_m = trocar.shaft_m - trocar.min_insertion_m;
    const double outside_m = std::clamp(to_fulcrum.length_m, trocar.min_outside_m, longest_m);
    const double insertion_m = trocar.shaft_m - outside_m;

    // along the shaft nothing moves where the insertion is clamped; across it the lever turns
    // the handle's motion over. A handle inside min_outside_m keeps the lever it had there.
    const bool clamped = outside_m != to_fulcrum.length_m;
    const double lever = insertion_m / std::max(to_fulcrum.length_m, trocar.min_outside_m);
    const glm::dmat3 along = glm::outerProduct(u, u);
    return {.tip_m = trocar.fulcrum_m + insertion_m * u,
            .direction = u,
            .insertion_m = insertion_m,
            .jacobian = (clamped ? 0.0 : 1.0) * along - lever * (glm::dmat3{1.0} - along)};
}

glm::dvec3 handle_for_tip(const Trocar& trocar, const glm::dvec3& tip_m) noexcept {
    const Ray inside = ray_of(tip_m - trocar.fulcrum_m);
    const double insertion_m =
        std::clamp(inside.length_m, trocar.min_insertion_m, trocar.shaft_m - trocar.min_outside_m);
    return trocar.fulcrum_m - (trocar.shaft_m - insertion_m) * inside.direction;
}

glm::dvec3 force_at_handle(const ShaftPose& pose, const glm::dvec3& tip_force_n) noexcept {
    return glm::transpose(pose.jacobian) * tip_force_n;
}

} // namespace haptics
