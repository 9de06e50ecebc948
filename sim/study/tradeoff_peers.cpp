// What tradeoff_study.h measures beside our models: CHOLMOD on the quadratic matrix, and programs.
#include "sim/study/peer_program.h"
#include "sim/study/tradeoff_study.h"
#include "tissue/solver/quadratic.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace sim {
namespace {

using nlohmann::json;

double cpu_ms() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double number(const json& value) {
    return value.is_number() ? value.get<double>() : kUnknown;
}

glm::dvec3 vector(const json& value) {
    return {number(value.at(0)), number(value.at(1)), number(value.at(2))};
}

// The standard beam is all that peers know.
bool standard(const SolidCase& w) {
    return w.length_m == 0.2 && w.height_m == 0.04 && w.width_m == 0.04 &&
           w.load_n == std::vector{0.0} && w.material.damping_mass_1ps == 0.0 &&
           w.material.damping_stiffness_s == 0.0;
}

PeerOutput ask(const TradeoffOptions& o, const std::string& peer, const std::array<int, 3>& cells,
               int steps) {
    const SolidCase& w = o.beam;
    return run_peer_program(o.peer_dir / (peer + "_peer"),
                            {"--cells", cells_name(cells), "--young",
                             fmt::format("{}", w.material.young_pa), "--poisson",
                             fmt::format("{}", w.material.poisson), "--density",
                             fmt::format("{}", w.material.density_kgpm3), "--gravity",
                             fmt::format("{}", w.gravity_mps2), "--dt", fmt::format("{}", w.dt_s),
                             "--steps", fmt::format("{}", steps)});
}

TradeoffRow row_of(const std::string& peer, const std::array<int, 3>& cells, const json& timed,
                   const json& settled, const TradeoffReference& reference) {
    TradeoffRow row;
    row.model = fmt::format("{} {}", peer, timed.at("versions").value(peer, ""));
    row.element = "p1";
    row.cells = cells;
    row.nodes = timed.at("nodes");
    row.tets = timed.at("tets");
    const json& ms = timed.at("cpu_ms");
    row.ms = {number(ms.at("mean")), number(ms.at("p50")), number(ms.at("p99")),
              number(ms.at("max"))};
    row.linear_residual = number(timed.at("linear_residual").at("max"));
    if (timed.value("bad_states", 0) + settled.value("bad_states", 0) > 0)
        row.failure = "bad states";
    else if (!settled.value("settled", false))
        row.failure = "at rest: not settled";
    std::vector<glm::dvec3> fall;
    for (const json& tip : timed.at("tip_each_step_m"))
        fall.push_back(vector(tip));
    judge(reference, fall,
          settled.value("settled", false) ? vector(settled.at("tip_m")) : glm::dvec3{kUnknown},
          row);
    return row;
}

} // namespace

std::pair<double, double> factor_and_solve_ms(const SolidCase& work) {
    const SolidBody body = make_solid_body(work);
    const auto model =
        tissue::make_quadratic(body.quadratic, work.material, body.clamped, {0.0, 0.0, 0.0});
    std::vector<double> matrix = model.rest_stiffness_npm;
    for (std::size_t k = 0; k < matrix.size(); ++k)
        matrix[k] += model.rest_mass_kg[k] / (work.dt_s * work.dt_s);
    tissue::SparseFactor factor(model.pattern);
    std::vector<double> right(static_cast<std::size_t>(model.unknowns), 1.0);
    double factor_ms = 1e9, solve_ms = 1e9;
    for (int i = 0; i < 10; ++i) {
        const double start = cpu_ms();
        factor.factor(matrix);
        const double between = cpu_ms();
        factor.solve(right, 1);
        factor_ms = std::min(factor_ms, between - start);
        solve_ms = std::min(solve_ms, cpu_ms() - between);
    }
    return {factor_ms, solve_ms};
}

void add_peer(const TradeoffOptions& o, const std::string& peer,
              const std::function<void(const std::string&)>& say, TradeoffStudy& study) {
    constexpr int kRest = 1000; // steps, after which undamped implicit Euler hangs still
    if (!standard(o.beam)) {
        study.gap.emplace_back(peer, "it knows only the beam of 0.2 x 0.04 x 0.04 m under its "
                                     "weight, undamped");
        return;
    }
    for (const std::array<int, 3>& cells : o.peer_cells) {
        const PeerOutput timed = ask(o, peer, cells, o.beam.steps);
        const PeerOutput rest =
            timed.gap.empty() ? ask(o, peer, cells, std::max(kRest, o.beam.steps)) : timed;
        std::string gap = rest.gap;
        if (gap.empty()) {
            try {
                study.row.push_back(row_of(peer, cells, json::parse(timed.text),
                                           json::parse(rest.text), study.reference));
                const TradeoffRow& r = study.row.back();
                say(fmt::format("{} {} {:.3f} ms  rest {:.2f} %  fall {:.2f} % {}", r.model,
                                cells_name(cells), r.ms.mean, r.rest_percent, r.fall_percent,
                                r.failure));
            } catch (const json::exception& e) {
                gap = fmt::format("what it said is not understood: {}", e.what());
            }
        }
        if (!gap.empty()) {
            study.gap.emplace_back(peer, fmt::format("on {}: {}", cells_name(cells), gap));
            return;
        }
    }
}

} // namespace sim
