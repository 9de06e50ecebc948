#include "tasks/hand/find_hand.h"

#include "tasks/exercise/find_tubes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace tasks {
namespace {

constexpr double kHover_m = 12e-3;   // tip above the place before going down or near
constexpr double kMoreRoom_m = 4e-3; // added after each bump
constexpr double kMostRoom_m = 40e-3;
constexpr double kArc = 0.15;        // height of a route over its straight line
constexpr double kFeelShare = 0.6;   // touch is quicker than sight
constexpr double kBump_n = 0.06;     // felt on the way: something is there
constexpr double kCarryShare = 0.6;  // of the speed, with tissue in the jaws
constexpr double kDepthSeen = 0.5;   // share of the depth error that a second look still leaves
constexpr double kPointShare = 0.75; // of the radius: how near people point, without touching
constexpr double kGoodShare = 0.9;   // of the radius: near enough, no correction
constexpr double kNotice_s = 1.0;    // pointing well and nothing happens: something is wrong
constexpr double kGiveUp_s = 8.0;
constexpr int kMaxCorrections = 4;

int ticks(double seconds) {
    return static_cast<int>(std::lround(seconds / kTick_s));
}

} // namespace

FindHand::FindHand(const HandSkill& skill, const Exercise& exercise, std::uint64_t seed,
                   const std::array<glm::dvec3, kTools>& start_tip_m)
    : skill_(skill), exercise_(exercise), random_(seed), goal_m_(start_tip_m),
      seen_(skill.reaction_s), room_m_(kHover_m) {
    for (std::size_t t = 0; t < kTools; ++t)
        tremor_[t].random = Random(seed ^ (0x9e3779b97f4a7c15u * (t + 1)));
    pause(skill_.reaction_s + skill_.plan_s);
}

void FindHand::pause(double seconds) {
    phase_ = Phase::wait;
    wait_ticks_ = ticks(seconds);
}

glm::dvec3 FindHand::line_of_sight(const HandSight& sight, const glm::dvec3& to_m) const {
    const glm::dvec3 to = to_m - sight.now.view.eye_m;
    return glm::length(to) > 1e-3 ? glm::normalize(to) : sight.now.view.forward;
}

FindHand::Percept FindHand::percept_of(const HandSight& sight) const {
    Percept now;
    for (std::size_t t = 0; t < kTools; ++t) {
        now.force_n[t] = glm::length(sight.now.tool[t].force_n);
        now.touching[t] = sight.now.tool[t].touching;
    }
    now.holding = is_held_to_lift(exercise_, sight.now);
    now.found = sight.found;
    now.done = sight.done;
    return now;
}

// Where the tip has to be: above the place, or there.
glm::dvec3 FindHand::place_wanted(const HandSight& sight) const {
    const std::size_t k = lifting_ ? exercise_.target.size() : static_cast<std::size_t>(tube_);
    const Target& target = sight.now.target[k];
    const double above_m = near_ ? kPointShare * exercise_.radius_m : room_m_;
    return target.position_m + offset_m_ + above_m * target.normal;
}

// What is up stays up; else it is lifted first. Nothing to do: whoever holds the tool has to.
bool FindHand::choose_job(const HandSight& sight) {
    const int before = lifting_ ? -1 : tube_;
    lifting_ = exercise_.lift && !seen_.before(skill_.reaction_s).holding;
    const int tube = lifting_ ? -1 : choose_tube(sight);
    if (lifting_ ? sight.held[static_cast<std::size_t>(exercise_.lift->role)] : tube < 0)
        return false;
    const Role role =
        lifting_ ? exercise_.lift->role : exercise_.target[static_cast<std::size_t>(tube)].role;
    tool_ = static_cast<int>(role);
    if (lifting_) {
        jaw_[static_cast<std::size_t>(tool_)] = 0.0;
        return true;
    }
    tube_ = tube;
    if (tube_ == before)
        return true;
    room_m_ = kHover_m;
    const bool alone = std::none_of(sight.held.begin(), sight.held.end(), std::identity{});
    if (random_.uniform() < skill_.lapse && alone)
        lapse(sight);
    return true;
}

// The next job, and the way there.
void FindHand::decide(const HandSight& sight) {
    if (seen_.before(skill_.reaction_s).done) {
        phase_ = Phase::finished;
        return;
    }
    offset_m_ = glm::dvec3{0.0};
    mistaken_ = near_ = false;
    if (hangs(sight)) {
        tool_ = static_cast<int>(exercise_.lift->role);
        lifting_ = true;
        begin_lift();
        return;
    }
    if (!choose_job(sight)) {
        pause(skill_.pause_s);
        return;
    }
    route_from_m_ = goal();
    route_to_m_ = place_wanted(sight);
    const double way_m = glm::distance(route_from_m_, route_to_m_);
    strides_ = std::max(1, static_cast<int>(std::ceil(way_m / skill_.stride_m)));
    stride_ = corrections_ = 0;
    next_stride(sight);
}

// The first that is not found; beside a person, of those whose tool is free, and if he has the
// endoscope, the one that he shows. -1: none.
int FindHand::choose_tube(const HandSight& sight) const {
    const std::uint32_t found = seen_.before(skill_.reaction_s).found;
    const int tubes = static_cast<int>(exercise_.target.size());
    int chosen = -1;
    double off = std::numeric_limits<double>::infinity();
    for (int k = 0; k < tubes; ++k) {
        const auto tool =
            static_cast<std::size_t>(exercise_.target[static_cast<std::size_t>(k)].role);
        if ((found & (1U << k)) || sight.held[tool])
            continue;
        const double off_k =
            sight.scope_held ? off_centre(sight.now.view, sight.now.target[k].position_m) : 0.0;
        if (chosen < 0 || off_k < off) {
            chosen = k;
            off = off_k;
        }
    }
    const bool last_again =
        chosen < 0 && !sight.held[static_cast<std::size_t>(exercise_.target.back().role)];
    return last_again ? tubes - 1 : chosen; // found, and not yet told that all are
}

// The wrong tool, but never the one that holds; or a place 4-7 radii beside the tube.
void FindHand::lapse(const HandSight& sight) {
    mistaken_ = true;
    if (random_.uniform() < 0.5) {
        const int other = (tool_ + (random_.uniform() < 0.5 ? 1 : 2)) % kTools;
        if (!exercise_.lift || other != static_cast<int>(exercise_.lift->role))
            tool_ = other;
        else
            tool_ = kTools - other - tool_;
        return;
    }
    const glm::dvec3 normal = sight.now.target[static_cast<std::size_t>(tube_)].normal;
    const glm::dvec3 side = glm::normalize(
        glm::cross(normal, std::abs(normal.x) < 0.7 ? glm::dvec3{1, 0, 0} : glm::dvec3{0, 1, 0}));
    const double angle = 2.0 * std::numbers::pi * random_.uniform();
    const double far_m = exercise_.radius_m * (4.0 + 3.0 * random_.uniform());
    offset_m_ = far_m * (std::cos(angle) * side + std::sin(angle) * glm::cross(normal, side));
}

// Along the route, an arc towards the eye over the straight line, to the end of the next piece.
void FindHand::next_stride(const HandSight& sight) {
    const glm::dvec3 way = route_to_m_ - route_from_m_;
    const double length_m = glm::length(way);
    const glm::dvec3 up = -line_of_sight(sight, route_to_m_);
    const double lift_m = phase_ == Phase::lift ? 0.0 : kArc * length_m;
    const auto at = [&](double u) {
        return route_from_m_ + u * way + (4.0 * u * (1.0 - u) * lift_m) * up;
    };
    const double before = static_cast<double>(stride_) / strides_;
    const double after = static_cast<double>(++stride_) / strides_;
    const glm::dvec3 to = at(after);
    move_ = aimed_move(skill_, random_, goal(), to, line_of_sight(sight, to));
    move_.bow_m = at(0.5 * (before + after)) - 0.5 * (at(before) + to) +
                  skill_.path_bow * random_.normal() * glm::cross(to - goal(), up);
    if (phase_ == Phase::lift)
        move_.duration_s /= kCarryShare;
    else
        phase_ = Phase::travel;
    phase_ticks_ = 0;
}

void FindHand::back_off(const glm::dvec3& way_m) {
    move_ = plan_move(goal(), goal() + way_m, skill_.speed_mps);
    phase_ = Phase::leave;
    phase_ticks_ = 0;
}

// In the air. What is met on the way is in the way: back along the shaft, and with more room.
void FindHand::travel(const HandSight& sight) {
    const auto t = static_cast<std::size_t>(tool_);
    move_.time_s += kTick_s;
    goal() = place_m(move_);
    const bool felt = seen_.before(kFeelShare * skill_.reaction_s).force_n[t] > kBump_n;
    if (phase_ == Phase::travel && felt && !near_) {
        room_m_ = std::min(room_m_ + kMoreRoom_m, kMostRoom_m);
        back_off(-room_m_ * sight.now.tool[t].shaft);
        return;
    }
    if (!arrived(move_))
        return;
    if (phase_ == Phase::leave) {
        pause(skill_.pause_s + skill_.plan_s);
        return;
    }
    phase_ = Phase::look;
    wait_ticks_ = ticks(skill_.pause_s);
}

// The tip beside where it has to be, as the flat picture shows it.
FindHand::SeenError FindHand::see_error(const HandSight& sight) {
    const glm::dvec3 wanted = place_wanted(sight);
    const glm::dvec3 line = line_of_sight(sight, wanted);
    const glm::dvec3 error = sight.now.tool[static_cast<std::size_t>(tool_)].tip_m - wanted;
    const double depth_m = glm::dot(error, line);
    return {error - depth_m * line, line, depth_m + kDepthSeen * skill_.depth_m * random_.normal()};
}

void FindHand::correct(const HandSight& sight, const SeenError& error) {
    ++corrections_;
    route_from_m_ = goal();
    route_to_m_ = goal() - error.across_m - error.depth_m * error.line;
    stride_ = 0;
    strides_ = 1;
    next_stride(sight);
}

// After the pause: on along the route, or correct what is seen to be wrong, or go to work.
void FindHand::look(const HandSight& sight) {
    if (stride_ < strides_) {
        next_stride(sight);
        return;
    }
    const glm::dvec3 wanted = place_wanted(sight);
    const SeenError error = see_error(sight);
    // Nobody corrects much less than he errs.
    const double good_m = 0.15 * exercise_.radius_m + 0.5 * skill_.aim_m;
    const double deep_m = near_ ? (1.0 - kPointShare) * exercise_.radius_m : 0.3 * kHover_m;
    if ((glm::length(error.across_m) > good_m || std::abs(error.depth_m) > deep_m) &&
        corrections_ < kMaxCorrections) {
        correct(sight, error);
        return;
    }
    phase_ticks_ = 0;
    if (lifting_) {
        phase_ = Phase::descend;
        deep_m_ = 0.0;
    } else if (near_) {
        phase_ = Phase::point;
    } else if (sight.scope_held &&
               !tube_seen(exercise_, sight.now, static_cast<std::size_t>(tube_))) {
        pause(skill_.pause_s); // pointing at what nobody sees is an error
    } else {                   // from above the tube to it
        near_ = true;
        corrections_ = 0;
        route_from_m_ = goal();
        route_to_m_ = goal() + place_wanted(sight) - wanted;
        stride_ = 0;
        strides_ = 1;
        next_stride(sight);
    }
}

// At the tube until it counts; nearer if it is seen to be too far, anew when nothing comes of it.
void FindHand::keep_pointing(const HandSight& sight) {
    const Percept& seen = seen_.before(skill_.reaction_s);
    const glm::dvec3 normal = sight.now.target[static_cast<std::size_t>(tube_)].normal;
    const bool counted = (seen.found & (1U << tube_)) != 0 || seen.done;
    const double off_m =
        glm::distance(sight.now.tool[static_cast<std::size_t>(tool_)].tip_m,
                      sight.now.target[static_cast<std::size_t>(tube_)].position_m + offset_m_);
    const bool off = off_m > kGoodShare * exercise_.radius_m;
    const bool hopeless = mistaken_ || (off && corrections_ == kMaxCorrections);
    const double patience_s =
        hopeless ? kNotice_s : exercise_.hold_s + skill_.reaction_s + kGiveUp_s;
    if (counted || (exercise_.lift && !seen.holding) || phase_ticks_ * kTick_s > patience_s) {
        back_off(kHover_m * normal);
        return;
    }
    if (off && corrections_ < kMaxCorrections && phase_ticks_ > ticks(skill_.reaction_s))
        correct(sight, see_error(sight));
}

// Tools that somebody else holds: where they are, and no job of ours.
void FindHand::follow(const HandSight& sight) {
    for (std::size_t t = 0; t < kTools; ++t) {
        if (!sight.held[t])
            continue;
        goal_m_[t] = sight.now.tool[t].tip_m;
        jaw_[t] = sight.now.tool[t].jaw;
    }
    const bool ours = phase_ != Phase::wait && phase_ != Phase::finished;
    if (ours && sight.held[static_cast<std::size_t>(tool_)])
        pause(skill_.reaction_s + skill_.plan_s);
}

HandGoals FindHand::tick(const HandSight& sight) {
    seen_.push(percept_of(sight));
    follow(sight);
    ++phase_ticks_;
    switch (phase_) {
    case Phase::wait:
        if (--wait_ticks_ <= 0)
            decide(sight);
        break;
    case Phase::travel:
    case Phase::leave:
        travel(sight);
        break;
    case Phase::look:
        if (--wait_ticks_ <= 0)
            look(sight);
        break;
    case Phase::descend:
        descend(sight);
        break;
    case Phase::close:
        close_jaws();
        break;
    case Phase::lift:
        keep_lifting(sight);
        break;
    case Phase::point:
        keep_pointing(sight);
        break;
    case Phase::finished:
        break;
    }
    HandGoals goals;
    for (std::size_t t = 0; t < kTools; ++t)
        goals.tip_m[t] = goal_m_[t] + next_tremor_m(tremor_[t], skill_.tremor_m);
    goals.jaw = jaw_;
    return goals;
}

} // namespace tasks
