#include "sim/bridge/scope.h"

#include "haptics/device/mouse_device.h"

#include <glm/geometric.hpp>
#include <numbers>

namespace sim {
namespace {

constexpr std::uint8_t kPresent = 2, kFaulted = 4, kAssistant = 8, kMount = 16; // ScopeTrace

// The turn that is nearest to zero: counts do not wind up.
double short_turn(double rad) noexcept {
    return std::remainder(rad, 2.0 * std::numbers::pi);
}

} // namespace

ScopeInstrument make_scope(const std::optional<SceneScope>& scope, const tasks::View& view) {
    ScopeInstrument out;
    out.view = view;
    if (!scope)
        return out;
    out.fitted = true;
    out.scene = *scope;
    out.origin_m = haptics::handle_for_tip(scope->optics.trocar, scope->start.tip_m);
    return out;
}

tasks::ScopeTrace read_scope(ScopeInstrument& scope) noexcept {
    tasks::ScopeTrace out;
    if (!scope.fitted)
        return out;
    haptics::DeviceFault fault = haptics::DeviceFault::none;
    if (scope.device) {
        fault = scope.device->read(scope.sample);
        scope.device->write(glm::dvec3{0.0});
    }
    out.counts = scope.sample.counts;
    out.camera_counts = scope.sample.roll_counts;
    out.optic_counts = scope.sample.optic_counts;
    out.flags =
        static_cast<std::uint8_t>(kPresent | (fault != haptics::DeviceFault::none ? kFaulted : 0) |
                                  (scope.holder == ScopeHolder::mount       ? kMount
                                   : scope.holder == ScopeHolder::assistant ? kAssistant
                                                                            : 0));
    return out;
}

ScopeHolder holder_of(const tasks::ScopeTrace& counts) noexcept {
    return counts.flags & kMount       ? ScopeHolder::mount
           : counts.flags & kAssistant ? ScopeHolder::assistant
                                       : ScopeHolder::person;
}

ScopeNow look_through(const ScopeInstrument& scope, const tasks::ScopeTrace& counts) noexcept {
    ScopeNow now;
    now.view = scope.view;
    now.port_m = scope.view.eye_m;
    if (!scope.fitted || !(counts.flags & kPresent))
        return now;
    const haptics::Endoscope& optics = scope.scene.optics;
    const glm::dvec3 handle_m =
        scope.origin_m +
        scope.metres_per_count * glm::dvec3{counts.counts[0], counts.counts[1], counts.counts[2]};
    now.camera_rad = scope.scene.start.camera_rad + scope.rad_per_count * counts.camera_counts;
    now.optic_rad = scope.scene.start.optic_rad + scope.rad_per_count * counts.optic_counts;
    const haptics::EndoscopePicture picture = haptics::picture_of(
        optics, haptics::shaft_pose(optics.trocar, handle_m), now.camera_rad, now.optic_rad);
    now.view.eye_m = picture.eye_m;
    now.view.forward = picture.forward;
    now.view.up = picture.up;
    now.port_m = optics.trocar.fulcrum_m;
    now.horizon_rad = haptics::horizon_rad(picture, optics.up);
    now.holder = holder_of(counts);
    now.present = true;
    now.faulted = (counts.flags & kFaulted) != 0;
    return now;
}

void hold_scope(const ScopeInstrument& scope, const haptics::EndoscopeAim& aim,
                haptics::MouseDevice& device) noexcept {
    device.set_goal(haptics::handle_for_tip(scope.scene.optics.trocar, aim.tip_m) - scope.origin_m);
    device.set_turns(short_turn(aim.camera_rad - scope.scene.start.camera_rad) /
                         scope.rad_per_count,
                     short_turn(aim.optic_rad - scope.scene.start.optic_rad) / scope.rad_per_count);
}

void hold_scope(const ScopeInstrument& scope, const tasks::ScopeGoal& goal,
                haptics::MouseDevice& device) noexcept {
    hold_scope(scope,
               haptics::aim_at(scope.scene.optics, goal.look_at_m, goal.distance_m,
                               goal.near_m.value_or(scope.scene.start.tip_m), goal.horizon_rad),
               device);
}

tasks::ScopeGoal start_goal(const tasks::View& view, const glm::dvec3& look_at_m) noexcept {
    return {
        .given = true, .look_at_m = look_at_m, .distance_m = glm::distance(view.eye_m, look_at_m)};
}

} // namespace sim
