// The tradeoff study's CSV, charts and page; see tradeoff_study.h.
#include "sim/study/machine.h"
#include "sim/study/tradeoff_study.h"
#include "sim/study/xy_chart.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace sim {
namespace {

std::string cell(double value, const char* format, const char* none) {
    return std::isnan(value) ? none : fmt::format(fmt::runtime(format), value);
}

std::string csv(const TradeoffStudy& study) {
    std::string out =
        "model,element,cells,nodes,tets,ms_mean,ms_p50,ms_p99,ms_max,rest_percent,"
        "fall_percent,fall_own_percent,swing_percent,linear_residual,nonlinear_residual,"
        "factor_ms,solve_ms,failure\n";
    for (const TradeoffRow& r : study.row) {
        out += fmt::format("{},{},{},{},{},{:.5g},{:.5g},{:.5g},{:.5g}", r.model, r.element,
                           cells_name(r.cells), r.nodes, r.tets, r.ms.mean, r.ms.p50, r.ms.p99,
                           r.ms.max);
        for (const double v : {r.rest_percent, r.fall_percent, r.fall_own_percent, r.swing_percent,
                               r.linear_residual, r.residual, r.factor_ms, r.solve_ms})
            out += "," + cell(v, "{:.5g}", "");
        out += "," + r.failure + "\n";
    }
    return out;
}

std::vector<std::string> notes_of(const TradeoffOptions& o, const TradeoffStudy& study) {
    const SolidCase& b = o.beam;
    return {fmt::format("Beam {:g} x {:g} x {:g} mm, clamped at one end, E {:g} kPa, nu {:g}, "
                        "{:g} kg/m3, g {:g} m/s2; the first {} steps of {:g} ms from straight",
                        1e3 * b.length_m, 1e3 * b.height_m, 1e3 * b.width_m,
                        1e-3 * b.material.young_pa, b.material.poisson, b.material.density_kgpm3,
                        b.gravity_mps2, b.steps, 1e3 * b.dt_s),
            fmt::format("Reference: converged neo-Hooke on ten-node tetrahedra, {} and finer, {}",
                        cells_name(o.reference_cells),
                        study.reference.regular
                            ? fmt::format("extrapolated at order {:.2f}", study.reference.order)
                            : std::string("not extrapolated: no order")),
            "CPU time of all threads on " + machine()};
}

std::vector<std::string> models_of(const TradeoffStudy& study) {
    std::vector<std::string> out;
    for (const TradeoffRow& r : study.row)
        if (std::ranges::find(out, r.model) == out.end())
            out.push_back(r.model);
    return out;
}

std::string chart(const TradeoffOptions& o, const TradeoffStudy& study, const char* title,
                  const char* y, double TradeoffRow::*error) {
    XyChart c{.title = title, .notes = notes_of(o, study)};
    double low = 1e9, high = 0.0;
    for (const TradeoffRow& r : study.row) {
        low = std::min({low, r.ms.mean, r.factor_ms > 0.0 ? r.factor_ms : low});
        high = std::max({high, r.ms.mean, r.factor_ms > 0.0 ? r.factor_ms + r.solve_ms : 0.0});
    }
    c.x = {.title = "ms of CPU per step, mean",
           .low = 0.7 * low,
           .high = 1.5 * high,
           .logarithmic = true};
    c.y = {.title = y, .low = 0.1, .high = 200.0, .logarithmic = true};
    c.gates = {{0.1, o.gate_percent, fmt::format("up to {:g} %", o.gate_percent)}};
    constexpr std::array kMark{XyMark::disc, XyMark::square, XyMark::triangle, XyMark::diamond};
    for (const std::string& model : models_of(study)) {
        const std::size_t k = c.series.size();
        XySeries s{model, static_cast<int>(k), kMark[k % kMark.size()], true, false, {}};
        for (const TradeoffRow& r : study.row)
            if (r.model == model)
                s.point.emplace_back(r.ms.mean, r.failure.empty() ? r.*error : kUnknown);
        c.series.push_back(s);
    }
    XySeries stored{"quadratic, matrix factored anew", 0, XyMark::disc, true, true, {}};
    for (const XySeries& s : c.series)
        if (s.name == "quadratic")
            stored.colour = s.colour, stored.mark = s.mark;
    for (const TradeoffRow& r : study.row)
        if (r.factor_ms > 0.0)
            stored.point.emplace_back(r.factor_ms + r.solve_ms, r.*error);
    if (!stored.point.empty())
        c.series.push_back(stored);
    return xy_svg(c);
}

std::string table(const TradeoffStudy& study) {
    std::string out =
        "| model | cells | nodes | tets | ms mean | p50 | p99 | max | at rest, % | in the fall, % "
        "| (of its own place) | swinging, % | linear residual | nonlinear | factor + solve ms | |"
        "\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const TradeoffRow& r : study.row) {
        out += fmt::format("| {} {} | {} | {} | {} | {:.3g} | {:.3g} | {:.3g} | {:.3g} |", r.model,
                           r.element, cells_name(r.cells), r.nodes, r.tets, r.ms.mean, r.ms.p50,
                           r.ms.p99, r.ms.max);
        for (const double v : {r.rest_percent, r.fall_percent, r.fall_own_percent, r.swing_percent})
            out += " " + cell(v, "{:.2f}", "-") + " |";
        for (const double v : {r.linear_residual, r.residual})
            out += " " + cell(v, "{:.1e}", "-") + " |";
        out += (r.factor_ms > 0.0 ? fmt::format(" {:.3g} + {:.3g} |", r.factor_ms, r.solve_ms)
                                  : std::string(" - |")) +
               " " + r.failure + " |\n";
    }
    return out;
}

// What is cheapest within the gate, at rest and in the fall.
std::string verdict(const TradeoffOptions& o, const TradeoffStudy& study) {
    std::string out =
        fmt::format("## Cheapest within {:g} %, at rest and in the fall\n\n", o.gate_percent);
    for (const std::string& model : models_of(study)) {
        const TradeoffRow* best = nullptr;
        for (const TradeoffRow& r : study.row)
            if (r.model == model && r.failure.empty() && r.rest_percent <= o.gate_percent &&
                r.fall_percent <= o.gate_percent && (!best || r.ms.mean < best->ms.mean))
                best = &r;
        out += best ? fmt::format("- {}: {} ({} nodes), {:.3g} ms a step, p99 {:.3g} ms, {:.2f} % "
                                  "at rest, {:.2f} % in the fall\n",
                                  model, cells_name(best->cells), best->nodes, best->ms.mean,
                                  best->ms.p99, best->rest_percent, best->fall_percent)
                    : fmt::format("- {}: none of these meshes\n", model);
    }
    return out;
}

std::string page(const TradeoffOptions& o, const TradeoffStudy& study) {
    const TradeoffReference& ref = study.reference;
    std::string out = "# Error against time\n\n";
    for (const std::string& note : notes_of(o, study))
        out += note + ".\n";
    out += fmt::format(
        "Tip (middle of the end face) of the reference at rest: ({:.2f}, {:.2f}, {:.2f}) mm; its "
        "finest mesh at rest misses that by {:.2f} %, its finest in motion the extrapolated motion "
        "by {:.2f} % at "
        "most.\nIn the fall: the worst step until the reference first hangs lowest (step {}), "
        "relative to its greatest displacement; in brackets relative to where it is in that step. "
        "Swinging: the worst of all steps, where a body a little too stiff is ahead in every "
        "swing. "
        "At rest: where a model ends, by its own statics, or by its own steps, damped. The "
        "quickest of up to {} rounds. Residuals: the worst of all steps; explicit methods have "
        "none, one Newton iteration a step leaves a nonlinear one. Corotated, linear and the "
        "baselines have four-node tetrahedra: with the same cells they have a fifth to an eighth "
        "of the nodes.\n\n![at rest](tradeoff.svg)\n![in the fall](tradeoff_fall.svg)\n\n",
        1e3 * ref.rest_m.x, 1e3 * ref.rest_m.y, 1e3 * ref.rest_m.z, ref.left_percent,
        ref.fall_left_percent, ref.lowest, o.rounds);
    out += verdict(o, study) + "\n## All\n\n" + table(study);
    for (const auto& [peer, why] : study.gap)
        out += fmt::format("\nMissing: {}: {}.\n", peer, why);
    return out;
}

} // namespace

std::vector<std::pair<std::string, std::string>> tradeoff_files(const TradeoffOptions& options,
                                                                const TradeoffStudy& study) {
    return {{"tradeoff.csv", csv(study)},
            {"tradeoff.svg", chart(options, study, "Error at rest against time",
                                   "tip at rest off, %", &TradeoffRow::rest_percent)},
            {"tradeoff_fall.svg", chart(options, study, "Error in the fall against time",
                                        "tip off until it first hangs lowest, %, worst step",
                                        &TradeoffRow::fall_percent)},
            {"tradeoff.md", page(options, study)}};
}

} // namespace sim
