// sim/study/open_loop.h
// The force that a coupling gives on a prescribed motion, tick by tick, beside the force of the
// reference: the same tissue stepped in every tick with the poses of that tick.
#pragma once

#include "haptics/contact/coupling.h"
#include "sim/loop/haptic_loop.h"
#include "sim/loop/tissue_loop.h"
#include "sim/study/motions.h"

#include <functional>

namespace sim {

using ForceTrack = std::vector<std::array<glm::dvec3, kTools>>; // on the tools, by tick

/// The tools at a tick of a motion, at tips `tip_m`.
ToolsNow tools_at(std::int64_t tick, const Motion& motion,
                  const std::array<glm::dvec3, kTools>& tip_m, double tip_radius_m);

/// FEM in every tick (`substeps` 1) or more often, poses interpolated between ticks.
ForceTrack run_monolithic(const std::function<TissueRig(const TissueConfig&)>& make_rig,
                          const Motion& motion, double tip_radius_m, int substeps);

struct OpenLoopOptions {
    Coupling coupling = Coupling::anchored;
    int fem_hz = 100;
    int phase_ticks = 0;  // when the first FEM step samples, 0 .. period - 1
    int late_ticks = 0;   // answers come this much later than one period ...
    int jitter_ticks = 0; // ... plus up to this much, seeded
    std::uint64_t seed = 1;
    bool ease = true;
};
ForceTrack run_coupled(const std::function<TissueRig(const TissueConfig&)>& make_rig,
                       const Motion& motion, double tip_radius_m, const OpenLoopOptions& options);

/// How far a track is from the reference. Events: a tool's contact begins or ends in the
/// reference or in the track; steps within 2 ticks before and 6 after are reported apart.
struct ForceError {
    double peak_n = 0.0;
    double rms_percent = 0.0; // of the reference's peak
    double worst_mn = 0.0;
    double worst_relative_percent = 0.0; // where the reference is above 0.5 N, outside events
    double worst_small_mn = 0.0;         // where it is below, outside events
    double direction_deg = 0.0;          // worst, both above 0.1 N, outside events
    double step_p999_mn = 0.0, step_max_mn = 0.0, step_event_mn = 0.0;
    double ghost_mn = 0.0, lost_mn = 0.0;
    int events = 0;
    bool finite = true;
};
ForceError compare(const ForceTrack& track, const ForceTrack& reference, int tools);

} // namespace sim
