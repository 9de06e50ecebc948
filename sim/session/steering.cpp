// sim/session/steering.cpp
#include "sim/session/steering.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace sim {
namespace {

constexpr double kMetresPerPixel = 0.15e-3, kMetresPerNotch = 2e-3, kKeySpeed_mps = 0.036;
constexpr double kRadPerPixel = 1e-3, kKeyPan_radps = 0.24, kTurn_radps = 0.8;
constexpr double kFine = 0.25;       // of the pace, with Shift
constexpr double kMargin_m = 5e-3;   // from both ends of what the shaft can do
constexpr double kWidest = 0.26;     // cosine: the endoscope, 75 degrees from its first place
constexpr double kJawIsClosed = 0.5; // taken over from the assistant

double reachable_m(const haptics::Trocar& trocar, double insertion_m) noexcept {
    return std::clamp(insertion_m, trocar.min_insertion_m + kMargin_m,
                      trocar.shaft_m - trocar.min_outside_m - kMargin_m);
}

// A tip stays where the shaft can reach: between the port and the end of the shaft.
glm::dvec3 reachable(const haptics::Trocar& trocar, const glm::dvec3& tip_m) noexcept {
    const glm::dvec3 from = tip_m - trocar.fulcrum_m;
    const double length = std::max(1e-6, glm::length(from));
    return trocar.fulcrum_m + from * (reachable_m(trocar, length) / length);
}

// Where it is and as it is, so that nothing jumps.
void take_over(Steering& s, const ToolsNow& now) noexcept {
    PointerGoals& goals = s.goals;
    if (s.active == kScopeActive) {
        goals.scope_held = true;
        if (now.tick < 0)
            return;
        goals.scope_tip_m = now.scope.view.eye_m;
        goals.camera_rad = now.scope.camera_rad;
        goals.optic_rad = now.scope.optic_rad;
        return;
    }
    const auto tool = static_cast<std::size_t>(s.active);
    const bool his_already = goals.held[tool];
    goals.held[tool] = true;
    if (his_already || now.tick < 0)
        return;
    goals.tip_m[tool] = now.tip[tool].centre_m;
    s.latched[tool] = now.jaw[tool] > kJawIsClosed;
}

void let_go(Steering& s) noexcept {
    if (s.active == kScopeActive) {
        s.goals.scope_held = false;
        return;
    }
    const auto tool = static_cast<std::size_t>(s.active);
    s.latched[tool] = s.goals.jaw[tool] > kJawIsClosed;
    if (s.assisted)
        s.goals.held[tool] = false;
}

void change_tool(Steering& s, const ToolsNow& now) noexcept {
    let_go(s);
    s.active = (s.active + 1) % (kTools + (s.scope ? 1 : 0));
    s.pressed_again = false;
    s.wait_for_release = true;
    take_over(s, now);
}

void move_jaw(Steering& s, bool pressed) noexcept {
    const auto tool = static_cast<std::size_t>(s.active);
    s.wait_for_release = s.wait_for_release && pressed;
    const bool counts = pressed && !s.wait_for_release;
    if (s.latched[tool] && s.pressed_again && !pressed)
        s.latched[tool] = false;
    s.pressed_again = s.latched[tool] && counts;
    s.goals.jaw[tool] = counts || s.latched[tool] ? 1.0 : 0.0;
}

void move_tool(Steering& s, const view::UserInput& input, const tasks::View& seen, double pace,
               double frame_s) noexcept {
    const auto tool = static_cast<std::size_t>(s.active);
    const glm::dvec3 right = glm::cross(seen.forward, seen.up);
    const glm::dvec3 keys = kKeySpeed_mps * frame_s * input.move;
    const glm::dvec3 offset = (kMetresPerPixel * input.mouse_px.x + keys.x) * right +
                              (kMetresPerPixel * input.mouse_px.y + keys.y) * seen.up +
                              (kMetresPerNotch * input.wheel - keys.z) * seen.forward;
    s.goals.tip_m[tool] = reachable(s.trocar[tool], s.goals.tip_m[tool] + pace * offset);
}

// The shaft turns about its trocar, towards the picture's right and up.
void move_scope(Steering& s, const view::UserInput& input, const tasks::View& seen, double pace,
                double frame_s) noexcept {
    const haptics::Trocar& trocar = *s.scope;
    PointerGoals& goals = s.goals;
    const glm::dvec3 right = glm::cross(seen.forward, seen.up);
    const double x = kRadPerPixel * input.mouse_px.x + kKeyPan_radps * frame_s * input.move.x;
    const double y = kRadPerPixel * input.mouse_px.y + kKeyPan_radps * frame_s * input.move.y;
    const glm::dvec3 from = goals.scope_tip_m - trocar.fulcrum_m;
    const double inside_m = std::max(1e-6, glm::length(from));
    glm::dvec3 shaft = glm::normalize(from / inside_m + pace * (x * right + y * seen.up));
    if (glm::dot(shaft, s.scope_start) < kWidest)
        shaft = from / inside_m;
    const double further_m = kMetresPerNotch * input.wheel - kKeySpeed_mps * frame_s * input.move.z;
    goals.scope_tip_m = trocar.fulcrum_m + reachable_m(trocar, inside_m + pace * further_m) * shaft;
    goals.camera_rad += pace * kTurn_radps * frame_s * input.roll;
    goals.optic_rad += pace * kTurn_radps * frame_s * input.turn_optic;
}

} // namespace

Steering begin_steering(const Session& session) {
    const Scene& scene = session.scene.scene;
    Steering s;
    for (int i = 0; i < kTools; ++i)
        s.trocar[i] = scene.tool[i].trocar;
    s.start_view = scene.view;
    s.goals = session.crew.pointer;
    s.assisted = std::holds_alternative<tasks::FindHand>(session.crew.hand);
    if (!scene.scope)
        return s;
    const SceneScope& scope = *scene.scope;
    s.scope = scope.optics.trocar;
    s.scope_start = glm::normalize(scope.start.tip_m - scope.optics.trocar.fulcrum_m);
    s.goals.scope_tip_m = scope.start.tip_m;
    s.goals.camera_rad = scope.start.camera_rad;
    s.goals.optic_rad = scope.start.optic_rad;
    return s;
}

void steer(Steering& s, const view::UserInput& input, const ToolsNow& now,
           double frame_s) noexcept {
    if (input.switch_tool)
        change_tool(s, now);
    const double pace = input.fine ? kFine : 1.0;
    const double time_s = std::clamp(frame_s, 0.0, 0.1);
    const tasks::View& seen = now.tick >= 0 ? now.scope.view : s.start_view;
    if (s.active == kScopeActive) {
        move_scope(s, input, seen, pace, time_s);
        return;
    }
    move_tool(s, input, seen, pace, time_s);
    move_jaw(s, input.jaw_closed || input.button[0]);
}

} // namespace sim
