// sim/study/locking_study.h
// trocar study locking: how far a clamped bar bends as Poisson's ratio nears 1/2, by model and
// mesh, over how far it should (F10). Small deflections, so that laws do not matter. The reference
// is the linear law on ten-node tetrahedra in three meshes, extrapolated; the clamped edge is
// singular, so the order of convergence is measured, not assumed.
#pragma once

#include "sim/study/solid_run.h"

#include <functional>

namespace sim {

struct LockingCurve {
    std::string model;
    std::array<int, 3> cells{};
};

struct LockingOptions {
    SolidCase bar; // statics; model, element and cells are those of the curves
    std::vector<double> poissons{0.3, 0.35, 0.4, 0.45, 0.47, 0.49, 0.495, 0.499};
    std::vector<LockingCurve> curves{{"corotated", {10, 2, 2}}, {"corotated", {20, 4, 4}},
                                     {"corotated", {40, 8, 8}}, {"quadratic", {10, 2, 2}},
                                     {"quadratic", {14, 2, 2}}, {"quadratic", {15, 3, 3}}};
    std::array<int, 3> reference_cells{10, 2, 2}; // and twice and three times as many each way
    LockingOptions();
};

/// Of values at meshes h, h/2, h/3: c h^p is what each misses.
struct Extrapolated {
    double limit = 0.0, order = 0.0;
    bool regular = false; // the three are of one sign and order; else: limit is the last of them
};
Extrapolated extrapolate(double coarse, double middle, double fine);

struct LockingRow {
    double poisson = 0.0;
    std::string model; // "reference" too
    std::array<int, 3> cells{};
    std::size_t nodes = 0;
    double mean_m = 0.0; // deflection of the end face
    double ratio = 0.0;  // over the reference; not a number: failed
    std::string failure;
};

struct LockingStudy {
    std::vector<LockingRow> row;         // by Poisson's ratio, the reference first, then the curves
    std::vector<Extrapolated> reference; // one per Poisson's ratio
};

/// `progress` hears of each row. Throws std::invalid_argument as check(SolidCase).
LockingStudy run_locking_study(const LockingOptions& options,
                               const std::function<void(const LockingRow&)>& progress);

/// Names and texts of locking.csv, locking.svg and locking.md.
std::vector<std::pair<std::string, std::string>> locking_files(const LockingOptions& options,
                                                               const LockingStudy& study);

} // namespace sim
