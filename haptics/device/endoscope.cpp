#include "haptics/device/endoscope.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptics {
namespace {

// Part of `v` across unit `axis`, unit; some direction across it if nothing is left.
glm::dvec3 across(const glm::dvec3& v, const glm::dvec3& axis) noexcept {
    constexpr double kNothing = 1e-9;
    const glm::dvec3 part = v - glm::dot(v, axis) * axis;
    const double length = glm::length(part);
    if (length > kNothing)
        return part / length;
    const glm::dvec3 other = std::abs(axis.z) < 0.9 ? glm::dvec3{0, 0, 1} : glm::dvec3{1, 0, 0};
    return glm::normalize(other - glm::dot(other, axis) * axis);
}

glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double angle) noexcept {
    return std::cos(angle) * v + std::sin(angle) * glm::cross(axis, v);
}

// From `a` to `b` about `axis`; both across it.
double angle_about(const glm::dvec3& axis, const glm::dvec3& a, const glm::dvec3& b) noexcept {
    return std::atan2(glm::dot(axis, glm::cross(a, b)), glm::dot(a, b));
}

} // namespace

EndoscopePicture picture_of(const Endoscope& scope, const ShaftPose& shaft, double camera_rad,
                            double optic_rad) noexcept {
    const glm::dvec3& u = shaft.direction;
    const glm::dvec3 head = turned(across(scope.up, u), u, camera_rad);
    EndoscopePicture picture;
    picture.eye_m = shaft.tip_m;
    picture.forward = glm::normalize(std::cos(scope.optic_rad) * u +
                                     std::sin(scope.optic_rad) * turned(head, u, optic_rad));
    picture.up = across(head, picture.forward);
    return picture;
}

EndoscopeAim aim_at(const Endoscope& scope, const glm::dvec3& place_m, double distance_m,
                    const glm::dvec3& near_m, double horizon_rad) noexcept {
    // In the triangle fulcrum, eye, place the angle at the eye is 180 degrees less the optic's.
    const Trocar& trocar = scope.trocar;
    const glm::dvec3 way = place_m - trocar.fulcrum_m;
    const double far_m = std::max(glm::length(way), 1e-6);
    const glm::dvec3 along = far_m > 1e-6 ? way / far_m : glm::dvec3{0.0, 0.0, -1.0};
    const double sine = std::sin(scope.optic_rad), cosine = std::cos(scope.optic_rad);
    const double wanted_m = std::min(distance_m, sine > 0.0 ? 0.99 * far_m / sine : distance_m);
    const double least_m = trocar.min_insertion_m, most_m = trocar.shaft_m - trocar.min_outside_m;
    const double inside_m =
        std::clamp(-wanted_m * cosine +
                       std::sqrt(std::max(0.0, far_m * far_m - wanted_m * wanted_m * sine * sine)),
                   least_m, std::max(least_m, std::min(most_m, 0.99 * far_m)));
    const double eye_m =
        -inside_m * cosine +
        std::sqrt(std::max(0.0, far_m * far_m - inside_m * inside_m * sine * sine));
    const double s = std::clamp(eye_m * sine / far_m, -1.0, 1.0);
    const glm::dvec3 side = across(near_m - trocar.fulcrum_m, along);
    const glm::dvec3 u = glm::normalize(std::sqrt(1.0 - s * s) * along + s * side);

    EndoscopeAim aim;
    aim.tip_m = trocar.fulcrum_m + inside_m * u;
    const glm::dvec3 forward = glm::normalize(place_m - aim.tip_m);
    // The camera head for a picture that stands upright, turned by what the horizon is to be off.
    const glm::dvec3 up = turned(across(scope.up, forward), forward, horizon_rad);
    const double lean = glm::dot(u, forward);
    const glm::dvec3 head = across(lean > 1e-6 ? up - glm::dot(u, up) / lean * forward : up, u);
    aim.camera_rad = angle_about(u, across(scope.up, u), head);
    aim.optic_rad = scope.optic_rad > 0.0 ? angle_about(u, head, across(forward, u)) : 0.0;
    return aim;
}

double horizon_rad(const EndoscopePicture& picture, const glm::dvec3& up) noexcept {
    const glm::dvec3 level = up - glm::dot(up, picture.forward) * picture.forward;
    constexpr double kNothing = 1e-6;
    return glm::length(level) > kNothing ? angle_about(picture.forward, level, picture.up) : 0.0;
}

} // namespace haptics
