#include "tasks/hand/script.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace tasks {
namespace {

constexpr double kHover_m = 10e-3;
constexpr double kRetract_m = 15e-3;
constexpr double kSpeed_mps = 0.05; // peak of a movement without `seconds`
constexpr double kPressSpeed_mps = 0.01;
constexpr double kJaw_s = 0.3;           // of a closing or opening without `seconds`
constexpr double kLook_s = 1.0;          // of a change of the picture without `seconds`
constexpr double kPressLimit_s = 5.0;    // without `seconds`
constexpr double kReached = 0.95;        // of the force: press is over
constexpr double kMostAdvance_m = 40e-3; // nothing there: do not go on for ever

// An exact hand feels at once; the servo's own lag term covers grip and tissue.
constexpr double kDelay_s = 0.0;

std::size_t index_of(const ScriptStep& step) {
    return static_cast<std::size_t>(step.tool);
}

} // namespace

ScriptHand::ScriptHand(Script script, const Exercise& exercise,
                       const std::array<glm::dvec3, kTools>& start_tip_m)
    : script_(std::move(script)), exercise_(exercise), goal_m_(start_tip_m) {
    for (const ScriptStep& step : script_.step) {
        target_of_step_.push_back(-1);
        if (step.target.empty())
            continue;
        std::string known;
        for (std::size_t k = 0; k < exercise_.target.size(); ++k) {
            known += (k == 0 ? "" : ", ") + exercise_.target[k].id;
            if (exercise_.target[k].id == step.target)
                target_of_step_.back() = static_cast<int>(k);
        }
        if (target_of_step_.back() < 0)
            throw std::invalid_argument(step.where + ": target = \"" + step.target +
                                        "\": one of the exercise's " + known);
    }
}

void ScriptHand::begin_move(const glm::dvec3& to_m, const ScriptStep& step) {
    const std::size_t t = index_of(step);
    move_ = plan_move(goal_m_[t], to_m, kSpeed_mps);
    if (step.seconds && step.verb != Verb::touch)
        move_.duration_s = *step.seconds;
    pressing_[t].active = false;
    stage_ = Stage::travel;
}

bool ScriptHand::follow() {
    move_.time_s += kTick_s;
    goal_m_[index_of(script_.step[now_])] = place_m(move_);
    return arrived(move_);
}

void ScriptHand::begin_pressing(const HandSight& sight, const ScriptStep& step) {
    const std::size_t t = index_of(step);
    const int target = target_of_step_[now_];
    const double middle_n = 0.5 * (exercise_.force_min_n + exercise_.force_max_n);
    Pressing& pressing = pressing_[t];
    pressing.active = true;
    pressing.from_m = goal_m_[t];
    pressing.direction = target >= 0 ? -sight.now.target[static_cast<std::size_t>(target)].normal
                                     : sight.now.tool[t].shaft;
    pressing.press = begin_press(step.force_n.value_or(middle_n), kPressSpeed_mps, kDelay_s);
    stage_ = Stage::press;
}

// Every pressing tool keeps its force, also while another one works.
void ScriptHand::keep_pressing(const HandSight& sight) {
    for (std::size_t t = 0; t < kTools; ++t) {
        Pressing& pressing = pressing_[t];
        if (!pressing.active)
            continue;
        advance(pressing.press, glm::length(sight.now.tool[t].force_n));
        pressing.press.advanced_m = std::min(pressing.press.advanced_m, kMostAdvance_m);
        goal_m_[t] = pressing.from_m + pressing.press.advanced_m * pressing.direction;
    }
}

bool ScriptHand::touch(const HandSight& sight, const ScriptStep& step) {
    const std::size_t t = index_of(step);
    const int target = target_of_step_[now_];
    const Target& seen = sight.now.target[static_cast<std::size_t>(target)];
    switch (stage_) {
    case Stage::begin:
        begin_move(seen.position_m + kHover_m * seen.normal, step);
        return false;
    case Stage::travel:
        if (follow()) {
            begin_pressing(sight, step);
            elapsed_s_ = 0.0;
        }
        return false;
    case Stage::press:
        if (sight.next_target > target || sight.done ||
            elapsed_s_ >= step.seconds.value_or(kPressLimit_s)) {
            begin_move(goal_m_[t] - (kRetract_m + pressing_[t].press.advanced_m - kHover_m) *
                                        pressing_[t].direction,
                       step);
            stage_ = Stage::back;
        }
        return false;
    case Stage::back:
        return follow();
    }
    return true;
}

bool ScriptHand::move_jaw(const ScriptStep& step, double to) {
    double& jaw = jaw_[index_of(step)];
    if (stage_ == Stage::begin)
        jaw_from_ = jaw;
    stage_ = Stage::travel;
    const double share = std::min(1.0, elapsed_s_ / step.seconds.value_or(kJaw_s));
    jaw = jaw_from_ + share * (to - jaw_from_);
    return share >= 1.0;
}

// The force tells how deep; the way is across the direction of the press.
bool ScriptHand::slide(const HandSight& sight, const ScriptStep& step) {
    const std::size_t t = index_of(step);
    if (stage_ == Stage::begin) {
        if (!pressing_[t].active)
            begin_pressing(sight, step);
        const auto target = static_cast<std::size_t>(std::max(target_of_step_[now_], 0));
        const glm::dvec3 way = step.at_m.value_or(sight.now.target[target].position_m) - goal_m_[t];
        const glm::dvec3& down = pressing_[t].direction;
        slide_from_m_ = pressing_[t].from_m;
        slide_to_m_ = slide_from_m_ + way - glm::dot(way, down) * down;
        stage_ = Stage::press;
    }
    const double share = std::min(1.0, elapsed_s_ / *step.seconds);
    pressing_[t].from_m = glm::mix(slide_from_m_, slide_to_m_, share);
    return share >= 1.0;
}

// Place, distance and horizon together; from wherever it looked before, at once if nowhere.
bool ScriptHand::look(const HandSight& sight, const ScriptStep& step) {
    const auto target = static_cast<std::size_t>(std::max(target_of_step_[now_], 0));
    const ScopeGoal to{.given = true,
                       .look_at_m = step.at_m.value_or(sight.now.target[target].position_m),
                       .distance_m = step.distance_m,
                       .horizon_rad = step.horizon_rad};
    if (stage_ == Stage::begin) {
        scope_from_ = scope_.given ? scope_ : to;
        stage_ = Stage::travel;
    }
    const double share = std::min(1.0, elapsed_s_ / step.seconds.value_or(kLook_s));
    scope_.given = true;
    scope_.look_at_m = glm::mix(scope_from_.look_at_m, to.look_at_m, share);
    scope_.distance_m = std::lerp(scope_from_.distance_m, to.distance_m, share);
    scope_.horizon_rad = std::lerp(scope_from_.horizon_rad, to.horizon_rad, share);
    return share >= 1.0;
}

bool ScriptHand::perform(const HandSight& sight, const ScriptStep& step) {
    const std::size_t t = index_of(step);
    const bool begins = stage_ == Stage::begin;
    switch (step.verb) {
    case Verb::move:
        if (begins) {
            const int target = target_of_step_[now_];
            const Target& seen = sight.now.target[static_cast<std::size_t>(std::max(target, 0))];
            begin_move(step.at_m.value_or(seen.position_m + kHover_m * seen.normal), step);
        }
        return follow();
    case Verb::touch:
        return touch(sight, step);
    case Verb::press:
        if (begins)
            begin_pressing(sight, step);
        return elapsed_s_ >= step.seconds.value_or(kPressLimit_s) ||
               pressing_[t].press.felt_n >= kReached * *step.force_n;
    case Verb::hold:
        if (begins && step.force_n && !pressing_[t].active)
            begin_pressing(sight, step);
        stage_ = Stage::press;
        if (step.force_n)
            pressing_[t].press.wanted_n = *step.force_n;
        return elapsed_s_ >= *step.seconds;
    case Verb::slide:
        return slide(sight, step);
    case Verb::retract:
        if (begins) {
            const glm::dvec3 back =
                pressing_[t].active ? -pressing_[t].direction : -sight.now.tool[t].shaft;
            begin_move(goal_m_[t] + kRetract_m * back, step);
        }
        return follow();
    case Verb::wait:
        return elapsed_s_ >= *step.seconds;
    case Verb::grasp:
        return move_jaw(step, 1.0);
    case Verb::release:
        return move_jaw(step, 0.0);
    case Verb::look:
        return look(sight, step);
    }
    return true;
}

HandGoals ScriptHand::tick(const HandSight& sight) {
    keep_pressing(sight);
    if (now_ < script_.step.size()) {
        elapsed_s_ += kTick_s;
        if (perform(sight, script_.step[now_])) {
            ++now_;
            stage_ = Stage::begin;
            elapsed_s_ = 0.0;
        }
    }
    return {goal_m_, jaw_, scope_};
}

bool holds_scope(const Script& script) noexcept {
    return std::any_of(script.step.begin(), script.step.end(),
                       [](const ScriptStep& step) { return step.verb == Verb::look; });
}

} // namespace tasks
