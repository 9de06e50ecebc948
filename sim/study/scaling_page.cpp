// The scaling study's CSV, chart and page; see scaling_study.h.
#include "sim/study/machine.h"
#include "sim/study/scaling_study.h"
#include "sim/study/svg_chart.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <stdexcept>

namespace sim {
namespace {

constexpr const char* kFresh = "embree";
constexpr const char* kWarm = "embree-warm";

/// "-" for what there is none of.
std::string cell(double value, const char* format) {
    return value > 0.0 ? fmt::format(fmt::runtime(format), value) : "-";
}

std::string table(const ScalingStudy& study, const std::string& size) {
    std::string out = "| | mean us | p50 us | p99 us | cold mean us | cold p50 us | cold p99 us | "
                      "refit ms | build ms | mean / Embree | p99 / Embree | cold p50 / Embree | "
                      "refit / Embree | mean / warm | p99 / warm | cold p50 / warm |\n"
                      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const std::string& name : study.names()) {
        const ScalingTimes t = median_times(study, size, name);
        if (!(t.mean_ns > 0.0))
            continue;
        const ScalingTimes f = median_ratios(study, size, name, kFresh);
        const ScalingTimes w = median_ratios(study, size, name, kWarm);
        out += "| " + name;
        for (const double ns : {t.mean_ns, t.p50_ns, t.p99_ns})
            out += " | " + cell(1e-3 * ns, "{:.3f}");
        for (const double ns : {t.cold_mean_ns, t.cold_p50_ns, t.cold_p99_ns})
            out += " | " + cell(1e-3 * ns, "{:.2f}");
        out += " | " + cell(t.refit_ms, "{:.3f}") + " | " + cell(t.build_ms, "{:.1f}");
        for (const double ratio :
             {f.mean_ns, f.p99_ns, f.cold_p50_ns, f.refit_ms, w.mean_ns, w.p99_ns, w.cold_p50_ns})
            out += " | " + cell(ratio, "{:.2f}");
        out += " |\n";
    }
    return out;
}

/// Between the last size and the one two before it: 10k to 1M by default.
std::string growth(const ScalingOptions& o, const ScalingStudy& study) {
    if (o.sizes.size() < 2)
        return "";
    const std::string& from = o.sizes[o.sizes.size() > 2 ? o.sizes.size() - 3 : 0];
    const std::string& to = o.sizes.back();
    std::string out = fmt::format("\n## Growth from {} to {}\n\n| | mean | p99 | cold p50 | refit "
                                  "|\n|---|---|---|---|---|\n",
                                  from, to);
    for (const std::string& name : study.names()) {
        const ScalingTimes a = median_times(study, from, name), b = median_times(study, to, name);
        if (a.mean_ns > 0.0 && b.mean_ns > 0.0)
            out += fmt::format(
                "| {} | {} | {} | {} | {} |\n", name, cell(b.mean_ns / a.mean_ns, "{:.2f}"),
                cell(b.p99_ns / a.p99_ns, "{:.2f}"),
                cell(a.cold_p50_ns > 0.0 ? b.cold_p50_ns / a.cold_p50_ns : 0.0, "{:.2f}"),
                cell(a.refit_ms > 0.0 ? b.refit_ms / a.refit_ms : 0.0, "{:.1f}"));
    }
    return out;
}

std::string csv(const ScalingStudy& study) {
    std::string out = "size,triangles,round,name,contact_ticks,mean_ns,p50_ns,p99_ns,cold_mean_ns,"
                      "cold_p50_ns,cold_p99_ns,refit_ms,build_ms,distance_sum_m\n";
    for (const ScalingRow& r : study.row)
        out += fmt::format(
            "{},{},{},{},{},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.5f},{:.4f},{:.9g}\n",
            r.size, r.triangles, r.round, r.name, r.contact_ticks, r.times.mean_ns, r.times.p50_ns,
            r.times.p99_ns, r.times.cold_mean_ns, r.times.cold_p50_ns, r.times.cold_p99_ns,
            r.times.refit_ms, r.times.build_ms, r.distance_sum_m);
    return out;
}

std::string chart(const ScalingOptions& o, const ScalingStudy& study) {
    std::map<std::string, double> triangles;
    for (const ScalingRow& r : study.row)
        triangles[r.size] = static_cast<double>(r.triangles);
    std::vector<ChartLine> lines;
    int colour = 0;
    for (const std::string& name : study.names()) {
        ChartLine mean{name + ", mean", colour, false, {}}, p99{name + ", p99", colour, true, {}};
        for (const std::string& size : o.sizes) {
            const ScalingTimes t = median_times(study, size, name);
            mean.point.emplace_back(triangles[size], 1e-3 * t.mean_ns);
            p99.point.emplace_back(triangles[size], 1e-3 * t.p99_ns);
        }
        lines.push_back(mean);
        lines.push_back(p99);
        ++colour;
    }
    return log_log_svg(
        {fmt::format("Contact ticks, {}, ball of {} mm, warm caches", o.shape, 1e3 * o.radius_m),
         "triangles", "microseconds"},
        lines);
}

std::string page(const ScalingOptions& o, const ScalingStudy& study) {
    std::string out = fmt::format(
        "# Contact against the size of the mesh\n\nWork: {} (seed {}), path of {} s at 1 kHz with "
        "a ball of {} mm, breathing {} mm ({}). Initial radius of every closest-point query: {} "
        "mm.\nMachine: {}. Medians of {} rounds, in which all took turns; ratios are medians of "
        "the ratios within a round.\nTimes are of contact ticks (the ball's centre within its "
        "radius of the skin, or beyond) and include {:.0f} ns of the clock; those in which another "
        "program got the processor are left out. Cold: before every "
        "{}th "
        "contact tick twice the last level of cache is written through.\nA name alone: the "
        "closest-point query; NAME+CONTACT: the whole contact tick. `embree`: every query begins "
        "with the initial radius; `embree-warm`: with the distance to the last answer's "
        "triangle.\n\n![chart](scaling.svg)\n",
        o.shape, o.seed, o.seconds, 1e3 * o.radius_m, 1e3 * o.breathing.amplitude_m,
        o.breathing.wave == Wave::radial ? "radial" : "travelling", 1e3 * o.reach_m, machine(),
        o.rounds, study.clock_overhead_ns, o.cold_every);
    for (const std::string& size : o.sizes) {
        out += fmt::format("\n## {}\n\n{}", size, table(study, size));
        out += answers_agree(study, size)
                   ? "\nAll queries found the same distances, to 1e-5.\n"
                   : "\n**The queries' distances differ by more than 1e-5: not the same work.**\n";
    }
    out += growth(o, study);
    for (const auto& [peer, why] : study.gap)
        out += fmt::format("\nMissing: {}: {}.\n", peer, why);
    return out;
}

} // namespace

std::vector<std::pair<std::string, std::string>> scaling_files(const ScalingOptions& options,
                                                               const ScalingStudy& study) {
    return {{"scaling.csv", csv(study)},
            {"scaling.svg", chart(options, study)},
            {"scaling.md", page(options, study)}};
}

} // namespace sim
