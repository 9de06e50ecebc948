// sim/command/stage.cpp
#include "sim/command/stage.h"

#include "tasks/exercise/find_hint.h"
#include "tasks/exercise/path_curve.h"

#include <algorithm>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace sim {
namespace {

view::Role role_of(tasks::Role role) {
    return static_cast<view::Role>(role); // in the same order
}

std::vector<glm::vec3> single(const std::vector<glm::dvec3>& from) {
    std::vector<glm::vec3> to;
    to.reserve(from.size());
    for (const glm::dvec3& p : from)
        to.emplace_back(p);
    return to;
}

glm::dvec3 place_of(const std::array<std::int32_t, 3>& um) {
    return 1e-6 * glm::dvec3{um[0], um[1], um[2]};
}

// What the exercise sees, as far as the next hint needs it: tools, endoscope, places.
tasks::Observation observed(const ToolsNow& now, std::span<const view::TargetView> targets) {
    tasks::Observation seen;
    seen.view = now.scope.view;
    seen.targets = static_cast<int>(targets.size());
    for (std::size_t t = 0; t < targets.size(); ++t) {
        seen.target[t].position_m = targets[t].position_m;
        seen.target[t].clear_rays = now.clear_rays[t];
    }
    for (int i = 0; i < kTools; ++i) {
        seen.tool[i].tip_m = now.tip[i].centre_m;
        seen.tool[i].grasping = now.grasping[i];
    }
    return seen;
}

view::Camera camera_of(const tasks::View& seen) {
    return {.eye_m = seen.eye_m,
            .look_at_m = seen.eye_m + seen.forward,
            .up = seen.up,
            .field_of_view_deg = glm::degrees(seen.field_of_view_rad)};
}

} // namespace

Stage::Stage(const Session& session, bool by_hand, int first_surface_id)
    : session_(session), by_hand_(by_hand), steering_(begin_steering(session)) {
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
    frame_.camera = camera_of(session.scene.scene.view);
    const bool banded = session.exercise.kind != tasks::ExerciseKind::find_tubes;
    frame_.force = {.band_min_n = banded ? session.exercise.force_min_n : 0.0,
                    .band_max_n = banded ? session.exercise.force_max_n : 0.0,
                    .limit_n = session.exercise.force_limit_n};
    frame_.time_limit_s = double(session.max_ticks) * kTick_s;
    frame_.felt = !by_hand;
}

void Stage::show_tools(const ToolsNow& now) {
    for (int i = 0; i < kTools; ++i) {
        const SceneTool& tool = session_.scene.scene.tool[i];
        view::ToolView& to = frame_.tools[i];
        to.role = role_of(tool.role);
        to.present = true;
        to.active = by_hand_ && i == steering_.active;
        to.assistant = by_hand_ && !steering_.goals.held[i];
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

void Stage::show_scope(const ToolsNow& now) {
    view::ScopeView& to = frame_.scope;
    to.present = session_.scene.scene.scope.has_value();
    to.active = by_hand_ && steering_.active == kScopeActive;
    if (now.tick < 0)
        return;
    frame_.camera = camera_of(now.scope.view);
    to.assistant = now.scope.holder == ScopeHolder::assistant;
    to.faulted = now.scope.faulted;
    to.horizon_rad = now.scope.horizon_rad;
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
        target.position_m = place_of(target_um[t]);
        target.normal = session_.rest_targets[t].normal;
        target.radius_m = session_.exercise.radius_m;
        target.hold_share = index == progress.next_target ? progress.hold_share : 0.0;
        frame_.targets.push_back(target);
    }
}

// Tubes in any order, the place to lift until it is up, and what is missing now.
void Stage::show_search(const ToolsNow& now, const TargetPlaces& target_um,
                        const ProgressNow& progress) {
    const tasks::Exercise& exercise = session_.exercise;
    if (exercise.kind != tasks::ExerciseKind::find_tubes)
        return;
    const std::size_t tubes = exercise.target.size();
    if (exercise.lift) {
        view::TargetView lift;
        lift.role = role_of(exercise.lift->role);
        lift.lift = true;
        lift.position_m = place_of(target_um[tubes]);
        lift.normal = session_.rest_targets[tubes].normal;
        frame_.targets.push_back(lift);
    }
    const tasks::Observation seen = observed(now, frame_.targets);
    const tasks::FindHint hint = tasks::find_hint(exercise, seen, progress.found);
    for (std::size_t t = 0; t < frame_.targets.size(); ++t) {
        view::TargetView& target = frame_.targets[t];
        target.buried = true;
        const bool next = target.lift ? hint.lift : !hint.lift && int(t) == hint.tube;
        target.state = !target.lift && (progress.found & (1U << t)) ? view::TargetState::done
                       : next                                       ? view::TargetState::next
                                                                    : view::TargetState::waiting;
        target.radius_m = exercise.mark_radius_m;
        target.hold_share = next && !target.lift ? progress.hold_share : 0.0;
    }
    if (exercise.lift && !hint.lift && tasks::is_lifted(exercise, seen))
        frame_.targets.pop_back();
    frame_.hint = hint.words;
    frame_.ring_share = hint.tube >= 0 && !hint.lift ? exercise.centre_share : 0.0;
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
    const ToolsNow& tools = exchange.tools_seen.latest();
    show_tools(tools);
    show_scope(tools);
    const TargetPlaces& places = surface.step >= 0 ? surface.target_um : session_.rest_target_um;
    show_targets(places, progress_);
    show_search(tools, places, progress_);
    show_path(progress_);
    frame_.errors = progress_.errors;
    frame_.forces_on = !exchange.zero_forces.load();
    frame_.recorder = session_.recorded ? view::Recorder::recording : view::Recorder::off;
    frame_.messages.clear(); // that it is not a medical device the foot line says
    if (by_hand_)
        frame_.messages.push_back("Mouse and keyboard: forces are drawn, not felt");
    if (!note_.empty())
        frame_.messages.push_back(note_);
    return frame_;
}

void Stage::steer(const view::UserInput& input, double frame_s, Exchange& exchange) {
    if (!by_hand_)
        return;
    sim::steer(steering_, input, exchange.tools_seen.latest(), frame_s);
    exchange.pointer.back() = steering_.goals;
    exchange.pointer.publish();
}

void leave_cores_to_the_loops() {
    setenv("LP_NUM_THREADS", "1", 0);
}

} // namespace sim
