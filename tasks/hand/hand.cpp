#include "tasks/hand/hand.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tasks {
namespace {

constexpr double kHover_m = 10e-3;   // tip centre above the target before going down
constexpr double kRest_m = 18e-3;    // tip centre above the tissue when a tool is left alone
constexpr double kMoreRoom_m = 4e-3; // added to the hover after each bump
constexpr double kMostRoom_m = 30e-3;
constexpr double kArc = 0.15;       // height of a route over its straight line: swing over tissue
constexpr double kFeelShare = 0.6;  // touch is quicker than sight
constexpr double kBump_n = 0.06;    // felt on the way: something is there
constexpr double kBackOff_m = 4e-3; // from what a lift has met
constexpr double kLeash_m = 12e-3;  // goal ahead of the tip: blocked, do not pull harder
constexpr double kDepthSeen = 0.5;  // share of the depth error that a second look still leaves
constexpr double kApproachShare = 0.3; // of the speed, going down
constexpr double kNotFound_m = 14e-3;  // past the place where the tissue should have been
constexpr double kGiveUp_s = 3.0;      // no push, and no blocked movement, goes on longer
constexpr double kNotice_s = 0.4;      // pressing well and nothing happens: something is wrong
constexpr double kWanted = 0.3;        // where in the force band people press: gently
constexpr double kPursuit_s = 0.3;     // smooth pursuit of a target that moves
constexpr double kTraceShare = 0.3;    // of the speed, drawing along a line
constexpr double kCalm = 4.0;          // of its scatter: so wide a path takes no care
constexpr double kPursuitDelays = 2.5; // of the eye: quicker corrections would swing
constexpr int kMaxCorrections = 4;

/// Where what is touched pushes the tip; zero in the air.
glm::dvec3 push_of(const ToolObservation& tool) {
    const double force_n = glm::length(tool.force_n);
    return force_n > 0.0 ? tool.force_n / force_n : glm::dvec3{0.0};
}

int ticks(double seconds) {
    return static_cast<int>(std::lround(seconds / kTick_s));
}

} // namespace

Hand::Hand(const HandSkill& skill, const Exercise& exercise, std::uint64_t seed,
           const std::array<glm::dvec3, kTools>& start_tip_m)
    : skill_(skill), exercise_(exercise), random_(seed), goal_m_(start_tip_m),
      seen_(skill.reaction_s), clearance_m_(kHover_m) {
    for (std::size_t t = 0; t < kTools; ++t)
        tremor_[t].random = Random(seed ^ (0x9e3779b97f4a7c15u * (t + 1)));
    pause(skill_.reaction_s + skill_.plan_s);
}

glm::dvec3 Hand::line_of_sight(const HandSight& sight) const {
    const glm::dvec3 to = hover_m_ - sight.now.view.eye_m;
    return glm::length(to) > 1e-3 ? glm::normalize(to) : sight.now.view.forward;
}

void Hand::pause(double seconds) {
    phase_ = Phase::wait;
    wait_ticks_ = ticks(seconds);
}

// Which target, which tool, which place; then the way there.
void Hand::decide(const HandSight& sight) {
    const Percept& seen = seen_.before(skill_.reaction_s);
    if (seen.done || seen.next_target >= static_cast<int>(exercise_.target.size())) {
        phase_ = Phase::finished;
        return;
    }
    const bool path = exercise_.kind == ExerciseKind::follow_path;
    const int wanted = path ? std::max(0, seen.next_target - 1) : seen.next_target;
    const bool fresh = wanted != target_;
    target_ = wanted;
    const auto k = static_cast<std::size_t>(target_);
    tool_ = static_cast<int>(exercise_.target[k].role);
    normal_ = sight.now.target[k].normal;
    offset_m_ = glm::dvec3{0.0};
    mistaken_ = false;
    if (fresh) {
        clearance_m_ = kHover_m;
        if (random_.uniform() < skill_.lapse)
            lapse(sight);
    }
    hover_m_ = sight.now.target[k].position_m + offset_m_ + clearance_m_ * normal_;
    route_from_m_ = goal_m_[static_cast<std::size_t>(tool_)];
    const double way_m = glm::distance(route_from_m_, hover_m_);
    strides_ = std::max(1, static_cast<int>(std::ceil(way_m / skill_.stride_m)));
    stride_ = corrections_ = 0;
    next_stride(sight);
}

// The wrong tool, or a place on the tissue 4-7 radii away, where there is most room between
// targets.
void Hand::lapse(const HandSight& sight) {
    mistaken_ = true;
    if (random_.uniform() < 0.5) {
        tool_ = (tool_ + (random_.uniform() < 0.5 ? 1 : 2)) % kTools;
        return;
    }
    const glm::dvec3 side = glm::normalize(
        glm::cross(normal_, std::abs(normal_.x) < 0.7 ? glm::dvec3{1, 0, 0} : glm::dvec3{0, 1, 0}));
    const glm::dvec3 other = glm::cross(normal_, side);
    const glm::dvec3 right = sight.now.target[static_cast<std::size_t>(target_)].position_m;
    double most_room_m = 0.0;
    for (int i = 0; i < 6; ++i) {
        const double angle = 2.0 * std::numbers::pi * random_.uniform();
        const double far_m = exercise_.radius_m * (4.0 + 3.0 * random_.uniform());
        const glm::dvec3 offset = far_m * (std::cos(angle) * side + std::sin(angle) * other);
        double room_m = 1.0;
        for (int k = 0; k < sight.now.targets; ++k) {
            const Target& target = sight.now.target[static_cast<std::size_t>(k)];
            room_m = std::min(room_m, glm::distance(right + offset, target.position_m));
        }
        if (room_m > most_room_m) {
            most_room_m = room_m;
            offset_m_ = offset;
        }
    }
}

// Along the route, an arc over the straight line, to the end of the next planned piece.
void Hand::next_stride(const HandSight& sight) {
    const glm::dvec3 way = hover_m_ - route_from_m_;
    const double length_m = glm::length(way);
    const auto at = [&](double u) {
        return route_from_m_ + u * way + (4.0 * u * (1.0 - u) * kArc * length_m) * normal_;
    };
    const double before = static_cast<double>(stride_) / strides_;
    const double after = static_cast<double>(++stride_) / strides_;
    const glm::dvec3& from = goal_m_[static_cast<std::size_t>(tool_)];
    const glm::dvec3 to = at(after);
    glm::dvec3 bow = at(0.5 * (before + after)) - 0.5 * (at(before) + to);
    const glm::dvec3 side = glm::cross(to - from, normal_); // as long as the stride, across it
    bow += skill_.path_bow * random_.normal() * side;
    move_to(sight, to, bow);
}

void Hand::move_to(const HandSight& sight, const glm::dvec3& to_m, const glm::dvec3& bow_m) {
    move_ = aimed_move(skill_, random_, goal_m_[static_cast<std::size_t>(tool_)], to_m,
                       line_of_sight(sight));
    move_.bow_m = bow_m;
    phase_ = Phase::travel;
    phase_ticks_ = 0;
}

// A movement in the air, travel or lift. Waits while the tip is held up; gives up in the end.
void Hand::follow_move(const HandSight& sight) {
    const auto t = static_cast<std::size_t>(tool_);
    const ToolObservation& tool = sight.now.tool[t];
    MinimumJerk on = move_;
    on.time_s += kTick_s;
    const double ahead_m = glm::distance(place_m(on), tool.tip_m);
    if (ahead_m < kLeash_m || ahead_m < glm::distance(goal_m_[t], tool.tip_m))
        move_ = on;
    goal_m_[t] = place_m(move_);
    const bool lifting = phase_ == Phase::lift;
    const bool felt = seen_.before(kFeelShare * skill_.reaction_s).force_n[t] > kBump_n;
    if (lifting && !felt && lift_ == Lift::pressing)
        lift_ = Lift::free;
    if (lifting && felt && lift_ == Lift::free) { // a wall above: high enough
        lift_to(tool.tip_m + kBackOff_m * push_of(tool));
        lift_ = Lift::blocked;
        return;
    }
    const bool stuck = phase_ticks_ * kTick_s > move_.duration_s + kGiveUp_s;
    if (stuck || (!lifting && felt)) {
        clearance_m_ = std::min(clearance_m_ + kMoreRoom_m, kMostRoom_m);
        const glm::dvec3 push = push_of(tool);
        const glm::dvec3 away = push != glm::dvec3{0.0} ? push + 0.5 * normal_ : normal_;
        // The way it came in is always free: back along the shaft when lifting did not help.
        const bool back = stuck || glm::length(away) < 0.1;
        lift_to(tool.tip_m + kRest_m * (back ? -tool.shaft : glm::normalize(away)));
        return;
    }
    if (!arrived(move_))
        return;
    if (lifting) {
        pause(skill_.pause_s + skill_.plan_s);
        return;
    }
    phase_ = Phase::look;
    wait_ticks_ = ticks(skill_.pause_s);
}

// After the pause: on along the route, or correct what is seen to be wrong, or down.
void Hand::look(const HandSight& sight) {
    const auto t = static_cast<std::size_t>(tool_);
    const Target& target = sight.now.target[static_cast<std::size_t>(target_)];
    hover_m_ = target.position_m + offset_m_ + clearance_m_ * normal_;
    if (stride_ < strides_) {
        next_stride(sight);
        return;
    }
    const glm::dvec3 sight_line = line_of_sight(sight);
    const glm::dvec3 error = sight.now.tool[t].tip_m - hover_m_;
    const double depth = glm::dot(error, sight_line);
    const double depth_seen = depth + kDepthSeen * skill_.depth_m * random_.normal();
    const glm::dvec3 across = error - depth * sight_line;
    // Nobody corrects much less than he errs.
    const double good_m = 0.15 * exercise_.radius_m + 0.5 * skill_.aim_m;
    const bool good = glm::length(across) <= good_m && std::abs(depth_seen) <= 0.3 * kHover_m;
    if (good || corrections_ == kMaxCorrections) {
        begin_descent(sight);
        return;
    }
    ++corrections_;
    move_to(sight, goal_m_[t] - across - depth_seen * sight_line, glm::dvec3{0.0});
}

void Hand::begin_descent(const HandSight& sight) {
    const double band_n = exercise_.force_max_n - exercise_.force_min_n;
    const double wanted_n =
        (exercise_.force_min_n + kWanted * band_n) * std::exp(skill_.force_sd * random_.normal());
    press_ =
        begin_press(wanted_n, kApproachShare * skill_.speed_mps, kFeelShare * skill_.reaction_s);
    const auto t = static_cast<std::size_t>(tool_);
    descent_from_m_ = goal_m_[t];
    offset_seen_m_ =
        sight.now.tool[t].tip_m - sight.now.target[static_cast<std::size_t>(target_)].position_m;
    held_ticks_ = 0;
    phase_ = Phase::press;
    if (exercise_.kind == ExerciseKind::follow_path && !mistaken_) {
        trace_ = begin_trace(sight.now, target_);
        phase_ = Phase::trace;
    }
}

// Down to contact and on to the wanted force; up when the task has moved on or nothing comes of it.
void Hand::keep_pressing(const HandSight& sight) {
    const auto t = static_cast<std::size_t>(tool_);
    advance(press_, glm::length(sight.now.tool[t].force_n));
    // Tissue breathes: the eye keeps the tip where it is beside the target. What sticks to the tip
    // moves with it and is no error, so this never drags.
    const glm::dvec3 target = sight.now.target[static_cast<std::size_t>(target_)].position_m;
    const glm::dvec3 slip = sight.now.tool[t].tip_m - target - offset_seen_m_;
    descent_from_m_ -= kTick_s / kPursuit_s * (slip - glm::dot(slip, normal_) * normal_);
    goal_m_[t] = descent_from_m_ - press_.advanced_m * normal_;
    const bool in_band =
        press_.felt_n >= exercise_.force_min_n && press_.felt_n <= exercise_.force_max_n;
    held_ticks_ = in_band ? held_ticks_ + 1 : 0;

    const Percept& seen = seen_.before(skill_.reaction_s);
    const bool advanced = seen.done || seen.next_target != target_;
    const bool in_vain =
        held_ticks_ * kTick_s > exercise_.hold_s + skill_.reaction_s + kNotice_s ||
        press_.contact_ticks * kTick_s > kGiveUp_s ||
        (press_.contact_ticks == 0 && press_.advanced_m > clearance_m_ + kNotFound_m);
    if (advanced || in_vain)
        lift_off(t, normal_);
}

// Along the path while the force is right; up when it is done, lost, or does not count.
void Hand::keep_tracing(const HandSight& sight) {
    const auto t = static_cast<std::size_t>(tool_);
    advance(press_, glm::length(sight.now.tool[t].force_n));
    const Percept& seen = seen_.before(skill_.reaction_s);
    const bool in_band =
        press_.felt_n >= exercise_.force_min_n && press_.felt_n <= exercise_.force_max_n;
    // Steering law (Accot & Zhai 1997): the narrower the path for a hand's own scatter, the slower.
    const double ease = std::min(1.0, exercise_.radius_m / (kCalm * skill_.aim_m + 1e-9));
    const double way_m = in_band ? kTraceShare * ease * skill_.speed_mps * kTick_s : 0.0;
    const double pursuit_s = std::max(kPursuit_s, kPursuitDelays * skill_.reaction_s);
    advance(trace_, way_m, skill_.aim_m, seen.aside_m, pursuit_s, random_);
    const glm::dvec3 normal = normal_at(trace_);
    goal_m_[t] = place_m(trace_) + (clearance_m_ - press_.advanced_m) * normal + trace_.wander_m +
                 trace_.corrected_m;

    const bool behind = seen.next_target + 1 < static_cast<int>(trace_.u);
    const bool not_found =
        press_.contact_ticks == 0 && press_.advanced_m > clearance_m_ + kNotFound_m;
    const bool ended = trace_.end_ticks * kTick_s > skill_.reaction_s + kNotice_s;
    if (seen.done || behind || not_found || ended)
        lift_off(t, normal);
}

void Hand::lift_off(std::size_t t, const glm::dvec3& normal) {
    const double height_m = kRest_m + press_.advanced_m - clearance_m_;
    lift_to(goal_m_[t] + std::max(height_m, kHover_m) * normal);
}

void Hand::lift_to(const glm::dvec3& to_m) {
    move_ = plan_move(goal_m_[static_cast<std::size_t>(tool_)], to_m, skill_.speed_mps);
    phase_ = Phase::lift;
    lift_ = Lift::pressing;
    phase_ticks_ = 0;
}

HandGoals Hand::tick(const HandSight& sight) {
    seen_.push({{}, {}, sight.next_target, sight.done});
    if (phase_ == Phase::trace) {
        seen_.now().aside_m =
            aside_m(trace_, sight.now, sight.now.tool[static_cast<std::size_t>(tool_)]);
    }
    for (std::size_t t = 0; t < kTools; ++t)
        seen_.now().force_n[t] = glm::length(sight.now.tool[t].force_n);
    ++phase_ticks_;
    switch (phase_) {
    case Phase::wait:
        if (--wait_ticks_ <= 0)
            decide(sight);
        break;
    case Phase::look:
        if (--wait_ticks_ <= 0)
            look(sight);
        break;
    case Phase::travel:
    case Phase::lift:
        follow_move(sight);
        break;
    case Phase::press:
        keep_pressing(sight);
        break;
    case Phase::trace:
        keep_tracing(sight);
        break;
    case Phase::finished:
        break;
    }
    HandGoals goals;
    for (std::size_t t = 0; t < kTools; ++t)
        goals.tip_m[t] = goal_m_[t] + next_tremor_m(tremor_[t], skill_.tremor_m);
    return goals;
}

} // namespace tasks
