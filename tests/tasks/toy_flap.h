// tests/tasks/toy_flap.h
// A rig for the hands of find-tubes without the simulator: a springy plane with three tubes on it,
// hidden until the place to lift is up. That place follows the lifting tool while its jaws, closed
// near it, hold; an endoscope is where its hand wants it.
#pragma once

#include "tasks/hand/camera_hand.h"
#include "tasks/hand/find_hand.h"
#include "tests/tasks/tubes.h"

#include <glm/geometric.hpp>

namespace tasks::testing {

struct ToyFlap {
    Exercise exercise = three_tubes();
    std::array<glm::dvec3, kTools> start_tip_m{
        glm::dvec3{-0.03, 0.0, 0.06}, {0.03, 0.0, 0.06}, {0.0, -0.03, 0.06}};
    int misses = 0;                       // closings that will catch nothing
    std::vector<std::int64_t> slip_ticks; // what is held is lost then
    int grasps = 0, losses = 0, let_go = 0;
    double strayed_m = 0.0; // of what is held, from where it was brought to
    bool held = false, closed = false, up = false;
    glm::dvec3 held_at_m{0.0}; // from the tip
    Observation now;
    Progress progress;
};

inline constexpr double kLag_s = 0.02, kTip_m = 3e-3, kTissue_npm = 50.0;

inline ScopeGoal start_scope() {
    return {.given = true, .look_at_m = {0.0, 0.0, 0.0}, .distance_m = 0.2};
}

inline glm::dvec3& lifted_place_m(ToyFlap& rig) {
    return rig.now.target[rig.exercise.target.size()].position_m;
}

inline void hold_view(View& view, const ScopeGoal& goal) {
    view.forward = glm::normalize(glm::dvec3{0.0, 0.05, -0.15});
    view.up = glm::normalize(glm::dvec3{0.0, 0.15, 0.05});
    view.eye_m = goal.look_at_m - goal.distance_m * view.forward;
}

inline ToyFlap make_flap() {
    ToyFlap rig;
    rig.now = all_hidden(rig.exercise);
    rig.now.tick = -1;
    for (std::size_t t = 0; t < kTools; ++t)
        rig.now.tool[t].tip_m = rig.start_tip_m[t];
    hold_view(rig.now.view, start_scope());
    return rig;
}

inline void grip(ToyFlap& rig, double jaw) {
    ToolObservation& tool = rig.now.tool[static_cast<std::size_t>(rig.exercise.lift->role)];
    glm::dvec3& place_m = lifted_place_m(rig);
    const bool closes = jaw > 0.99 && !rig.closed;
    rig.closed = jaw > 0.99 || (rig.closed && jaw > 0.5);
    if (closes && rig.misses-- <= 0 && glm::distance(tool.tip_m, place_m) < 8e-3) {
        rig.held = true;
        rig.held_at_m = place_m - tool.tip_m;
        ++rig.grasps;
    }
    const bool slips = std::count(rig.slip_ticks.begin(), rig.slip_ticks.end(), rig.now.tick) > 0;
    rig.losses += rig.held && slips;
    rig.let_go += rig.held && !slips && !rig.closed;
    rig.held = rig.held && rig.closed && !slips;
    place_m = rig.held ? tool.tip_m + rig.held_at_m : rig.exercise.lift->at_m;
    const double away_m = glm::distance(place_m, rig.exercise.lift->to_m);
    rig.up = rig.held && (rig.up || away_m < 6e-3);
    rig.strayed_m = rig.up ? std::max(rig.strayed_m, away_m) : rig.strayed_m;
    tool.grasping = rig.held;
    if (rig.held)
        tool.force_n = {0.0, 0.0, -0.3};
}

inline void step(ToyFlap& rig, const HandGoals& goals, const ScopeGoal& scope) {
    ++rig.now.tick;
    for (std::size_t t = 0; t < kTools; ++t) {
        ToolObservation& tool = rig.now.tool[t];
        tool.tip_m += kTick_s / kLag_s * (goals.tip_m[t] - tool.tip_m);
        const double depth_m = kTip_m - tool.tip_m.z;
        tool.touching = depth_m > 0.0;
        tool.force_n = {0.0, 0.0, std::max(0.0, depth_m * kTissue_npm)};
        tool.contact_m = tool.tip_m - glm::dvec3{0.0, 0.0, kTip_m};
    }
    grip(rig, goals.jaw[static_cast<std::size_t>(rig.exercise.lift->role)]);
    hold_view(rig.now.view, scope);
    for (std::size_t k = 0; k < rig.exercise.target.size(); ++k)
        rig.now.target[k].clear_rays = lifted_place_m(rig).z > 0.02 ? kSightRays : 0;
    observe(rig.progress, rig.exercise, rig.now);
}

inline HandSight sight_of(const ToyFlap& rig) {
    return {.tick = rig.now.tick,
            .now = rig.now,
            .next_target = rig.progress.next,
            .found = found_tubes(rig.progress),
            .done = rig.progress.complete};
}

/// Two people, at the tools and at the endoscope, until completion or for so long.
inline void perform(ToyFlap& rig, FindHand& hand, CameraHand& camera, double seconds) {
    step(rig, {.tip_m = rig.start_tip_m}, start_scope());
    while (!rig.progress.complete && static_cast<double>(rig.now.tick) * kTick_s < seconds) {
        const HandSight sight = sight_of(rig);
        step(rig, hand.tick(sight), camera.tick(sight));
    }
}

inline ToyFlap performed(const HandSkill& skill, std::uint64_t seed, ToyFlap rig = make_flap()) {
    FindHand hand(skill, rig.exercise, seed, rig.start_tip_m);
    CameraHand camera(skill, rig.exercise, seed, start_scope());
    perform(rig, hand, camera, 300.0);
    return rig;
}

} // namespace tasks::testing
