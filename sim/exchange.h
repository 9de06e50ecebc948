// sim/exchange.h
// Everything that passes between threads. If it is not in this file, it is not shared.
//
//   tissue loop, 50-200 Hz -- answers ->  haptic loop, 1 kHz    newest wins, reader keeps two
//   haptic loop, 1 kHz     -- tools --->  tissue loop           newest wins
//   haptic loop, 1 kHz     -- tools_seen> render loop           newest wins
//   tissue loop            -- surface ->  render loop, 60 Hz    newest wins
//   haptic loop, 1 kHz     -- ticks --->  recorder              every value, in order
//   tissue loop            -- steps --->  recorder              every value, in order
//   recorder               -- progress->  hands, render         newest wins
//   render loop            -- pointer ->  haptic loop           newest wins
//   render loop            -- marks --->  recorder              every value, in order
//   anyone                 -- flags --->  the loops             single words
//
// Why the answer looks as it does (haptics/contact/local_model.h), as the spike before it showed on
// the curved liver at 20 kPa, friction 0.3, answers 2 to 10 ms later than one period, two tools:
//   trocar study coupling --young-kpa 20 --friction 0.3 --late 2 --jitter 8 --out DIR
// - Adopt the FEM's state at its sample, replay the tool poses since, go on: holds. 100 mm/s at
//   100 Hz: 0.5-0.9 % rms, worst 12 mN, 3 mN a tick beyond the reference (hold: 9-15 %, 116 mN); at
//   50 Hz touch 2.7 %. So the answer carries its sample tick, and the reader may keep two.
// - Modes cross already filtered by the footprint, on skin vertices 4 mm apart: a tick evaluates
//   three of them instead of a kernel over tetrahedra, and a replayed tick costs as little.
// - Friction needs what it was at the sample, so force and lag of each contact cross too; a contact
//   point is material (triangle and weights) and moves only by slip.
// - Normals cross with the patch and are interpolated: on a curved skin one normal is not enough.
// - What the mesh cannot resolve is a law in series with the rows, the same in both loops; it is
//   most of a small tip's compliance, and it is why the coupling's error is small.
#pragma once

#include "haptics/contact/local_model.h"
#include "haptics/contact/pose_history.h"
#include "haptics/device/trocar.h"
#include "sim/loop/newest_buffer.h"
#include "sim/loop/spsc_ring.h"
#include "tasks/exercise/progress.h"
#include "tasks/logbook/trace.h"

#include <vector>

namespace sim {

inline constexpr int kTools = haptics::kTools;
inline constexpr double kTick_s = 1e-3;
static_assert(haptics::kTools == tasks::kTools);

/// Where the targets are, in micrometres, after one FEM step.
using TargetPlaces = std::array<std::array<std::int32_t, 3>, tasks::kMaxTargets>;

/// How many of tasks::kSightRays from the endoscope reach each target.
using ClearRays = std::array<std::uint8_t, tasks::kMaxTargets>;

/// What the exercise sees of the tissue after one FEM step.
struct TissueSeen {
    TargetPlaces target_um{};
    ClearRays clear_rays{};
    std::int32_t stress_pa = 0;
    int targets = 0;
};

/// One FEM answer: what the haptic loop steps at 1 kHz, and what the exercise sees.
struct TissueAnswer {
    haptics::LocalModels local;
    TissueSeen seen;
};

enum class ScopeHolder : std::uint8_t { mount, assistant, person };

/// The endoscope in one millisecond.
struct ScopeNow {
    tasks::View view;
    glm::dvec3 port_m{0.0}; // where it comes in; the eye itself if the scene's picture is fixed
    double camera_rad = 0.0, optic_rad = 0.0; // turns of camera head and optic
    double horizon_rad = 0.0;
    ScopeHolder holder = ScopeHolder::mount;
    bool present = false; // false: the scene's picture is fixed
    bool faulted = false;
};

/// The tools as they are in one millisecond.
struct ToolsNow {
    std::int64_t tick = -1;
    std::array<haptics::ToolTip, kTools> tip{};
    std::array<haptics::ShaftPose, kTools> shaft{};
    std::array<glm::dvec3, kTools> handle_m{};
    std::array<double, kTools> jaw{}, roll_rad{};
    std::array<glm::dvec3, kTools> force_n{}; // on the tip, world
    std::array<bool, kTools> touching{};
    std::array<bool, kTools> grasping{};     // jaws hold tissue
    std::array<double, kTools> felt_share{}; // ramp and limits: 0 limp .. 1 full force
    std::array<bool, kTools> faulted{};
    ScopeNow scope;
    ClearRays clear_rays{}; // of the newest answer taken
};

/// The surfaces as they are drawn; vectors sized once at start.
struct SurfaceNow {
    std::int64_t step = -1;
    std::vector<std::vector<glm::vec3>> position_m; // per body
    std::vector<std::vector<glm::vec3>> normal;
    TargetPlaces target_um{};
    int targets = 0;
};

/// How far the exercise is, for hands and screen.
struct ProgressNow {
    std::int64_t tick = -1;
    int next_target = 0;
    std::uint32_t found = 0; // bit k: target k of find-tubes
    double hold_share = 0.0;
    bool complete = false;
    int errors = 0;
};

/// Where the person at mouse and keyboard wants the tips and the endoscope, and which of them are
/// in his hands; the others are the assistant's.
struct PointerGoals {
    std::array<glm::dvec3, kTools> tip_m{};
    std::array<double, kTools> jaw{};
    std::array<bool, kTools> held{true, true, true};
    glm::dvec3 scope_tip_m{0.0};
    double camera_rad = 0.0, optic_rad = 0.0;
    bool scope_held = false;
};

struct Exchange {
    NewestBuffer<TissueAnswer> answers;
    NewestBuffer<ToolsNow> tools;
    NewestBuffer<ToolsNow> tools_seen;
    NewestBuffer<SurfaceNow> surface;
    NewestBuffer<ProgressNow> progress;      // recorder -> hands
    NewestBuffer<ProgressNow> progress_seen; // recorder -> render
    NewestBuffer<PointerGoals> pointer;      // render -> haptic
    SpscRing<tasks::TickTrace, 1 << 13> ticks;
    SpscRing<tasks::StepTrace, 1 << 11> steps;
    SpscRing<tasks::Event, 1 << 6> marks; // pause, resume, abandon: what people did
    std::atomic<bool> stop{false};
    std::atomic<bool> paused{false};         // the world stands still, every device limp
    std::atomic<bool> zero_forces{false};    // Esc: every device limp from the next tick on
    std::atomic<bool> surface_wanted{false}; // nobody draws: the tissue loop does not bother
    std::atomic<std::uint64_t> dropped{0};   // ring overflows: any makes the attempt not valid
};

} // namespace sim
