#include "sim/study/locking_study.h"

#include "sim/study/machine.h"
#include "sim/study/xy_chart.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace sim {
namespace {

std::string name_of(const LockingCurve& c) {
    return c.model + " " + cells_name(c.cells);
}

SolidCase case_of(const LockingOptions& o, const LockingCurve& curve, double poisson) {
    SolidCase work = o.bar;
    work.statics = true;
    work.model = curve.model;
    work.cells = curve.cells;
    work.material.poisson = poisson;
    return work;
}

LockingRow row_of(const LockingOptions& o, const LockingCurve& curve, double poisson) {
    const SolidResult r = run_solid(case_of(o, curve, poisson));
    LockingRow row{.poisson = poisson,
                   .model = curve.model,
                   .cells = curve.cells,
                   .nodes = r.nodes,
                   .mean_m = r.row.empty() ? kUnknown : r.row.back().depth_m,
                   .failure = r.failure};
    return row;
}

std::array<int, 3> times(const std::array<int, 3>& cells, int n) {
    return {n * cells[0], n * cells[1], n * cells[2]};
}

std::string csv(const LockingStudy& study) {
    std::string out = "poisson,model,cells,nodes,mean_deflection_m,over_reference,failure\n";
    for (const LockingRow& r : study.row)
        out += fmt::format("{:.6g},{},{},{},{:.9g},{:.6g},{}\n", r.poisson, r.model,
                           cells_name(r.cells), r.nodes, r.mean_m, r.ratio, r.failure);
    return out;
}

std::string work_of(const LockingOptions& o) {
    return fmt::format("Bar {} x {} x {} mm, E {} kPa, {} N on its end, clamped at the other",
                       1e3 * o.bar.length_m, 1e3 * o.bar.height_m, 1e3 * o.bar.width_m,
                       1e-3 * o.bar.material.young_pa, o.bar.load_n[0]);
}

std::string chart(const LockingOptions& o, const LockingStudy& study) {
    XyChart c{.title = "Locking: how far a bar bends, over how far it should",
              .notes = {work_of(o),
                        "Reference: linear elasticity, ten-node tetrahedra, extrapolated from " +
                            cells_name(o.reference_cells) + ", twice and three times as fine",
                        machine()},
              .x = {.title = "Poisson's ratio", .low = 0.3, .high = 0.5},
              .y = {.title = "deflection / reference", .low = 0.0, .high = 1.2}};
    const auto [least, most] = std::ranges::minmax(o.poissons);
    c.x.low = std::min(least, 0.3);
    c.x.high = std::max(most, 0.5);
    c.gates = {{0.95, 1.05, "within 5 %"}};
    std::vector<std::string> models;
    for (const LockingCurve& curve : o.curves) {
        if (std::ranges::find(models, curve.model) == models.end())
            models.push_back(curve.model);
        XySeries s{.name = name_of(curve),
                   .colour = static_cast<int>(c.series.size()),
                   .mark = models.size() % 2 == 1 ? XyMark::disc : XyMark::square};
        for (const LockingRow& r : study.row)
            if (r.model == curve.model && r.cells == curve.cells) {
                s.point.emplace_back(r.poisson, r.ratio);
                s.name = fmt::format("{}, {} nodes", name_of(curve), r.nodes);
            }
        c.series.push_back(s);
    }
    return xy_svg(c);
}

std::string page(const LockingOptions& o, const LockingStudy& study) {
    std::string out = fmt::format(
        "# Locking\n\n{}. Statics; every number is the mean deflection of the end face over the "
        "reference's. Machine: {}.\n\n![locking](locking.svg)\n\nLinear tetrahedra answer for the "
        "volume of every tet: near nu = 1/2 there are more volumes to be kept than nodes to move, "
        "and the bar stiffens with the number, not with the tissue. Ten-node tetrahedra have nodes "
        "enough.\n\n| nu | reference, mm | order |",
        work_of(o), machine());
    for (const LockingCurve& c : o.curves)
        out += fmt::format(" {} |", name_of(c));
    out += "\n|---|---|---|";
    for (std::size_t i = 0; i < o.curves.size(); ++i)
        out += "---|";
    for (std::size_t k = 0; k < o.poissons.size(); ++k) {
        const Extrapolated& e = study.reference[k];
        out += fmt::format("\n| {:g} | {:.5g} | {} |", o.poissons[k], 1e3 * e.limit,
                           e.regular ? fmt::format("{:.2f}", e.order) : "none: the finest mesh");
        for (const LockingCurve& c : o.curves)
            for (const LockingRow& r : study.row)
                if (r.poisson == o.poissons[k] && r.model == c.model && r.cells == c.cells)
                    out += r.failure.empty() ? fmt::format(" {:.3f} |", r.ratio)
                                             : fmt::format(" {} |", r.failure);
    }
    return out + "\n\nThe reference's three meshes stand in locking.csv under `linear`.\n";
}

} // namespace

LockingOptions::LockingOptions() {
    bar.length_m = 0.1;
    bar.height_m = bar.width_m = 0.02;
    bar.material.young_pa = 10e3;
    bar.gravity_mps2 = 0.0;
    bar.load_n = {4e-4}; // 1 mm: what geometry adds is of the order of (1/100)^2
    bar.statics = true;
}

Extrapolated extrapolate(double coarse, double middle, double fine) {
    const double ratio = (middle - coarse) / (fine - middle);
    // (1 - 2^-p)/(2^-p - 3^-p) grows with p
    const auto ratio_at = [](double p) {
        const double half = std::pow(2.0, -p), third = std::pow(3.0, -p);
        return (1.0 - half) / (half - third);
    };
    double low = 0.2, high = 6.0;
    if (!(ratio > ratio_at(low) && ratio < ratio_at(high)))
        return {fine, 0.0, false};
    for (int i = 0; i < 60; ++i)
        (ratio_at(0.5 * (low + high)) < ratio ? low : high) = 0.5 * (low + high);
    const double third = std::pow(3.0, -low);
    return {fine + (fine - coarse) * third / (1.0 - third), low, true};
}

LockingStudy run_locking_study(const LockingOptions& o,
                               const std::function<void(const LockingRow&)>& progress) {
    for (const LockingCurve& curve : o.curves) // before anything is computed
        for (const double poisson : o.poissons)
            check(case_of(o, curve, poisson));
    LockingStudy study;
    for (const double poisson : o.poissons) {
        const std::size_t first = study.row.size();
        for (int n = 1; n <= 3; ++n)
            study.row.push_back(row_of(o, {"linear", times(o.reference_cells, n)}, poisson));
        study.reference.push_back(extrapolate(study.row[first].mean_m, study.row[first + 1].mean_m,
                                              study.row[first + 2].mean_m));
        for (const LockingCurve& curve : o.curves)
            study.row.push_back(row_of(o, curve, poisson));
        for (std::size_t i = first; i < study.row.size(); ++i) {
            study.row[i].ratio = study.row[i].mean_m / study.reference.back().limit;
            progress(study.row[i]);
        }
    }
    return study;
}

std::vector<std::pair<std::string, std::string>> locking_files(const LockingOptions& options,
                                                               const LockingStudy& study) {
    return {{"locking.csv", csv(study)},
            {"locking.svg", chart(options, study)},
            {"locking.md", page(options, study)}};
}

} // namespace sim
