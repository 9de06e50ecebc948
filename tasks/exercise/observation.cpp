#include "tasks/exercise/observation.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tasks {

std::string_view role_name(Role role) noexcept {
    constexpr std::array<std::string_view, 4> names{"left", "right", "assist", "scope"};
    return names[static_cast<std::size_t>(role)];
}

bool in_view(const View& view, const glm::dvec3& point_m) noexcept {
    const glm::dvec3 to = point_m - view.eye_m;
    const double depth = glm::dot(to, view.forward);
    if (depth <= 0.0)
        return false;
    const glm::dvec3 right = glm::cross(view.forward, view.up);
    const double half_height = depth * std::tan(0.5 * view.field_of_view_rad);
    return std::abs(glm::dot(to, view.up)) <= half_height &&
           std::abs(glm::dot(to, right)) <= half_height * view.aspect;
}

double off_centre(const View& view, const glm::dvec3& point_m) noexcept {
    const glm::dvec3 to = point_m - view.eye_m;
    const double depth = glm::dot(to, view.forward);
    if (depth <= 0.0)
        return std::numeric_limits<double>::infinity();
    return 0.5 * glm::length(to - depth * view.forward) /
           (depth * std::tan(0.5 * view.field_of_view_rad));
}

double size_in_view(const View& view, const glm::dvec3& point_m, double radius_m) noexcept {
    const double depth = glm::dot(point_m - view.eye_m, view.forward);
    return depth > 0.0 ? radius_m / (depth * std::tan(0.5 * view.field_of_view_rad)) : 0.0;
}

} // namespace tasks
