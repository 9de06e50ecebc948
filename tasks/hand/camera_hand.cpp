#include "tasks/hand/camera_hand.h"

#include "tasks/exercise/find_tubes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tasks {
namespace {

constexpr double kCalm = 0.08;        // of the picture's height off the middle: no reason to move
constexpr double kCalmDistance = 0.1; // of the distance
constexpr double kToSpare = 1.25;     // times the size that a mark has to have
constexpr double kRoom = 1.3;         // times the way to a tool: what half a picture has to show
constexpr double kStill_mps = 4e-3;   // a tool that holds what it has lifted
constexpr double kStill_s = 0.5;
constexpr double kInterest_m = 25e-3; // a tool so near a tube is about to point at it
constexpr double kHorizon_s = 4.0;    // how slowly a camera head is turned unnoticed
// Half a camera head's width: the aim of the fingers on it is how level the picture is held.
constexpr double kCameraHead_m = 20e-3;

} // namespace

CameraHand::CameraHand(const HandSkill& skill, const Exercise& exercise, std::uint64_t seed,
                       const ScopeGoal& start)
    : skill_(skill), exercise_(exercise),
      random_(seed ^ 0xcafe5eedULL), tremor_{Random(seed ^ 0x5c09eULL), {}},
      usual_distance_m_(start.distance_m), seen_(skill.reaction_s), goal_(start),
      move_(plan_move(start.look_at_m, start.look_at_m, 1.0)), distance_from_m_(start.distance_m),
      distance_to_m_(start.distance_m) {
    goal_.given = true;
    move_.time_s = move_.duration_s;
}

// What has to be lifted is more than half-way up, and the tool that holds it has come to rest.
bool CameraHand::is_lifted(const HandSight& sight) {
    if (!exercise_.lift)
        return true;
    const ToolObservation& tool = sight.now.tool[static_cast<std::size_t>(exercise_.lift->role)];
    const bool still = glm::distance(tool.tip_m, lifter_m_) < kStill_mps * kTick_s;
    lifter_m_ = tool.tip_m;
    const bool up = tasks::is_lifted(exercise_, sight.now);
    still_ticks_ = up ? still_ticks_ + (still ? 1 : 0) : 0;
    return still_ticks_ * kTick_s > kStill_s;
}

// The one that somebody is about to point at; else the first that is not found.
std::size_t CameraHand::tube_of_interest(const HandSight& sight) const {
    const std::size_t tubes = exercise_.target.size();
    std::size_t first = tubes, nearest = tubes;
    double nearest_m = kInterest_m;
    for (std::size_t k = 0; k < tubes; ++k) {
        if (sight.found & (1U << k))
            continue;
        first = std::min(first, k);
        const auto tool = static_cast<std::size_t>(exercise_.target[k].role);
        const double distance_m =
            glm::distance(sight.now.tool[tool].tip_m, sight.now.target[k].position_m);
        if (distance_m < nearest_m) {
            nearest_m = distance_m;
            nearest = k;
        }
    }
    return nearest < tubes ? nearest : std::min(first, tubes - 1);
}

CameraHand::Gaze CameraHand::gaze_now(const HandSight& sight) {
    if (exercise_.kind != ExerciseKind::find_tubes) {
        const int last = static_cast<int>(exercise_.target.size()) - 1;
        const auto k = static_cast<std::size_t>(std::clamp(sight.next_target, 0, last));
        return {sight.now.target[k].position_m, usual_distance_m_};
    }
    // half-way between what is lifted and where it was: there is room for all who work on it
    if (!is_lifted(sight))
        return {0.5 * (exercise_.lift->at_m + sight.now.target[exercise_.target.size()].position_m),
                usual_distance_m_};
    // as near as the mark has to be large, but not before the tool that points is there too
    const std::size_t k = tube_of_interest(sight);
    const glm::dvec3& tube_m = sight.now.target[k].position_m;
    const auto tool = static_cast<std::size_t>(exercise_.target[k].role);
    const double away_m = glm::distance(sight.now.tool[tool].tip_m, tube_m);
    const double seen = std::tan(0.5 * sight.now.view.field_of_view_rad);
    const double near_m = exercise_.mark_radius_m / (kToSpare * exercise_.least_share * seen);
    return {tube_m, std::min(std::max(near_m, kRoom * away_m / seen), usual_distance_m_)};
}

void CameraHand::begin_move(const HandSight& sight, const Gaze& gaze) {
    move_ = aimed_move(skill_, random_, goal_.look_at_m, gaze.at_m, sight.now.view.forward);
    distance_from_m_ = goal_.distance_m;
    distance_to_m_ = gaze.distance_m;
    // as long as the longer of the two ways takes
    const double way_m = std::abs(distance_to_m_ - distance_from_m_);
    const MinimumJerk along =
        plan_move(glm::dvec3{0.0}, glm::dvec3{way_m, 0.0, 0.0}, skill_.speed_mps);
    move_.duration_s = std::max(move_.duration_s, along.duration_s);
}

// Somebody else holds the endoscope: what it looks at now, from as far as before, and at rest.
void CameraHand::follow(const HandSight& sight) {
    const View& view = sight.now.view;
    goal_.look_at_m = view.eye_m + goal_.distance_m * view.forward;
    goal_.horizon_rad = sight.now.horizon_rad;
    goal_.near_m = view.eye_m;
    move_ = plan_move(goal_.look_at_m, goal_.look_at_m, 1.0);
    move_.time_s = move_.duration_s;
    away_ticks_ = 0;
}

// An Ornstein-Uhlenbeck process whose spread is that of the fingers' aim on the camera head.
void CameraHand::let_horizon_drift() {
    const double spread = skill_.aim_m / kCameraHead_m;
    const double kick = spread * std::sqrt(2.0 * kTick_s / kHorizon_s) * random_.normal();
    goal_.horizon_rad += kick - kTick_s / kHorizon_s * goal_.horizon_rad;
}

ScopeGoal CameraHand::tick(const HandSight& sight) {
    seen_.push(gaze_now(sight));
    const Gaze& gaze = seen_.before(skill_.reaction_s);
    if (sight.scope_held) {
        follow(sight);
        return goal_;
    }
    let_horizon_drift();
    if (!arrived(move_)) {
        move_.time_s += kTick_s;
        goal_.look_at_m = place_m(move_);
        goal_.distance_m =
            distance_from_m_ + way_share(move_) * (distance_to_m_ - distance_from_m_);
    } else if (gaze.distance_m > 0.0) {
        const double height_m =
            2.0 * goal_.distance_m * std::tan(0.5 * sight.now.view.field_of_view_rad);
        const bool away =
            glm::distance(gaze.at_m, goal_.look_at_m) > kCalm * height_m + skill_.aim_m ||
            std::abs(gaze.distance_m - goal_.distance_m) > kCalmDistance * gaze.distance_m;
        away_ticks_ = away ? away_ticks_ + 1 : 0;
        if (away_ticks_ * kTick_s > skill_.pause_s)
            begin_move(sight, gaze);
    }
    ScopeGoal out = goal_;
    out.look_at_m += next_tremor_m(tremor_, skill_.tremor_m);
    return out;
}

} // namespace tasks
