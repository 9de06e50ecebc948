// tasks/hand/camera_hand.h
// A scripted person at the endoscope: keeps what the others work on in the middle of the picture,
// near enough to be seen well, and the horizon level, as well as the skill allows. Moves when the
// work has left the middle, and not for every tremor. Called by sim once a tick.
#pragma once

#include "tasks/hand/late.h"
#include "tasks/hand/motion.h"
#include "tasks/hand/sight.h"

namespace tasks {

class CameraHand {
  public:
    /// `start`: how the endoscope is held at first.
    CameraHand(const HandSkill& skill, const Exercise& exercise, std::uint64_t seed,
               const ScopeGoal& start);
    ScopeGoal tick(const HandSight& sight);

  private:
    struct Gaze {
        glm::dvec3 at_m{0.0};
        double distance_m = 0.0;
    };
    Gaze gaze_now(const HandSight& sight);
    bool is_lifted(const HandSight& sight);
    std::size_t tube_of_interest(const HandSight& sight) const;
    void follow(const HandSight& sight);
    void begin_move(const HandSight& sight, const Gaze& gaze);
    void let_horizon_drift();

    HandSkill skill_;
    Exercise exercise_;
    Random random_;
    Tremor tremor_;
    double usual_distance_m_;
    Late<Gaze> seen_;
    ScopeGoal goal_;
    MinimumJerk move_; // of the place that is looked at
    double distance_from_m_, distance_to_m_;
    glm::dvec3 lifter_m_{0.0};
    int still_ticks_ = 0, away_ticks_ = 0;
};

} // namespace tasks
