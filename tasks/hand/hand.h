// tasks/hand/hand.h
// Scripted hands: where each hand wants its tool tip, millisecond by millisecond. A hand sees
// what a person would (late), plans movements of minimum jerk, and errs the way its skill says;
// the virtual device's grip then pulls the tool there and the tissue pushes back.
// One skill vector for all exercises, fitted to published motion data, not to scores.
// Called by sim once a tick, in the thread that owns the tick; not inside the 1 kHz budget.
#pragma once

#include "tasks/exercise/exercise.h"
#include "tasks/hand/motion.h"
#include "tasks/hand/trace.h"

#include <string>
#include <vector>

namespace tasks {

struct HandSkill {
    std::string name = "expert";
    double reaction_s = 0.25; // between seeing and moving; touch is felt in 0.6 of it
    double speed_mps = 0.055; // peak of one long movement
    double tremor_m = 33e-6;  // rms, 3-12 Hz
    double aim_m = 0.0010;    // sd of a movement's end point, across the line of sight
    double depth_m = 0.0015;  // sd along the line of sight
    double force_sd = 0.15;   // sd of ln(pressed force / what was wanted)
    double lapse = 0.01;      // chance per target of the wrong tool or the wrong place
    double pause_s = 0.3;     // between movements
    double path_bow = 0.12;   // sideways detour, sd as a share of the distance
    double stride_m = 0.060;  // longest way that is planned as one movement
    double plan_s = 0.3;      // to find the next target and decide, beside the reaction
};
/// expert, intermediate, novice, fast-careless, slow-precise; throws std::invalid_argument.
HandSkill skill_named(std::string_view name);
/// The same pace and habits without a single error: no noise, no lapse.
HandSkill without_errors(HandSkill skill);

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

/// One person with three tools, one of them active at a time. Deterministic in (skill, seed, what
/// it saw). A plan for one target: travel in strides to a point above it, look and correct, go
/// down until it is felt, press, hold until the task moves on, lift. A path is taken up in the same
/// way where it was left, and drawn along as long as the force is right. What takes too long, meets
/// something on the way or is not found ends in a lift and another try.
class Hand {
  public:
    Hand(const HandSkill& skill, const Exercise& exercise, std::uint64_t seed,
         const std::array<glm::dvec3, kTools>& start_tip_m);
    HandGoals tick(const HandSight& sight);

  private:
    enum class Phase { wait, travel, look, press, trace, lift, finished };
    enum class Lift { pressing, free, blocked }; // still on the tissue; off it; met something
    struct Percept {
        std::array<double, kTools> force_n{};
        glm::dvec3 aside_m{0.0}; // of the path
        int next_target = 0;
        bool done = false;
    };

    const Percept& perceived(double delay_s) const;
    glm::dvec3 line_of_sight(const HandSight& sight) const;
    void pause(double seconds);
    void decide(const HandSight& sight);
    void lapse(const HandSight& sight);
    void next_stride(const HandSight& sight);
    void move_to(const HandSight& sight, const glm::dvec3& to_m, const glm::dvec3& bow_m);
    void follow_move(const HandSight& sight);
    void look(const HandSight& sight);
    void begin_descent(const HandSight& sight);
    void keep_pressing(const HandSight& sight);
    void keep_tracing(const HandSight& sight);
    void lift_off(std::size_t t, const glm::dvec3& normal);
    void lift_to(const glm::dvec3& to_m);

    HandSkill skill_;
    Exercise exercise_;
    Random random_;
    std::array<Tremor, kTools> tremor_;
    std::array<glm::dvec3, kTools> goal_m_;
    std::vector<Percept> past_; // ring, one entry a tick
    std::size_t at_ = 0;

    Phase phase_ = Phase::wait;
    Lift lift_ = Lift::pressing;
    int wait_ticks_ = 0, phase_ticks_ = 0;
    int tool_ = 0, target_ = -1;
    bool mistaken_ = false;    // this try is a lapse
    glm::dvec3 offset_m_{0.0}; // of the wrong place from the right one
    double clearance_m_ = 0.0; // hover height; grows when something was in the way
    glm::dvec3 normal_{0, 0, 1}, route_from_m_{0.0}, hover_m_{0.0}, descent_from_m_{0.0};
    glm::dvec3 offset_seen_m_{0.0}; // tip beside the target when it starts down
    int strides_ = 1, stride_ = 0, corrections_ = 0, held_ticks_ = 0;
    MinimumJerk move_;
    Press press_;
    Trace trace_;
};

} // namespace tasks
