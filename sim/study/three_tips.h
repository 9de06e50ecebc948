// sim/study/three_tips.h
// What whole FEM steps cost under work: three tips that press on one body and slide round on it,
// local models of all three included. Called by the studies of complexity and of organs; times are
// this machine's, of all threads.
#pragma once

#include "sim/loop/tissue_loop.h"

namespace sim {

/// Where a tip works: it goes round `place_m` in the plane across `out`.
struct TipSeat {
    glm::dvec3 place_m{0.0}, out{0.0, 0.0, 1.0}; // on the skin; unit
    glm::dvec3 across{1.0, 0.0, 0.0};            // unit, across `out`
};
using TipSeats = std::array<TipSeat, kTools>;

struct ThreeTipsOptions {
    double radius_m = 1.5e-3; // of each tip
    double depth_m = 4e-3;    // most of each
    int steps = 100;          // timed
};

struct StepTimes {
    double resting_ms = 0.0;                                        // a step before any touch
    double mean_ms = 0.0, p50_ms = 0.0, p99_ms = 0.0, max_ms = 0.0; // CPU
    double linear_residual = 0.0, residual = 0.0, force_n = 0.0;    // worst, worst, largest
};

/// Each tip goes down and up again once in a second, and round a circle of 5 mm meanwhile, so that
/// its contact point slides: at 31 mm/s, however many steps are timed. They begin one after the
/// other. The rig has one body, which must be at rest.
StepTimes time_three_tips(TissueRig& rig, const TipSeats& seats, const ThreeTipsOptions& options);

/// CPU of this process so far, all threads.
double process_cpu_s();

} // namespace sim
