#include "sim/study/large_study.h"

#include "sim/study/machine.h"
#include "sim/study/xy_chart.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace sim {
namespace {

double load_n(const LargeOptions& o, double alpha) {
    const double inertia_m4 = o.bar.width_m * std::pow(o.bar.height_m, 3) / 12.0;
    return alpha * o.bar.material.young_pa * inertia_m4 / (o.bar.length_m * o.bar.length_m);
}

LargeRow row_of(const LargeOptions& o, const std::string& model, double alpha) {
    SolidCase work = o.bar;
    work.statics = true;
    work.model = model;
    work.load_n = {load_n(o, alpha)};
    const SolidResult result = run_solid(work);
    LargeRow row{
        .model = model, .alpha = alpha, .load_n = work.load_n[0], .failure = result.failure};
    const glm::dvec3 tip =
        result.row.empty() ? glm::dvec3{kUnknown} : result.row.back().tip_m / work.length_m;
    row.deflection = -tip.y;
    row.shortening = -tip.x;
    const Elastica theory = elastica(alpha);
    row.deflection_error = row.deflection / theory.deflection - 1.0;
    row.shortening_error = row.shortening / theory.shortening - 1.0;
    row.within = std::abs(row.deflection_error) <= o.gate_deflection &&
                 std::abs(row.shortening_error) <= o.gate_shortening;
    return row;
}

std::string csv(const std::vector<LargeRow>& rows) {
    std::string out = "model,alpha,load_n,deflection_over_length,elastica,relative_error,"
                      "shortening_over_length,elastica,relative_error,within,failure\n";
    for (const LargeRow& r : rows) {
        const Elastica e = elastica(r.alpha);
        out += fmt::format("{},{:g},{:.9g},{:.9g},{:.9g},{:.6g},{:.9g},{:.9g},{:.6g},{},{}\n",
                           r.model, r.alpha, r.load_n, r.deflection, e.deflection,
                           r.deflection_error, r.shortening, e.shortening, r.shortening_error,
                           r.within ? 1 : 0, r.failure);
    }
    return out;
}

std::vector<std::string> notes_of(const LargeOptions& o) {
    return {fmt::format("Bar {:g} x {:g} x {:g} mm, cells {}, E {:g} kPa, nu {:g}, end load that "
                        "keeps its direction; statics",
                        1e3 * o.bar.length_m, 1e3 * o.bar.height_m, 1e3 * o.bar.width_m,
                        cells_name(o.bar.cells), 1e-3 * o.bar.material.young_pa,
                        o.bar.material.poisson),
            "Reference: the elastica by elliptic integrals", machine()};
}

XyAxis alpha_axis(const LargeOptions& o) {
    const auto [least, most] = std::ranges::minmax(o.alphas);
    return {.title = "alpha = P L^2/(E I)",
            .low = 0.8 * least,
            .high = 1.25 * most,
            .logarithmic = true,
            .ticks = o.alphas};
}

// A model's points within the gates, and apart those that are not.
void add_model(const LargeOptions& o, const std::vector<LargeRow>& rows, std::size_t index,
               double LargeRow::*figure, bool named, std::vector<XySeries>& out) {
    const std::string& model = o.models[index];
    const XyMark mark = model == "reference" ? XyMark::ring : XyMark::disc;
    const int colour = static_cast<int>(index) + 1;
    XySeries good{named ? model : "", colour, mark, false, false, {}};
    XySeries bad{
        named ? model + ", outside its gates" : "", colour, XyMark::cross, false, false, {}};
    for (const LargeRow& r : rows)
        if (r.model == model)
            (r.within ? good : bad).point.emplace_back(r.alpha, r.*figure);
    for (const XySeries& s : {good, bad})
        if (!s.point.empty())
            out.push_back(s);
}

std::string shape_chart(const LargeOptions& o, const std::vector<LargeRow>& rows) {
    XyChart c{.title = "Large bending: where the tip of a cantilever goes",
              .notes = notes_of(o),
              .x = alpha_axis(o),
              .y = {.title = "of the length", .low = 0.0, .high = 1.0}};
    XySeries down{"elastica, deflection", 6, XyMark::none, true, false, {}};
    XySeries short_of{"elastica, shortening", 6, XyMark::none, true, true, {}};
    constexpr int kPoints = 100;
    for (int k = 0; k <= kPoints; ++k) {
        const double alpha = c.x.low * std::pow(c.x.high / c.x.low, k / double{kPoints});
        down.point.emplace_back(alpha, elastica(alpha).deflection);
        short_of.point.emplace_back(alpha, elastica(alpha).shortening);
    }
    c.series = {down, short_of};
    for (std::size_t m = 0; m < o.models.size(); ++m) {
        add_model(o, rows, m, &LargeRow::deflection, true, c.series);
        add_model(o, rows, m, &LargeRow::shortening, false, c.series);
    }
    return xy_svg(c);
}

std::string error_chart(const LargeOptions& o, const std::vector<LargeRow>& rows) {
    XyChart c{.title = "Large bending: error of the deflection",
              .notes = notes_of(o),
              .x = alpha_axis(o),
              .y = {.title = "deflection / elastica - 1, %",
                    .low = 0.01,
                    .high = 1000.0,
                    .logarithmic = true}};
    c.gates = {{0.01, 1e2 * o.gate_deflection, fmt::format("{:g} %", 1e2 * o.gate_deflection)}};
    for (std::size_t m = 0; m < o.models.size(); ++m) {
        const bool ring = o.models[m] == "reference"; // around ours
        XySeries s{
            o.models[m], static_cast<int>(m) + 1, ring ? XyMark::ring : XyMark::disc, true, ring,
            {}};
        for (const LargeRow& r : rows)
            if (r.model == o.models[m])
                s.point.emplace_back(r.alpha, 1e2 * std::abs(r.deflection_error));
        c.series.push_back(s);
    }
    return xy_svg(c);
}

// P L/(kappa G A) over P L^3/(3 E I), kappa = 10 (1 + nu)/(12 + 11 nu) (Cowper 1966).
double shear_share(const LargeOptions& o) {
    const double slender = o.bar.height_m / o.bar.length_m;
    return 0.05 * (12.0 + 11.0 * o.bar.material.poisson) * slender * slender;
}

std::string page(const LargeOptions& o, const std::vector<LargeRow>& rows) {
    std::string out = "# Large bending\n\n";
    for (const std::string& note : notes_of(o))
        out += note + ".\n";
    out += fmt::format("Gates: {:g} % of the deflection w, {:g} % of the shortening u.\n\n"
                       "![tip](large.svg)\n![error](large_error.svg)\n\n"
                       "The linear law knows neither shortening nor that a turned piece resists "
                       "as it did before: its deflection grows with the load without end. "
                       "Corotated linear tetrahedra turn, but bend too little on such a mesh at "
                       "any load. Ten-node tetrahedra at finite strain follow the elastica; shear "
                       "({:.2g} % here by Timoshenko) and strains of some percent, which the "
                       "elastica has none of, are what is left.\n",
                       1e2 * o.gate_deflection, 1e2 * o.gate_shortening, 1e2 * shear_share(o));
    for (const std::string& model : o.models) {
        int within = 0, all = 0;
        double worst_w = 0.0, worst_u = 0.0;
        out += fmt::format("\n## {}\n\n| alpha | w/L | error | u/L | error | |\n"
                           "|---|---|---|---|---|---|\n",
                           model);
        for (const LargeRow& r : rows) {
            if (r.model != model)
                continue;
            ++all;
            within += r.within ? 1 : 0;
            worst_w = std::fmax(worst_w, std::abs(r.deflection_error));
            worst_u = std::fmax(worst_u, std::abs(r.shortening_error));
            out += fmt::format("| {:g} | {:.5f} | {:+.2f} % | {:.5f} | {:+.2f} % | {} |\n", r.alpha,
                               r.deflection, 1e2 * r.deflection_error, r.shortening,
                               1e2 * r.shortening_error,
                               !r.failure.empty() ? r.failure
                               : r.within         ? "within"
                                                  : "**outside**");
        }
        out += fmt::format("\n{} of {} within the gates; worst {:.2f} % (w), {:.2f} % (u).\n",
                           within, all, 1e2 * worst_w, 1e2 * worst_u);
    }
    return out;
}

} // namespace

LargeOptions::LargeOptions() {
    bar.length_m = 0.2;
    bar.height_m = bar.width_m = 0.01;
    bar.cells = {40, 2, 2};
    bar.material.poisson = 0.0;
    bar.gravity_mps2 = 0.0;
    bar.statics = true;
}

std::vector<LargeRow> run_large_study(const LargeOptions& o,
                                      const std::function<void(const LargeRow&)>& progress) {
    if (o.alphas.empty() || !(*std::ranges::min_element(o.alphas) > 0.0))
        throw std::invalid_argument("--alphas: accepted: above 0, up to 1000, at least one");
    for (const std::string& model : o.models) { // before anything is computed
        SolidCase work = o.bar;
        work.model = model;
        check(work);
    }
    std::vector<LargeRow> rows;
    for (const std::string& model : o.models)
        for (const double alpha : o.alphas) {
            rows.push_back(row_of(o, model, alpha));
            progress(rows.back());
        }
    return rows;
}

std::vector<std::pair<std::string, std::string>> large_files(const LargeOptions& options,
                                                             const std::vector<LargeRow>& rows) {
    return {{"large.csv", csv(rows)},
            {"large.svg", shape_chart(options, rows)},
            {"large_error.svg", error_chart(options, rows)},
            {"large.md", page(options, rows)}};
}

} // namespace sim
