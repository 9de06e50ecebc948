// tasks/hand/trace.h
// Drawing along a curve on tissue: where on it the hand is, and how its aim wanders. Part of Hand;
// ticked in every millisecond of a trace, no allocation.
#pragma once

#include "tasks/exercise/observation.h"
#include "tasks/hand/random.h"

namespace tasks {

struct Trace {
    // The curve as it lay before the tip came down: what a press pushes in is no reason to follow
    // it down, the force tells how deep.
    std::array<glm::dvec3, kMaxTargets> point_m{}, normal{};
    int points = 0;
    double u = 0.0;              // of tasks/exercise/path_curve.h
    glm::dvec3 wander_m{0.0};    // where the hand wrongly takes the curve to be
    glm::dvec3 corrected_m{0.0}; // what the eye has made good since
    double beyond_m = 0.0;       // past the last point: nobody stops short on purpose
    int end_ticks = 0;           // since the end was reached
};

/// At the point that is to be taken up, on the curve as it is now.
Trace begin_trace(const Observation& seen, int from_point);

glm::dvec3 place_m(const Trace& trace) noexcept;
glm::dvec3 normal_at(const Trace& trace) noexcept;

/// How far the tip is beside the curve of now, across it and along the surface.
glm::dvec3 aside_m(const Trace& trace, const Observation& seen,
                   const ToolObservation& tool) noexcept;

/// One millisecond. `way_m`: along the curve. `aim_m`: rms of the wandering. `seen_aside_m`: as
/// late as the eye is; corrected within `pursuit_s`.
void advance(Trace& trace, double way_m, double aim_m, const glm::dvec3& seen_aside_m,
             double pursuit_s, Random& random) noexcept;

} // namespace tasks
