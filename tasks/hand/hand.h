// tasks/hand/hand.h
// Scripted hands: where each hand wants its tool tip, millisecond by millisecond. A hand sees
// what a person would (late), plans movements of minimum jerk, and errs the way its skill says;
// the virtual device's grip then pulls the tool there and the tissue pushes back.
// One skill vector for all exercises, fitted to published motion data, not to scores.
#pragma once

#include "tasks/exercise/touch_points.h"

#include <memory>

namespace tasks {

struct HandSkill {
    std::string name = "expert";
    double reaction_s = 0.25; // between seeing and moving
    double speed_mps = 0.025; // peak of one movement
    double tremor_m = 33e-6;  // rms, 3-12 Hz
    double aim_m = 0.0015;    // sd of a movement's end point, tangential
    double depth_m = 0.0015;  // sd along the line of sight
    double force_sd = 0.15;   // sd of the pressed force, relative to what was wanted
    double lapse = 0.01;      // chance per target of the wrong tool or the wrong place
    double pause_s = 0.3;     // between movements
    double path_bow = 0.05;   // sideways detour, share of the distance
};
HandSkill skill_named(std::string_view name); // expert, intermediate, novice; throws otherwise

/// What the hand's owner perceives in this tick.
struct HandSight {
    std::int64_t tick = 0;
    Observation now;
    int next_target = 0;
    bool done = false;
};

struct HandGoals {
    std::array<glm::dvec3, kTools> tip_m{};
    std::array<double, kTools> jaw{};
};

/// The hand of one attempt. Deterministic in (skill, seed, what it saw).
class Hand {
  public:
    Hand(const HandSkill& skill, const TouchPoints& exercise, std::uint64_t seed,
         const std::array<glm::dvec3, kTools>& start_tip_m);
    HandGoals tick(const HandSight& sight);

  private:
    struct Impl;
    std::shared_ptr<Impl> impl_;
};

} // namespace tasks
