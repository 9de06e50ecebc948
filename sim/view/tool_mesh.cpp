// sim/view/tool_mesh.cpp
// Tool frame: origin at the tip's centre, z towards the handle, turned by the roll.
#include "sim/view/tool_mesh.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace view {
namespace {

constexpr double kJaw_m = 0.016, kNeck_m = 0.024, kRing_m = 0.007, kSteel_m = 0.010;
constexpr double kOpen_rad = 0.23; // each jaw: 13 degrees
const glm::vec3 kSteel(0.78F, 0.80F, 0.82F), kBlack(0.020F, 0.021F, 0.024F);

glm::mat4 tool_frame(const ToolView& tool) {
    const glm::dvec3 z = -glm::normalize(tool.direction);
    const glm::dvec3 aside = std::abs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(aside, z));
    const glm::dmat4 axes(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0),
                          glm::dvec4(tool.tip_m, 1));
    return glm::mat4(glm::rotate(axes, tool.roll_rad, glm::dvec3(0, 0, 1)));
}

ToolPart tube(const glm::mat4& frame, double from_m, double to_m, double radius_m,
              const glm::vec3& base, float metal) {
    glm::mat4 model = glm::translate(frame, glm::vec3(0, 0, from_m));
    model = glm::scale(model, glm::vec3(radius_m, radius_m, to_m - from_m));
    return {ToolPart::Form::cylinder, model, base, metal};
}

/// Half of a rod with a round end, turned about the hinge.
ToolPart jaw(const glm::mat4& frame, const ToolView& tool, double side) {
    const double angle = side * kOpen_rad * (1.0 - std::clamp(tool.jaw, 0.0, 1.0));
    const double r = tool.tip_radius_m, half_m = 0.5 * (kJaw_m + r);
    glm::mat4 model = glm::translate(frame, glm::vec3(0, 0, kJaw_m));
    model = glm::rotate(model, static_cast<float>(-angle), glm::vec3(1, 0, 0));
    model = glm::translate(model, glm::vec3(0, side * 0.42 * r, -half_m));
    model = glm::scale(model, glm::vec3(0.95 * r, 0.55 * r, half_m));
    return {ToolPart::Form::ball, model, kSteel, 1.0F};
}

} // namespace

glm::vec3 role_colour(Role role) noexcept {
    switch (role) {
    case Role::left:
        return {0.16F, 0.47F, 0.86F};
    case Role::right:
        return {0.92F, 0.52F, 0.05F};
    case Role::assist:
        return {0.05F, 0.62F, 0.52F};
    case Role::scope:
        return {0.70F, 0.40F, 0.80F};
    }
    return {0.5F, 0.5F, 0.5F};
}

std::vector<ToolPart> tool_parts(const ToolView& tool) {
    const glm::mat4 frame = tool_frame(tool);
    const double r = 0.83 * tool.tip_radius_m;
    const double reach_m = std::max(kNeck_m + kRing_m + kSteel_m + 0.01,
                                    glm::length(tool.tip_m - tool.fulcrum_m) + 0.05);
    // a point on black is lost: the ring is bright plastic of the role's colour
    const glm::vec3 mark = glm::pow(role_colour(tool.role), glm::vec3(2.2F)) * 1.6F;
    const double ring_end_m = kNeck_m + kRing_m;
    std::vector<ToolPart> parts;
    parts.push_back(jaw(frame, tool, 1.0));
    parts.push_back(jaw(frame, tool, -1.0));
    parts.push_back(tube(frame, kJaw_m - 0.003, kNeck_m, 0.9 * r, kSteel, 1.0F));
    parts.push_back(tube(frame, kNeck_m, ring_end_m, 1.14 * r, mark, 0.0F));
    parts.push_back(tube(frame, ring_end_m, ring_end_m + kSteel_m, r, kSteel, 1.0F));
    parts.push_back(tube(frame, ring_end_m + kSteel_m, reach_m, 1.06 * r, kBlack, 0.0F));
    return parts;
}

} // namespace view
