// sim/command/stage.cpp
#include "sim/command/stage.h"

#include "tasks/exercise/path_curve.h"

#include <algorithm>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace sim {
namespace {

view::Role role_of(tasks::Role role) {
    return role == tasks::Role::left    ? view::Role::left
           : role == tasks::Role::right ? view::Role::right
                                        : view::Role::assist;
}

std::vector<glm::vec3> single(const std::vector<glm::dvec3>& from) {
    std::vector<glm::vec3> to;
    to.reserve(from.size());
    for (const glm::dvec3& p : from)
        to.emplace_back(p);
    return to;
}

// A tip stays where the shaft can reach: between the port and the end of the shaft.
glm::dvec3 reachable(const haptics::Trocar& trocar, const glm::dvec3& tip_m) {
    const glm::dvec3 from = tip_m - trocar.fulcrum_m;
    const double length = std::max(1e-6, glm::length(from));
    const double allowed = std::clamp(length, trocar.min_insertion_m + 5e-3,
                                      trocar.shaft_m - trocar.min_outside_m - 5e-3);
    return trocar.fulcrum_m + from * (allowed / length);
}

} // namespace

Stage::Stage(const Session& session, bool by_hand, int first_surface_id)
    : session_(session), by_hand_(by_hand) {
    for (std::size_t b = 0; b < session.tissue.bodies.size(); ++b) {
        const Body& body = session.tissue.bodies[b];
        rest_m_.push_back(single(body.organ->surface.rest_m));
        rest_normal_.push_back(single(body.skin_normal));
    }
    for (std::size_t b = 0; b < rest_m_.size(); ++b) {
        frame_.surfaces.push_back({.id = first_surface_id + static_cast<int>(b),
                                   .look = session.scene.scene.organ[b].look,
                                   .triangles = session.tissue.bodies[b].organ->surface.triangles,
                                   .rest_m = rest_m_[b],
                                   .position_m = rest_m_[b],
                                   .normal = rest_normal_[b]});
    }
    const tasks::View& seen = session.scene.scene.view;
    frame_.camera = {.eye_m = seen.eye_m,
                     .look_at_m = seen.eye_m + seen.forward,
                     .up = seen.up,
                     .field_of_view_deg = glm::degrees(seen.field_of_view_rad)};
    frame_.force = {.band_min_n = session.exercise.force_min_n,
                    .band_max_n = session.exercise.force_max_n,
                    .limit_n = session.exercise.force_limit_n};
    frame_.time_limit_s = double(session.max_ticks) * kTick_s;
    frame_.felt = !by_hand;
    for (int i = 0; i < kTools; ++i)
        goals_.tip_m[i] = session.scene.scene.tool[i].start_tip_m;
}

void Stage::show_tools(const ToolsNow& now) {
    for (int i = 0; i < kTools; ++i) {
        const SceneTool& tool = session_.scene.scene.tool[i];
        view::ToolView& to = frame_.tools[i];
        to.role = role_of(tool.role);
        to.present = true;
        to.active = by_hand_ && i == active_;
        to.assistant = by_hand_ && i != active_;
        to.fulcrum_m = tool.trocar.fulcrum_m;
        to.tip_radius_m = tool.tip_radius_m;
        if (now.tick < 0) {
            to.tip_m = tool.start_tip_m;
            to.direction = glm::normalize(tool.start_tip_m - tool.trocar.fulcrum_m);
            continue;
        }
        to.tip_m = now.tip[i].centre_m;
        to.direction = now.shaft[i].direction;
        to.roll_rad = now.roll_rad[i];
        to.jaw = now.jaw[i];
        to.touching = now.touching[i];
        to.force_n = now.force_n[i];
        to.felt_share = now.felt_share[i];
        to.faulted = now.faulted[i];
    }
    frame_.time_s = std::max(0.0, double(now.tick) * kTick_s);
}

void Stage::show_targets(const TargetPlaces& target_um, const ProgressNow& progress) {
    frame_.targets.clear();
    for (std::size_t t = 0; t < session_.exercise.target.size(); ++t) {
        view::TargetView target;
        target.number = static_cast<int>(t) + 1;
        target.role = role_of(session_.exercise.target[t].role);
        const int index = static_cast<int>(t);
        target.state = index < progress.next_target    ? view::TargetState::done
                       : index == progress.next_target ? view::TargetState::next
                                                       : view::TargetState::waiting;
        for (int axis = 0; axis < 3; ++axis)
            target.position_m[axis] = target_um[t][axis] * 1e-6;
        target.normal = session_.rest_targets[t].normal;
        target.radius_m = session_.exercise.radius_m;
        target.hold_share = index == progress.next_target ? progress.hold_share : 0.0;
        frame_.targets.push_back(target);
    }
}

// Of the points of a path only the first, the last and the one that comes now keep their marks.
void Stage::show_path(const ProgressNow& progress) {
    if (session_.exercise.kind != tasks::ExerciseKind::follow_path || frame_.targets.size() < 2)
        return;
    view::PathView& path = frame_.path;
    path.role = frame_.targets.front().role;
    path.radius_m = session_.exercise.radius_m;
    path.place_m.clear();
    path.normal.clear();
    std::vector<glm::dvec3> points;
    for (const view::TargetView& target : frame_.targets)
        points.push_back(target.position_m);
    const int last = static_cast<int>(points.size()) - 1;
    const int pieces = tasks::kPiecesPerPoint * last;
    for (int i = 0; i <= pieces; ++i) {
        const double u = static_cast<double>(i) / tasks::kPiecesPerPoint;
        const auto k = static_cast<std::size_t>(u);
        const glm::dvec3& n0 = frame_.targets[k].normal;
        const glm::dvec3& n1 = frame_.targets[std::min(k + 1, points.size() - 1)].normal;
        path.place_m.push_back(tasks::curve_at(points, u));
        path.normal.push_back(glm::normalize(glm::mix(n0, n1, u - static_cast<double>(k))));
    }
    const double passed =
        progress.complete ? last : std::max(0.0, progress.next_target - 1 + progress.hold_share);
    path.done = std::min(1.0, passed / last);
    std::erase_if(frame_.targets, [&](const view::TargetView& target) {
        return target.number != 1 && target.number != last + 1 &&
               target.state != view::TargetState::next;
    });
    for (view::TargetView& target : frame_.targets) {
        target.radius_m = 3e-3; // the corridor is the ribbon's to show
        target.hold_share = 0.0;
    }
}

const view::ViewFrame& Stage::frame(Exchange& exchange) {
    const SurfaceNow& surface = exchange.surface.latest();
    if (surface.step >= 0) {
        for (std::size_t b = 0; b < frame_.surfaces.size(); ++b) {
            frame_.surfaces[b].position_m = surface.position_m[b];
            frame_.surfaces[b].normal = surface.normal[b];
        }
    }
    progress_ = exchange.progress_seen.latest();
    show_tools(exchange.tools_seen.latest());
    show_targets(surface.step >= 0 ? surface.target_um : session_.rest_target_um, progress_);
    show_path(progress_);
    frame_.errors = progress_.errors;
    frame_.forces_on = !exchange.zero_forces.load();
    frame_.recorder = session_.recorded ? view::Recorder::recording : view::Recorder::off;
    frame_.messages = {"Not a medical device"};
    if (by_hand_)
        frame_.messages.push_back("Mouse and keyboard: forces are drawn, not felt");
    if (!note_.empty())
        frame_.messages.push_back(note_);
    return frame_;
}

void Stage::steer(const view::UserInput& input, double frame_s, Exchange& exchange) {
    if (!by_hand_)
        return;
    if (input.switch_tool)
        active_ = (active_ + 1) % kTools;
    const tasks::View& seen = session_.scene.scene.view;
    const glm::dvec3 right = glm::cross(seen.forward, seen.up);
    constexpr double kMetresPerPixel = 0.15e-3, kMetresPerNotch = 2e-3, kKeySpeed_mps = 0.036;
    const double pace = input.fine ? 0.25 : 1.0;
    const glm::dvec3 keys = kKeySpeed_mps * std::clamp(frame_s, 0.0, 0.1) * input.move;
    const glm::dvec3 offset = (kMetresPerPixel * input.mouse_px.x + keys.x) * right +
                              (kMetresPerPixel * input.mouse_px.y + keys.y) * seen.up +
                              (kMetresPerNotch * input.wheel - keys.z) * seen.forward;
    goals_.tip_m[active_] =
        reachable(session_.scene.scene.tool[active_].trocar, goals_.tip_m[active_] + pace * offset);
    goals_.jaw[active_] = input.jaw_closed || input.button[0] ? 1.0 : 0.0;
    exchange.pointer.back() = goals_;
    exchange.pointer.publish();
}

void leave_cores_to_the_loops() {
    setenv("LP_NUM_THREADS", "1", 0);
}

} // namespace sim
