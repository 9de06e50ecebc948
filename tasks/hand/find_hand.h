// tasks/hand/find_hand.h
// The scripted person of find-tubes, at all tools: takes hold of what hides the tubes and lifts it,
// keeps it up, and points at one tube after the other with the tool it is for. Errs as Hand does,
// by the same skill. What slips, is missed or is not counted is tried again.
// What somebody else holds is his job: it follows those tools, and does the rest.
// Called by sim once a tick; the endoscope is CameraHand's.
#pragma once

#include "tasks/hand/late.h"
#include "tasks/hand/motion.h"
#include "tasks/hand/sight.h"

namespace tasks {

class FindHand {
  public:
    FindHand(const HandSkill& skill, const Exercise& exercise, std::uint64_t seed,
             const std::array<glm::dvec3, kTools>& start_tip_m);
    HandGoals tick(const HandSight& sight);

  private:
    enum class Phase { wait, travel, look, descend, close, lift, point, leave, finished };
    struct Percept {
        std::array<double, kTools> force_n{};
        std::array<bool, kTools> touching{};
        bool holding = false; // what has to be lifted, and it comes along
        std::uint32_t found = 0;
        bool done = false;
    };

    glm::dvec3& goal() { return goal_m_[static_cast<std::size_t>(tool_)]; }
    glm::dvec3 place_wanted(const HandSight& sight) const; // of the tip, for this job
    glm::dvec3 line_of_sight(const HandSight& sight, const glm::dvec3& to_m) const;
    Percept percept_of(const HandSight& sight) const;
    void pause(double seconds);
    void decide(const HandSight& sight);
    bool choose_job(const HandSight& sight);
    int choose_tube(const HandSight& sight) const;
    void lapse(const HandSight& sight);
    void follow(const HandSight& sight);
    void next_stride(const HandSight& sight);
    void travel(const HandSight& sight);
    void look(const HandSight& sight);
    void descend(const HandSight& sight);
    struct SeenError {
        glm::dvec3 across_m{0.0}, line{0.0, 0.0, -1.0}; // line: of sight, unit
        double depth_m = 0.0;                           // along it
    };
    SeenError see_error(const HandSight& sight);
    void correct(const HandSight& sight, const SeenError& error);
    void close_jaws();
    void begin_lift();
    bool hangs(const HandSight& sight) const;
    void keep_lifting(const HandSight& sight);
    void keep_pointing(const HandSight& sight);
    void back_off(const glm::dvec3& way_m);

    HandSkill skill_;
    Exercise exercise_;
    Random random_;
    std::array<Tremor, kTools> tremor_;
    std::array<glm::dvec3, kTools> goal_m_;
    std::array<double, kTools> jaw_{};
    Late<Percept> seen_;

    Phase phase_ = Phase::wait;
    int phase_ticks_ = 0, wait_ticks_ = 0;
    bool lifting_ = false; // this job; else pointing
    int tool_ = 0, tube_ = -1;
    bool mistaken_ = false;
    glm::dvec3 offset_m_{0.0}; // of the wrong place from the right one
    glm::dvec3 route_from_m_{0.0}, route_to_m_{0.0};
    double room_m_; // above the place, before going down or near
    double deep_m_ = 0.0;
    int lifts_ = 0, heavy_ticks_ = 0; // tries with what is held; it resists
    int strides_ = 1, stride_ = 0, corrections_ = 0;
    bool near_ = false; // pointing: at the tube, not above it
    MinimumJerk move_;
};

} // namespace tasks
