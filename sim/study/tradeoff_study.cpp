#include "sim/study/tradeoff_study.h"

#include "sim/study/locking_study.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace sim {
namespace {

using glm::dvec3;
using Say = std::function<void(const std::string&)>;

SolidCase case_of(const TradeoffOptions& o, const TradeoffWork& w, bool statics) {
    SolidCase work = o.beam;
    work.model = w.model;
    work.cells = w.cells;
    work.element = w.model == "linear" ? "p1" : "";
    work.statics = statics;
    return work;
}

std::array<int, 3> times(const std::array<int, 3>& cells, int n) {
    return {n * cells[0], n * cells[1], n * cells[2]};
}

SolidResult reference_run(const TradeoffOptions& o, int fineness, bool statics, const Say& say) {
    const TradeoffWork work{"reference", times(o.reference_cells, fineness)};
    say(fmt::format("reference {} {}", cells_name(work.cells), statics ? "at rest" : "falling"));
    SolidResult r = run_solid(case_of(o, work, statics));
    if (!r.failure.empty())
        throw std::runtime_error("the reference on " + cells_name(work.cells) + ": " + r.failure);
    return r;
}

// From meshes h and h/2, each missing c h^order.
dvec3 beyond(const dvec3& coarse, const dvec3& fine, double order) {
    return fine + (fine - coarse) / (std::pow(2.0, order) - 1.0);
}

TradeoffReference reference_of(const TradeoffOptions& o, const Say& say) {
    std::array<dvec3, 3> rest;
    for (int n = 1; n <= 3; ++n)
        rest[static_cast<std::size_t>(n - 1)] = reference_run(o, n, true, say).row.back().tip_m;
    const Extrapolated e =
        extrapolate(glm::length(rest[0]), glm::length(rest[1]), glm::length(rest[2]));
    TradeoffReference out{.order = e.order, .regular = e.regular};
    const double third = std::pow(3.0, -e.order);
    out.rest_m = e.regular ? rest[2] + (rest[2] - rest[0]) * third / (1.0 - third) : rest[2];
    out.left_percent = 1e2 * glm::length(out.rest_m - rest[2]) / glm::length(out.rest_m);
    const SolidResult coarse = reference_run(o, 1, false, say),
                      fine = reference_run(o, 2, false, say);
    double greatest = 0.0, left = 0.0;
    for (std::size_t i = 0; i < fine.row.size(); ++i) {
        const dvec3 tip = fine.row[i].tip_m;
        out.fall_m.push_back(e.regular ? beyond(coarse.row[i].tip_m, tip, e.order) : tip);
        greatest = std::max(greatest, glm::length(out.fall_m.back()));
        left = std::max(left, glm::length(out.fall_m.back() - tip));
    }
    out.fall_left_percent = 1e2 * left / greatest;
    out.lowest = first_lowest(out.fall_m);
    return out;
}

std::vector<dvec3> tips(const SolidResult& r) {
    std::vector<dvec3> out;
    for (const SolidRow& row : r.row)
        out.push_back(row.tip_m);
    return out;
}

TradeoffRow row_of(const TradeoffOptions& o, const TradeoffWork& work,
                   const TradeoffReference& reference) {
    constexpr double kLong_ms = 5e3; // in all
    SolidResult best;
    double spent_ms = 0.0;
    for (int round = 0; round < o.rounds && (round == 0 || spent_ms < kLong_ms); ++round) {
        const SolidResult r = run_solid(case_of(o, work, false));
        spent_ms += r.ms().mean * static_cast<double>(r.row.size());
        if (round == 0 || r.ms().mean < best.ms().mean)
            best = r;
    }
    TradeoffRow row;
    row.model = work.model;
    row.element = best.element;
    row.cells = work.cells;
    row.nodes = best.nodes;
    row.tets = best.tets;
    row.ms = best.ms();
    row.linear_residual = best.worst_linear_residual();
    row.residual = best.worst_residual();
    row.failure = best.failure;
    const SolidResult still = run_solid(case_of(o, work, true));
    if (row.failure.empty() && !still.failure.empty())
        row.failure = "at rest: " + still.failure;
    judge(reference, tips(best), still.settled ? still.row.back().tip_m : dvec3{kUnknown}, row);
    if (work.model == "quadratic")
        std::tie(row.factor_ms, row.solve_ms) = factor_and_solve_ms(case_of(o, work, false));
    return row;
}

} // namespace

std::vector<TradeoffWork> tradeoff_works() {
    std::vector<TradeoffWork> out;
    const auto add = [&](std::initializer_list<const char*> models,
                         std::initializer_list<std::array<int, 3>> meshes) {
        for (const char* model : models)
            for (const std::array<int, 3>& cells : meshes)
                out.push_back({model, cells});
    };
    add({"quadratic"}, {{6, 2, 2}, {8, 2, 2}, {10, 2, 2}, {14, 2, 2}, {14, 3, 3}});
    add({"reference"}, {{4, 1, 1}, {6, 2, 2}, {8, 2, 2}, {10, 2, 2}});
    add({"corotated", "linear", "xpbd", "mass-spring"},
        {{10, 2, 2}, {10, 3, 3}, {20, 4, 4}, {28, 7, 7}});
    add({"projective", "tled"}, {{6, 2, 2}, {10, 2, 2}, {10, 3, 3}, {20, 4, 4}});
    return out;
}

std::size_t first_lowest(std::span<const dvec3> way_m) {
    std::size_t i = 0;
    while (i + 1 < way_m.size() && glm::length(way_m[i + 1]) > glm::length(way_m[i]))
        ++i;
    return i + 1;
}

void judge(const TradeoffReference& reference, std::span<const dvec3> fall_m, const dvec3& rest_m,
           TradeoffRow& row) {
    row.rest_percent = 1e2 * glm::length(rest_m - reference.rest_m) / glm::length(reference.rest_m);
    if (fall_m.size() < reference.fall_m.size())
        return; // it ended on the way: no error says how wrong that is
    double greatest = 0.0, fall = 0.0, own = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < reference.fall_m.size(); ++i) {
        const double size = glm::length(reference.fall_m[i]);
        const double off = glm::length(fall_m[i] - reference.fall_m[i]);
        worst = std::max(worst, off);
        if (i < reference.lowest) {
            fall = worst;
            own = std::max(own, off / size);
        }
        greatest = std::max(greatest, size);
    }
    row.fall_percent = 1e2 * fall / greatest;
    row.fall_own_percent = 1e2 * own;
    row.swing_percent = 1e2 * worst / greatest;
}

TradeoffStudy run_tradeoff_study(const TradeoffOptions& o, const Say& say) {
    if (o.rounds < 1)
        throw std::invalid_argument(fmt::format("--rounds {}: accepted: from 1", o.rounds));
    for (const TradeoffWork& work : o.works) // before anything is computed
        check(case_of(o, work, false));
    TradeoffStudy study;
    study.reference = reference_of(o, say);
    for (const TradeoffWork& work : o.works) {
        study.row.push_back(row_of(o, work, study.reference));
        const TradeoffRow& r = study.row.back();
        say(fmt::format("{:<11} {:<8} {:>8.3f} ms  p99 {:>8.3f}  rest {:>7.2f} %  fall {:>7.2f} %  "
                        "swing {:>7.2f} % {}",
                        r.model, cells_name(r.cells), r.ms.mean, r.ms.p99, r.rest_percent,
                        r.fall_percent, r.swing_percent, r.failure));
    }
    for (const std::string& peer : o.peers)
        add_peer(o, peer, say, study);
    return study;
}

} // namespace sim
