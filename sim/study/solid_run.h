// sim/study/solid_run.h
// One solid, one model, some steps or its rest: what came out, how well, how long it took. Called
// by trocar study beam, block and cook and by the charts made of such runs; one thread.
#pragma once

#include "sim/study/solid_case.h"
#include "sim/study/solid_effort.h"

namespace sim {

/// After a step, or at rest under one of the loads.
struct SolidRow {
    double t_s = 0.0;                    // 0 in statics
    double force_n = 0.0, depth_m = 0.0; // on the loaded face, and its mean way along the load
    glm::dvec3 tip_m{0.0};               // displacement of the middle of the loaded face
    double ms = 0.0;                     // CPU of the process, all threads
    SolidEffort effort;
};

struct SolidTimes {
    double mean = 0.0, p50 = 0.0, p99 = 0.0, max = 0.0;
};

struct SolidResult {
    std::string model{}, element{}; // element: p1, p2
    std::size_t nodes = 0, tets = 0;
    std::vector<SolidRow> row{};
    /// Statics: equilibrium found. Steps: the tip stayed where it was, to 0.1 % of its way, for the
    /// last tenth of them.
    bool settled = false;
    std::string failure{}; // empty, or what happened and when

    SolidTimes ms() const;
    int newton_iterations() const; // in all
    int linear_iterations() const;
    int substeps() const; // of the baselines
    // the worst of the rows that know it; not a number if none does
    double worst_residual() const;
    double worst_linear_residual() const;
    /// Of what the model sets out to solve: one linear system a step if it is corotated.
    double own_residual() const;
};

/// Steps end with the first that is not finite or does not converge; the row before is the last.
/// Statics of models that have none: steps of dt_s, damped by mass as much as lets them rest
/// soonest, until the tip stays where it is, to 0.1 %, for 100 steps (under a punch it does so at
/// once: just 100 steps). Throws as check(SolidCase).
SolidResult run_solid(const SolidCase& work);

/// t_s,force_n,depth_m,tip_x_m,tip_y_m,tip_z_m,ms,newton,linear,substeps,linear_residual,residual:
/// a line per row; what the model does not know stays empty.
std::string solid_csv(const SolidResult& result);

} // namespace sim
