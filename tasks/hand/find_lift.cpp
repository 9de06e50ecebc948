// tasks/hand/find_lift.cpp
// How FindHand takes hold of what hides the tubes and lifts it. Called in every tick of a lift.
#include "tasks/hand/find_hand.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tasks {
namespace {

constexpr double kFeelShare = 0.6;     // touch is quicker than sight
constexpr double kApproachShare = 0.3; // of the speed, going down
constexpr double kDeeper_m = 2e-3;     // past the first touch, so that the jaws have something
constexpr double kNotFound_m = 12e-3;  // past the place where the tissue should have been
constexpr double kJaw_s = 0.3;
constexpr double kMostPull = 0.7;   // of the force limit: no further
constexpr double kTooHeavy_s = 1.0; // it resists for so long: another try
constexpr double kHigh_m = 15e-3;   // so near to where it was to be brought is enough
constexpr int kMostLifts = 5;

} // namespace

// Down until it is touched, and a little deeper; then the jaws close.
void FindHand::descend(const HandSight& sight) {
    const glm::dvec3 down = -sight.now.target[exercise_.target.size()].normal;
    const double way_m = kApproachShare * skill_.speed_mps * kTick_s;
    const Percept& seen = seen_.before(kFeelShare * skill_.reaction_s);
    const bool touched = seen.touching[static_cast<std::size_t>(tool_)];
    goal() += way_m * down;
    deep_m_ += touched ? way_m : 0.0;
    if (deep_m_ >= kDeeper_m) {
        phase_ = Phase::close;
        phase_ticks_ = 0;
    } else if (phase_ticks_ * way_m > room_m_ + kNotFound_m) {
        back_off(-room_m_ * down);
    }
}

void FindHand::close_jaws() {
    double& jaw = jaw_[static_cast<std::size_t>(tool_)];
    jaw = std::min(1.0, phase_ticks_ * kTick_s / kJaw_s);
    if (phase_ticks_ * kTick_s < kJaw_s + skill_.reaction_s)
        return;
    lifts_ = 0;
    begin_lift();
}

void FindHand::begin_lift() {
    ++lifts_;
    route_from_m_ = goal();
    route_to_m_ = exercise_.lift->to_m;
    const double way_m = glm::distance(route_from_m_, route_to_m_);
    strides_ = std::max(1, static_cast<int>(std::ceil(way_m / skill_.stride_m)));
    stride_ = 0;
    phase_ = Phase::lift;
    move_ = plan_move(goal(), goal(), skill_.speed_mps);
    move_.time_s = move_.duration_s;
}

// What is held hangs half-way: it was too heavy to go on.
bool FindHand::hangs(const HandSight& sight) const {
    if (!exercise_.lift || lifts_ >= kMostLifts)
        return false;
    const auto lifter = static_cast<std::size_t>(exercise_.lift->role);
    return !sight.held[lifter] && seen_.before(skill_.reaction_s).holding &&
           glm::distance(goal_m_[lifter], exercise_.lift->to_m) > kHigh_m;
}

// Up with it, stride by stride; it waits while it resists, and begins anew when it was lost.
void FindHand::keep_lifting(const HandSight& sight) {
    const Percept& felt = seen_.before(kFeelShare * skill_.reaction_s);
    const Percept& seen = seen_.before(skill_.reaction_s);
    const bool lost = !seen.holding;
    const bool heavy =
        felt.force_n[static_cast<std::size_t>(tool_)] > kMostPull * exercise_.force_limit_n;
    if (lost) {
        jaw_[static_cast<std::size_t>(tool_)] = 0.0;
        back_off(-room_m_ * sight.now.tool[static_cast<std::size_t>(tool_)].shaft);
        return;
    }
    heavy_ticks_ = heavy ? heavy_ticks_ + 1 : 0;
    if (heavy && heavy_ticks_ * kTick_s < kTooHeavy_s)
        return;
    if (!arrived(move_) && !heavy) {
        move_.time_s += kTick_s;
        goal() = place_m(move_);
    } else if (stride_ < strides_ && !heavy) {
        next_stride(sight);
    } else {
        pause(skill_.pause_s + skill_.plan_s);
    }
}

} // namespace tasks
