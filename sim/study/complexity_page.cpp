// The complexity study's CSV, charts and page; see complexity_study.h.
#include "sim/study/complexity_study.h"
#include "sim/study/machine.h"
#include "sim/study/xy_chart.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

namespace sim {
namespace {

std::string csv(const std::vector<ComplexityRow>& rows) {
    std::string out = "model,nodes,tets,mean_ms,p50_ms,p99_ms,max_ms,resting_ms,setup_s,megabytes,"
                      "linear_residual,residual,force_n\n";
    for (const ComplexityRow& r : rows)
        out +=
            fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.3g},{:.3g},"
                        "{:.6g}\n",
                        tissue::name_of(r.tier), r.nodes, r.tets, r.times.mean_ms, r.times.p50_ms,
                        r.times.p99_ms, r.times.max_ms, r.times.resting_ms, r.setup_s, r.megabytes,
                        r.times.linear_residual, r.times.residual, r.times.force_n);
    return out;
}

using Figure = double (*)(const ComplexityRow&);
constexpr Figure mean_ms = [](const ComplexityRow&r) { return r.times.mean_ms; },
                 p99_ms = [](const ComplexityRow&r) { return r.times.p99_ms; },
                 setup_s = [](const ComplexityRow&r) { return r.setup_s; },
                 megabytes = [](const ComplexityRow&r) { return r.megabytes; };

std::vector<std::pair<double, double>> points(const std::vector<ComplexityRow>& rows,
                                              tissue::Tier tier, Figure figure) {
    std::vector<std::pair<double, double>> out;
    for (const ComplexityRow& r : rows)
        if (r.tier == tier)
            out.emplace_back(static_cast<double>(r.nodes), figure(r));
    return out;
}

std::string named(tissue::Tier tier, const std::vector<std::pair<double, double>>& points,
                  const char* what) {
    return fmt::format("{}, {}: n^{:.2f}", tissue::name_of(tier), what, growth(points).exponent);
}

std::vector<std::string> notes(const ComplexityOptions& o) {
    return {
        fmt::format("Block 80 x 80 x 40 mm, E {:g} kPa, nu {:g}, three tips of 1.5 mm to {:g} mm, "
                    "{} steps of 10 ms",
                    1e-3 * o.young_pa, o.poisson, 1e3 * o.depth_m, o.steps),
        "Mesh of a fixed seed. " + machine()};
}

// From below the least to above the most of what is drawn.
XyAxis axis_around(const std::string& title, const std::vector<XySeries>& series, bool x) {
    XyAxis axis{.title = title, .low = 1e300, .high = 0.0, .logarithmic = true};
    constexpr double kMargin = 1.3;
    for (const XySeries& line : series) {
        for (const auto& [nodes, value] : line.point) {
            axis.low = std::min(axis.low, (x ? nodes : value) / kMargin);
            axis.high = std::max(axis.high, (x ? nodes : value) * kMargin);
        }
    }
    return axis;
}

std::string chart(const ComplexityOptions& o, const std::string& title, const std::string& unit,
                  std::vector<XySeries> series) {
    const XyAxis x = axis_around("nodes", series, true), y = axis_around(unit, series, false);
    return xy_svg({.title = title, .notes = notes(o), .x = x, .y = y, .series = std::move(series)});
}

std::string time_chart(const ComplexityOptions& o, const std::vector<ComplexityRow>& rows) {
    std::vector<XySeries> lines;
    for (std::size_t k = 0; k < o.tiers.size(); ++k) {
        const auto mean = points(rows, o.tiers[k], mean_ms),
                   tail = points(rows, o.tiers[k], p99_ms);
        const int colour = static_cast<int>(k) + 1;
        lines.push_back({.name = named(o.tiers[k], mean, "mean"), .colour = colour, .point = mean});
        lines.push_back({.name = named(o.tiers[k], tail, "p99"),
                         .colour = colour,
                         .mark = XyMark::ring,
                         .dashed = true,
                         .point = tail});
    }
    return chart(o, "A whole FEM step with three tools pressing and sliding",
                 "CPU of all threads, ms a step", std::move(lines));
}

std::string memory_chart(const ComplexityOptions& o, const std::vector<ComplexityRow>& rows) {
    std::vector<XySeries> lines;
    for (std::size_t k = 0; k < o.tiers.size(); ++k) {
        const auto held = points(rows, o.tiers[k], megabytes);
        lines.push_back({.name = named(o.tiers[k], held, "heap"),
                         .colour = static_cast<int>(k) + 1,
                         .point = held});
    }
    return chart(o, "What a body and all that its steps need hold", "megabytes", std::move(lines));
}

std::string table(const ComplexityOptions& o, const std::vector<ComplexityRow>& rows) {
    std::string out;
    for (const tissue::Tier tier : o.tiers) {
        out +=
            fmt::format("\n## {}\n\n| nodes | tets | mean ms | p50 | p99 | max | at rest | setup "
                        "s | MB | linear residual | residual | largest force N |\n"
                        "|---|---|---|---|---|---|---|---|---|---|---|---|\n",
                        tissue::name_of(tier));
        for (const ComplexityRow& r : rows) {
            if (r.tier != tier)
                continue;
            out += fmt::format("| {} | {} | {:.3g} | {:.3g} | {:.3g} | {:.3g} | {:.2g} | {:.3g} | "
                               "{:.3g} | {:.1e} | {:.1e} | {:.3f} |\n",
                               r.nodes, r.tets, r.times.mean_ms, r.times.p50_ms, r.times.p99_ms,
                               r.times.max_ms, r.times.resting_ms, r.setup_s, r.megabytes,
                               r.times.linear_residual, r.times.residual, r.times.force_n);
        }
        out += "\nExponents over this range:";
        for (const auto& [what, figure, end] :
             {std::tuple{"mean", mean_ms, ","}, std::tuple{"p99", p99_ms, ","},
              std::tuple{"setup", setup_s, ","}, std::tuple{"memory", megabytes, ".\n"}}) {
            const Growth g = growth(points(rows, tier, figure));
            out += fmt::format(" {} {:.2f} ({:.3g} at 1000 nodes){}", what, g.exponent, g.at_1000,
                               end);
        }
    }
    return out;
}

std::string page(const ComplexityOptions& o, const std::vector<ComplexityRow>& rows) {
    return fmt::format(
               "# A step against the number of nodes\n\nWork: a block of 80 x 80 x 40 mm, regular "
               "cells of six tets moved at random by a tenth, clamped below, E {:g} kPa, nu {:g}; "
               "three tips of 1.5 mm press down to {:g} mm and up again in turn, round circles of "
               "5 "
               "mm, in {} steps of 10 ms. A skin of 1681 vertices, at every size the same. Nothing "
               "is drawn at random but the mesh, whose seed is fixed.\nTime: CPU of all threads, a "
               "whole step: contact, motion, factors made anew, local models. Memory: heap, of the "
               "body and all that its steps need, the mesh itself not.\nMachine: {}.\n\n"
               "![time](complexity.svg)\n\n![memory](complexity_memory.svg)\n",
               1e-3 * o.young_pa, o.poisson, 1e3 * o.depth_m, o.steps, machine()) +
           table(o, rows);
}

} // namespace

std::vector<std::pair<std::string, std::string>>
complexity_files(const ComplexityOptions& options, const std::vector<ComplexityRow>& rows) {
    return {{"complexity.csv", csv(rows)},
            {"complexity.svg", time_chart(options, rows)},
            {"complexity_memory.svg", memory_chart(options, rows)},
            {"complexity.md", page(options, rows)}};
}

} // namespace sim
