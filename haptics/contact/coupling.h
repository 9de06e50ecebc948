// haptics/contact/coupling.h
// How the force at 1 kHz is made from FEM answers that come every 5 to 20 ms, one period late.
// One coupling per file, one signature, so that they can be charted side by side:
//   anchored  the local model is re-anchored at each answer and the stored tool poses since its
//             sample are replayed through it; what the product uses
//   hold      the FEM's last force (the baseline that is late and rings)
#pragma once

#include "haptics/contact/local_model.h"
#include "haptics/contact/pose_history.h"

namespace haptics {

/// One local model on its way through time.
struct RunningModel {
    const LocalModels* answer = nullptr; // not owned: a slot of the exchange, see adopt()
    std::int64_t tick = 0;               // last tick stepped
    std::array<double, kMaxModes> q{};
    std::array<double, kMaxModes> rate{};
    std::array<SurfacePoint, kTools> contact{};
    std::array<ContactMemory, kTools> memory{};
    std::array<glm::dvec3, kTools> force_n{};
    std::array<int, kTools> closing{}; // last closing of each tool's jaws that was heeded
};

/// A jump of the force at a change of model, bled off over one FEM period.
struct Easing {
    glm::dvec3 offset_n{0.0};
    int ticks_left = 0;
    int ticks_total = 1;
};

struct CouplingConfig {
    double tick_s = 1e-3;
    int period_ticks = 10;          // FEM period, for easing
    int replay_ticks_per_tick = 24; // a late answer catches up over several ticks
    double ease_above_n = 0.025;    // smaller jumps are below what a hand feels
};

struct CouplingState {
    RunningModel active;
    RunningModel pending; // catching up; answer == nullptr: none
    std::array<Easing, kTools> easing{};
};

struct CouplingResult {
    std::array<glm::dvec3, kTools> force_n{}; // on each tool, before limits
    std::array<bool, kTools> touching{};
    std::array<bool, kTools> grasping{}; // jaws hold tissue; touching as well
    bool promoted = false;               // pending became active in this tick: the slot of the old
                                         // active answer may be reused by the caller
    int replayed = 0;                    // ticks replayed in this call, for the tick budget
    int slid_off = 0; // tools that left their patch over its rim: no force, no ghost
    double solve_residual_m = 0.0;
};

/// Starts catching up with `answer`, which must stay unchanged until a later adopt() has been
/// promoted in its place. Call only when no answer is pending. Real-time safe.
void adopt(CouplingState& state, const LocalModels& answer) noexcept;

/// One tick of the product's coupling. `history` already holds `tick`. Real-time safe.
CouplingResult anchored_tick(CouplingState& state, const CouplingConfig& config,
                             const PoseHistory& history, std::int64_t tick) noexcept;

/// One tick of the baseline: the last answer's force, whatever the tool did since.
CouplingResult hold_tick(CouplingState& state, const CouplingConfig& config,
                         const PoseHistory& history, std::int64_t tick) noexcept;

} // namespace haptics
