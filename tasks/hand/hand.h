// tasks/hand/hand.h
// Scripted hands: where each hand wants its tool tip, millisecond by millisecond. A hand sees
// what a person would (late), plans movements of minimum jerk, and errs the way its skill says;
// the virtual device's grip then pulls the tool there and the tissue pushes back.
// One skill vector for all exercises, fitted to published motion data, not to scores.
// Called by sim once a tick, in the thread that owns the tick; not inside the 1 kHz budget.
#pragma once

#include "tasks/hand/late.h"
#include "tasks/hand/motion.h"
#include "tasks/hand/sight.h"
#include "tasks/hand/trace.h"

namespace tasks {

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
    Late<Percept> seen_;

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
