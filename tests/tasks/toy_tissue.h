// tests/tasks/toy_tissue.h
// A rig for scripted hands without the simulator: a half-space of springs under the tips, and a
// device that follows the hand's goal with a lag and gives way to force as a grip does.
#pragma once

#include "tasks/hand/hand.h"
#include "tasks/score/metrics.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace tasks::testing {

struct ToyRig {
    Exercise exercise;
    double stiffness_npm = 50.0; // of the tissue under one tip, no friction
    double grip_npm = 400.0;
    double lag_s = 0.02; // of hand, device and tissue
    double tip_radius_m = 3e-3;
    glm::dvec3 wall_m{1e3, 0.0, 0.0}; // rigid: nothing beyond this x (off unless set)
    double sway_m = 0.0;              // targets move sideways, 0.2 Hz (breathing)

    std::array<glm::dvec3, kTools> start_tip_m{
        glm::dvec3{-0.03, 0.0, 0.04}, {0.03, 0.0, 0.04}, {0.0, -0.03, 0.04}};
    std::int64_t tick = 0;
    Observation now;
    Progress progress;
    ScoreState score;
};

inline double now_s(const ToyRig& rig) {
    return static_cast<double>(rig.tick) * kTick_s;
}

inline ToyRig make_rig(const Exercise& exercise) {
    ToyRig rig;
    rig.exercise = exercise;
    rig.now.view.eye_m = {0.0, -0.05, 0.15}; // looks obliquely, as an endoscope does
    rig.now.view.forward = glm::normalize(glm::dvec3{0.0, 0.05, -0.15});
    rig.now.view.up = glm::normalize(glm::dvec3{0.0, 0.15, 0.05});
    rig.now.targets = static_cast<int>(exercise.target.size());
    for (int t = 0; t < kTools; ++t)
        rig.now.tool[t].tip_m = rig.start_tip_m[t];
    return rig;
}

/// Nine targets within 60 mm, on the plane z = 0, three for each tool.
inline Exercise nine_points() {
    Exercise exercise;
    const double place[9][2] = {{30, 20}, {-35, 5},  {12, 25},   {0, 0},    {-18, 26},
                                {38, 4},  {15, -14}, {-40, -18}, {-22, -12}};
    const Role role[9] = {Role::right, Role::left,   Role::right, Role::assist, Role::left,
                          Role::right, Role::assist, Role::left,  Role::assist};
    for (int i = 0; i < 9; ++i)
        exercise.target.push_back(
            {std::to_string(i + 1), role[i], 1e-3 * glm::dvec3{place[i][0], place[i][1], 0.0}});
    return exercise;
}

inline constexpr double kWall_npm = 5000.0;

/// A spring `grip` to the goal against a spring `other` that begins at `edge` and acts beyond it.
inline double series(double goal_m, double edge_m, double grip, double other, double beyond) {
    const double into_m = beyond * (goal_m - edge_m);
    return into_m > 0.0 ? edge_m + beyond * into_m * grip / (grip + other) : goal_m;
}

inline void push_back_tip(const ToyRig& rig, ToolObservation& tool) {
    const double depth_m = rig.tip_radius_m - tool.tip_m.z;
    const double beyond_m = tool.tip_m.x - rig.wall_m.x;
    tool.touching = depth_m > 0.0 || beyond_m > 0.0;
    tool.force_n = {beyond_m > 0.0 ? -kWall_npm * beyond_m : 0.0, 0.0,
                    depth_m > 0.0 ? rig.stiffness_npm * depth_m : 0.0};
    tool.contact_m = tool.tip_m - glm::dvec3{0.0, 0.0, rig.tip_radius_m};
}

inline void step(ToyRig& rig, const HandGoals& goals) {
    rig.now.tick = rig.tick;
    for (int t = 0; t < kTools; ++t) {
        ToolObservation& tool = rig.now.tool[t];
        // Where the grip and what it presses on balance; the tip comes there with the lag.
        glm::dvec3 balance = goals.tip_m[t];
        balance.z = series(balance.z, rig.tip_radius_m, rig.grip_npm, rig.stiffness_npm, -1.0);
        balance.x = series(balance.x, rig.wall_m.x, rig.grip_npm, kWall_npm, 1.0);
        tool.tip_m += kTick_s / rig.lag_s * (balance - tool.tip_m);
        push_back_tip(rig, tool);
    }
    const double sway_m = rig.sway_m * std::sin(2.0 * std::numbers::pi * 0.2 * now_s(rig));
    for (int k = 0; k < rig.now.targets; ++k) {
        glm::dvec3& place = rig.now.target[k].position_m;
        place = rig.exercise.target[k].at_m + glm::dvec3{sway_m, 0.0, 0.0};
        for (const ToolObservation& tool : rig.now.tool) { // the dimple under a tip, 6 mm wide
            const double away_m = glm::distance(glm::dvec2(tool.tip_m), glm::dvec2(place));
            const double depth_m = std::max(0.0, rig.tip_radius_m - tool.tip_m.z);
            place.z -= depth_m * std::exp(-std::pow(away_m / 6e-3, 2));
        }
    }
    observe(rig.progress, rig.exercise, rig.now);
    ++rig.tick;
}

/// Runs, or runs on, until completion or `limit_s`; any hand with tick(HandSight).
template <typename AnyHand> void perform(ToyRig& rig, AnyHand& hand, double limit_s) {
    HandSight sight;
    if (rig.tick == 0)
        step(rig, {rig.start_tip_m, {}});
    while (!rig.progress.complete && now_s(rig) < limit_s) {
        sight.tick = rig.tick;
        sight.now = rig.now;
        sight.next_target = rig.progress.next;
        sight.done = rig.progress.complete;
        step(rig, hand.tick(sight));
        observe(rig.score, rig.now);
    }
}

} // namespace tasks::testing
