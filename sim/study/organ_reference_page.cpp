// CSV, picture, page and summary of the organ study beside the reference; see organ_reference.h.
#include "sim/study/machine.h"
#include "sim/study/organ_reference.h"
#include "sim/study/svg_parts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace sim {
namespace {

constexpr Gates kGates;
constexpr double kPanel = 230.0, kLeft = 62.0, kTop = 92.0, kGapX = 62.0, kGapY = 62.0;
constexpr int kColumns = 4;
constexpr const char* kOurs = "#d55e00"; // apart for the colour-blind (Okabe, Ito 2008)
constexpr const char* kReference = "#0072b2";

std::string what(const OrganReferenceOptions& o, const OrganReference& study) {
    const std::string mesh =
        o.model.empty() ? "" : " on " + std::filesystem::path(o.model).filename().string();
    return fmt::format("{}{} ({}, {} nodes, {} tets), E {} kPa, nu {}, tip radius {} mm, friction "
                       "{}, places seed {}",
                       std::filesystem::path(o.organ).stem().string(), mesh,
                       tissue::name_of(o.tier), study.nodes, study.tets, 1e-3 * o.material.young_pa,
                       o.material.poisson, 1e3 * o.press.radius_m, o.press.friction, o.seed);
}

std::string csv(const OrganReferenceOptions& o, const OrganReference& study) {
    std::string out =
        "place,x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,depth_mm,force_n,reference_n,error_n,"
        "error_percent,stiffness_npm,reference_stiffness_npm,stiffness_error_percent,"
        "direction_deg,a1,a2,a3,reference_nodes\n";
    for (const ReferenceRow& r : study.row) {
        const TrainerPress& p = study.place[static_cast<std::size_t>(r.place)];
        out += fmt::format("{},{:.3f},{:.3f},{:.3f},{:.4f},{:.4f},{:.4f},{:g},{:.6f},", r.place,
                           1e3 * p.place_m.x, 1e3 * p.place_m.y, 1e3 * p.place_m.z, p.normal.x,
                           p.normal.y, p.normal.z, 1e3 * r.depth_m, r.force_n);
        if (r.solved) {
            out += fmt::format("{:.6f},{:.6f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:d},{:d},{:d},",
                               r.reference_n, r.error_n, r.error_percent, r.stiffness_npm,
                               r.reference_npm, r.stiffness_percent, r.direction_deg, r.a1, r.a2,
                               r.a3);
        } else {
            out += fmt::format(",,,{:.2f},,,,,,,", r.stiffness_npm);
        }
        out += fmt::format("{}\n", study.reference[static_cast<std::size_t>(r.place)].nodes);
    }
    return out + fmt::format("# {}\n", what(o, study));
}

// ---- picture: a panel per place

struct Panel {
    double x, y, depth_m, force_n; // upper left corner; scales
    std::string at(double d, double f) const {
        return fmt::format("{:.1f},{:.1f} ", x + kPanel * d / depth_m,
                           y + kPanel * (1.0 - std::clamp(f / force_n, 0.0, 1.0)));
    }
};

// 1, 2 or 5 of a decade, about a quarter of the whole.
double tick(double whole) {
    const double decade = std::pow(10.0, std::floor(std::log10(0.25 * whole)));
    for (const double digit : {1.0, 2.0, 5.0}) {
        if (digit * decade > 0.16 * whole)
            return digit * decade;
    }
    return 10.0 * decade;
}

std::string axes(const Panel& p) {
    std::string out =
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
                    "fill=\"none\" stroke=\"#888888\"/>\n",
                    p.x, p.y, kPanel, kPanel);
    for (double d = 0.0; d < 1.001 * p.depth_m; d += tick(p.depth_m))
        out += svg_text(p.x + kPanel * d / p.depth_m, p.y + kPanel + 16, "middle",
                        fmt::format("{:g}", 1e3 * d));
    for (double f = 0.0; f < 1.001 * p.force_n; f += tick(p.force_n))
        out += svg_text(p.x - 5, p.y + kPanel * (1 - f / p.force_n) + 4, "end",
                        fmt::format("{:g}", std::round(1e6 * f) / 1e3));
    return out;
}

std::string panel_svg(const OrganReferenceOptions& o, const OrganReference& study, int place,
                      const Panel& p) {
    const std::size_t depths = o.press.depth_m.size();
    std::string ours = p.at(0, 0), reference = p.at(0, 0), band = p.at(0, 0), below;
    double last_m = 0.0;
    for (std::size_t d = 0; d < depths; ++d) {
        const ReferenceRow& r = study.row[static_cast<std::size_t>(place) * depths + d];
        ours += p.at(r.depth_m, r.force_n);
        if (!r.solved)
            continue;
        const double slack = r.reference_n > kGates.full_force_n
                                 ? 0.01 * kGates.force_percent * r.reference_n
                                 : kGates.small_force_n;
        reference += p.at(r.depth_m, r.reference_n);
        band += p.at(r.depth_m, r.reference_n + slack);
        below = p.at(r.depth_m, r.reference_n - slack) + below;
        last_m = r.depth_m;
    }
    std::string out = fmt::format("<polygon points=\"{}{}\" fill=\"{}\" fill-opacity=\"0.15\"/>\n",
                                  band, below, kReference);
    out += axes(p);
    out += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n",
                       reference, kReference);
    out += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" "
                       "stroke-dasharray=\"6 4\"/>\n",
                       ours, kOurs);
    out += svg_text(p.x + 6, p.y + 17, "start", fmt::format("place {}", place + 1));
    if (last_m < o.press.depth_m.back()) {
        out +=
            svg_text(p.x + 6, p.y + 33, "start",
                     fmt::format("no equilibrium beyond {:.1f} mm",
                                 1e3 * study.reference[static_cast<std::size_t>(place)].reached_m),
                     "fill=\"#a50026\"");
    }
    return out;
}

std::string picture(const OrganReferenceOptions& o, const OrganReference& study) {
    double most_n = 0.0;
    for (const ReferenceRow& r : study.row)
        most_n =
            std::max({most_n, r.force_n, r.solved ? r.reference_n + kGates.small_force_n : 0.0});
    const int places = static_cast<int>(study.place.size());
    const int lines = (places + kColumns - 1) / kColumns;
    const double width = kLeft + kColumns * (kPanel + kGapX);
    std::string out = svg_sheet(width, kTop + lines * (kPanel + kGapY) + 20, 12);
    out += svg_text(kLeft, 26, "start", what(o, study), "font-size=\"15\"");
    out += fmt::format("<line x1=\"{0}\" y1=\"46\" x2=\"{1}\" y2=\"46\" stroke=\"{2}\" "
                       "stroke-width=\"2\"/>\n<line x1=\"{0}\" y1=\"66\" x2=\"{1}\" y2=\"66\" "
                       "stroke=\"{3}\" stroke-width=\"2\" stroke-dasharray=\"6 4\"/>\n",
                       kLeft, kLeft + 34, kReference, kOurs);
    out += svg_text(kLeft + 42, 50, "start",
                    "reference: quadratic tetrahedra, neo-Hooke, refined under the tip; band: A1");
    out += svg_text(kLeft + 42, 70, "start", "the trainer's step. Force in mN against depth in mm");
    for (int i = 0; i < places; ++i) {
        out +=
            panel_svg(o, study, i,
                      {kLeft + (i % kColumns) * (kPanel + kGapX),
                       kTop + (i / kColumns) * (kPanel + kGapY), o.press.depth_m.back(), most_n});
    }
    return out + "</svg>\n";
}

nlohmann::ordered_json json_of(const OrganReferenceOptions& o, const OrganReference& study) {
    const ReferenceSummary s = summary_of(o, study);
    double cpu_s = 0.0;
    int nodes = 0;
    for (const ReferencePress& r : study.reference) {
        cpu_s += r.cpu_s;
        nodes = std::max(nodes, r.nodes);
    }
    return {{"what", what(o, study)},
            {"machine", machine()},
            {"places", study.place.size()},
            {"rows", s.rows},
            {"rows_with_reference", s.solved},
            {"inside", {{"a1", s.a1}, {"a2", s.a2}, {"a3", s.a3}}},
            {"places_not_settled", std::count_if(study.place.begin(), study.place.end(),
                                                 [](const TrainerPress& p) { return !p.settled; })},
            {"places_to_the_end", s.places_to_the_end},
            {"places_to_the_end_and_inside", s.places_inside},
            {"least_reached_mm", 1e3 * s.least_reached_m},
            {"worst",
             {{"force_mn", 1e3 * s.worst_n},
              {"force_percent", s.worst_percent},
              {"stiffness_percent", s.worst_stiffness_percent},
              {"direction_deg", s.worst_deg}}},
            {"reference", {{"most_nodes", nodes}, {"cpu_s", cpu_s}}},
            {"three_tips",
             {{"steps", o.tips.steps},
              {"most_depth_mm", 1e3 * o.tips.depth_m},
              {"mean_ms", study.times.mean_ms},
              {"p50_ms", study.times.p50_ms},
              {"p99_ms", study.times.p99_ms},
              {"max_ms", study.times.max_ms},
              {"linear_residual", study.times.linear_residual}}}};
}

std::string page(const OrganReferenceOptions& o, const OrganReference& study) {
    const ReferenceSummary s = summary_of(o, study);
    std::string out = fmt::format(
        "# What a tip feels on an organ, beside the reference\n\n{}.\nMachine: {}.\nReference: "
        "ten-node tetrahedra {}, longest edge {} of the tip's radius within {} of a line to {} of "
        "the depth below it, "
        "neo-Hooke, Coulomb friction, steps of at most {} of the radius.\nGates: force within {} % "
        "above "
        "{} N and {} mN below, stiffness between neighbouring depths within {} %, direction "
        "within {} degrees.\n\n![force against depth](reference.svg)\n\n| place | reached mm | "
        "worst force mN | worst % | worst stiffness % | worst degrees | inside A1, A2, A3 of "
        "depths |\n|---|---|---|---|---|---|---|\n",
        what(o, study), machine(),
        o.press.onto_skin ? "laid on the organ's skin around the place" : "of flat facets",
        o.press.edge_share, o.press.core_share, o.press.down_share, o.press.step_share,
        kGates.force_percent, kGates.full_force_n, 1e3 * kGates.small_force_n,
        kGates.stiffness_percent, kGates.direction_deg);
    const std::size_t depths = o.press.depth_m.size();
    for (std::size_t i = 0; i < study.place.size(); ++i) {
        OrganReference one{study.nodes,          study.tets, {study.place[i]},
                           {study.reference[i]}, {},         study.times};
        one.row.assign(study.row.begin() + static_cast<std::ptrdiff_t>(i * depths),
                       study.row.begin() + static_cast<std::ptrdiff_t>((i + 1) * depths));
        const ReferenceSummary p = summary_of(o, one);
        out +=
            fmt::format("| {} | {:.2f} | {:.0f} | {:.0f} | {:.0f} | {:.1f} | {}, {}, {} of {} "
                        "|\n",
                        i + 1, 1e3 * study.reference[i].reached_m, 1e3 * p.worst_n, p.worst_percent,
                        p.worst_stiffness_percent, p.worst_deg, p.a1, p.a2, p.a3, p.solved);
    }
    for (std::size_t i = 0; i < study.place.size(); ++i) {
        if (!study.reference[i].stopped.empty())
            out += fmt::format("\nPlace {}: the reference stopped {}.\n", i + 1,
                               study.reference[i].stopped);
        if (!study.place[i].settled)
            out += fmt::format("\nPlace {}: the trainer's force still changed at some depth when "
                               "it was read.\n",
                               i + 1);
        if (study.place[i].warped)
            out += fmt::format("\nPlace {}: some step of the trainer fell back to another tangent "
                               "than the exact one.\n",
                               i + 1);
    }
    out += fmt::format(
        "\nSteps of 10 ms with the local models of three tips that press to {} mm and slide at 31 "
        "mm/s, {} of them, CPU of all threads: mean {:.2f} ms, median {:.2f}, p99 {:.2f}, longest "
        "{:.2f}.\n",
        1e3 * o.tips.depth_m, o.tips.steps, study.times.mean_ms, study.times.p50_ms,
        study.times.p99_ms, study.times.max_ms);
    if (s.solved < s.rows) {
        out += fmt::format("\n**Gap: the reference found no equilibrium at {} of {} depths; {} of "
                           "{} places went to the end.**\n",
                           s.rows - s.solved, s.rows, s.places_to_the_end, study.place.size());
    }
    return out;
}

} // namespace

std::vector<std::pair<std::string, std::string>>
organ_reference_files(const OrganReferenceOptions& options, const OrganReference& study) {
    return {{"reference.csv", csv(options, study)},
            {"reference.svg", picture(options, study)},
            {"reference.md", page(options, study)},
            {"reference.json", json_of(options, study).dump(1) + "\n"}};
}

} // namespace sim
