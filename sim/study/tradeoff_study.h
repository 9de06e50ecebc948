// sim/study/tradeoff_study.h
// trocar study tradeoff: how wrong a falling, then hanging beam is against what a step of it costs,
// for every tissue model on several meshes, and for peers on the same meshes. All begin straight
// and take the same steps. The reference is the converged solver on three meshes, extrapolated, at
// rest and, at the same step, on the way. Times are CPU times of the process over all its threads,
// all of a step counted.
#pragma once

#include "sim/study/solid_run.h"

#include <filesystem>
#include <functional>

namespace sim {

struct TradeoffWork {
    std::string model;
    std::array<int, 3> cells{};
};

/// Every model on at least four meshes.
std::vector<TradeoffWork> tradeoff_works();

struct TradeoffOptions {
    SolidCase beam; // model, element, cells and statics are set per row; --steps are what is timed
    std::vector<TradeoffWork> works = tradeoff_works();
    std::array<int, 3> reference_cells{10, 2, 2}; // and twice, at rest also three times as fine
    int rounds = 3;            // of which the quickest counts; one of a model that takes long
    double gate_percent = 3.0; // of the charts
    std::vector<std::string> peers{"mujoco"};
    std::vector<std::array<int, 3>> peer_cells{{10, 2, 2}, {10, 3, 3}, {20, 4, 4}, {28, 7, 7}};
    std::filesystem::path peer_dir;
};

/// The tip: at rest, and after each step.
struct TradeoffReference {
    glm::dvec3 rest_m{0.0};
    std::vector<glm::dvec3> fall_m{};
    double order = 0.0;             // of convergence at rest
    double left_percent = 0.0;      // from the finest mesh at rest to the limit
    double fall_left_percent = 0.0; // the same on the way, at most, of its greatest displacement
    std::size_t lowest = 0;         // steps until it first hangs lowest
    bool regular = false;           // the meshes show an order; else the finest is taken
};

struct TradeoffRow {
    std::string model, element;
    std::array<int, 3> cells{};
    std::size_t nodes = 0, tets = 0;
    SolidTimes ms;
    double rest_percent = kUnknown; // of the tip at rest, relative to the reference's
    // of the tip until the reference first hangs lowest, the worst step, relative to the
    // reference's greatest displacement, and to where the reference is in that step
    double fall_percent = kUnknown, fall_own_percent = kUnknown;
    double swing_percent = kUnknown; // of all steps, relative to its greatest displacement
    double linear_residual = kUnknown, residual = kUnknown; // the worst of all steps
    double factor_ms = kUnknown, solve_ms = kUnknown; // CHOLMOD, of the same matrix: quadratic only
    std::string failure;
};

struct TradeoffStudy {
    TradeoffReference reference;
    std::vector<TradeoffRow> row;
    std::vector<std::pair<std::string, std::string>> gap; // peer, why it is missing
};

/// Steps until the displacement is greatest for the first time.
std::size_t first_lowest(std::span<const glm::dvec3> way_m);

/// Errors of a way and of where it settled (not a number: it did not).
void judge(const TradeoffReference& reference, std::span<const glm::dvec3> fall_m,
           const glm::dvec3& rest_m, TradeoffRow& row);

/// `say` hears of each row, and of the reference's progress. Throws as check(SolidCase).
TradeoffStudy run_tradeoff_study(const TradeoffOptions& options,
                                 const std::function<void(const std::string&)>& say);

/// CPU ms of CHOLMOD's factor and solve of M/dt^2 + K at rest on ten-node tetrahedra: what a step
/// costs at least if its matrix is stored and factored anew. The quickest of ten.
std::pair<double, double> factor_and_solve_ms(const SolidCase& work);

/// A row per mesh of a peer program, or a gap.
void add_peer(const TradeoffOptions& options, const std::string& peer,
              const std::function<void(const std::string&)>& say, TradeoffStudy& study);

/// Names and texts of tradeoff.csv, tradeoff.svg (at rest), tradeoff_fall.svg (on the way),
/// tradeoff.md.
std::vector<std::pair<std::string, std::string>> tradeoff_files(const TradeoffOptions& options,
                                                                const TradeoffStudy& study);

} // namespace sim
