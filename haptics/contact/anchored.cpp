// haptics/contact/anchored.cpp
// The `anchored` coupling; see coupling.h.
#include "haptics/contact/coupling.h"

#include "haptics/contact/model_step.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace haptics {
namespace {

// Steps `model` through the stored tips up to the tick before `tick`, as far as the budget goes.
// What the history has lost is left out.
int catch_up(RunningModel& model, const CouplingConfig& config, const PoseHistory& history,
             std::int64_t tick) noexcept {
    const std::int64_t oldest =
        std::max<std::int64_t>(0, history.newest_tick - PoseHistory::kLength + 1);
    model.tick = std::max(model.tick, oldest - 1);
    int replayed = 0;
    for (; model.tick + 1 < tick && replayed < config.replay_ticks_per_tick; ++replayed)
        step_model(model, config.tick_s, history.at(model.tick + 1));
    return replayed;
}

// An answer about this very tick needs no step: it says itself how its tools stand.
StepResult as_published(const RunningModel& model) noexcept {
    StepResult result;
    for (int i = 0; i < kTools; ++i) {
        const ToolPatch& patch = model.answer->tool[i];
        const SurfacePoint& at = patch.contact;
        result.touching[i] = patch.near && patch.memory.touching && at.triangle >= 0;
        result.grasping[i] = result.touching[i] && patch.memory.grasped;
        if (!result.touching[i])
            continue;
        const auto& corner = patch.triangle[at.triangle].vertex;
        for (int k = 0; k < 3; ++k)
            result.normal[i] += at.weight[k] * patch.vertex[corner[k]].normal;
        result.normal[i] = glm::normalize(result.normal[i]);
    }
    return result;
}

StepResult step_to(RunningModel& model, const CouplingConfig& config, const PoseHistory& history,
                   std::int64_t tick) noexcept {
    return model.tick < tick ? step_model(model, config.tick_s, history.at(tick))
                             : as_published(model);
}

// The model's force and what is left of an earlier jump. Never pulls unless grasped; out of contact
// the jump is dropped, or it would be felt as a ghost.
glm::dvec3 eased_force(Easing& easing, const glm::dvec3& force_n, const StepResult& step,
                       int tool) noexcept {
    if (!step.touching[tool]) {
        easing = {};
        return glm::dvec3{0.0};
    }
    if (easing.ticks_left <= 0)
        return force_n;
    const double share = static_cast<double>(easing.ticks_left) / easing.ticks_total;
    --easing.ticks_left;
    const glm::dvec3 total_n = force_n + share * easing.offset_n;
    const glm::dvec3& normal = step.normal[tool];
    return step.grasping[tool] ? total_n
                               : total_n - normal * std::min(0.0, glm::dot(normal, total_n));
}

std::array<glm::dvec3, kTools> eased_forces(CouplingState& state, const RunningModel& model,
                                            const StepResult& step) noexcept {
    std::array<glm::dvec3, kTools> force_n{};
    for (int i = 0; i < kTools; ++i)
        force_n[i] = eased_force(state.easing[i], model.force_n[i], step, i);
    return force_n;
}

} // namespace

void adopt(CouplingState& state, const LocalModels& answer) noexcept {
    RunningModel& model = state.pending;
    model = {.answer = &answer, .tick = answer.sample_tick, .rate = answer.rate};
    for (int i = 0; i < kTools; ++i) {
        const ToolPatch& patch = answer.tool[i];
        model.closing[i] = patch.closing;
        if (!patch.near)
            continue;
        model.contact[i] = patch.contact;
        model.memory[i] = patch.memory;
        model.force_n[i] = patch.force_n;
    }
}

CouplingResult anchored_tick(CouplingState& state, const CouplingConfig& config,
                             const PoseHistory& history, std::int64_t tick) noexcept {
    CouplingResult result;
    StepResult step;
    if (state.pending.answer)
        result.replayed = catch_up(state.pending, config, history, tick);

    // the old model goes on making force until the new one has caught up
    const bool had_model = state.active.answer != nullptr;
    if (had_model) {
        step = step_to(state.active, config, history, tick);
        result.force_n = eased_forces(state, state.active, step);
    }

    // both have come to this tick: the new one takes over from what was just felt
    if (state.pending.answer && state.pending.tick + 1 >= tick) {
        const StepResult fresh = step_to(state.pending, config, history, tick);
        for (int i = 0; i < kTools; ++i) {
            const glm::dvec3 jump_n = result.force_n[i] - state.pending.force_n[i];
            const bool ease = had_model && step.touching[i] && fresh.touching[i] &&
                              step.grasping[i] == fresh.grasping[i] &&
                              glm::length(jump_n) > config.ease_above_n;
            state.easing[i] =
                ease ? Easing{jump_n, config.period_ticks, config.period_ticks} : Easing{};
        }
        result.force_n = eased_forces(state, state.pending, fresh);
        step = fresh;
        state.active = state.pending;
        state.pending = {};
        result.promoted = true;
    }

    result.touching = step.touching;
    result.grasping = step.grasping;
    result.slid_off = step.slid_off;
    result.solve_residual_m = step.solve_residual_m;
    return result;
}

} // namespace haptics
