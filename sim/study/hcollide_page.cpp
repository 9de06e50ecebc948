// What trocar study contact writes: see hcollide_study.h.
#include "sim/io/files.h"
#include "sim/study/bar_chart.h"
#include "sim/study/hcollide_study.h"
#include "sim/study/machine.h"

#include <algorithm>
#include <fmt/format.h>

namespace sim {
namespace {

std::string name_of(const HcollideRow& r) {
    return r.method + (r.witness ? " + witness" : "");
}

double per_query(std::uint64_t count, const HcollideRow& r) {
    return r.all.count ? static_cast<double>(count) / static_cast<double>(r.all.count) : 0.0;
}

std::string csv_of(const HcollideStudy& study) {
    std::string csv = "mesh,deforming,method,witness";
    for (const std::string_view kind : kQueryKinds) {
        std::string k(kind);
        std::replace(k.begin(), k.end(), ' ', '_');
        csv += fmt::format(",{0}_count,{0}_mean_us,{0}_worst_us", k);
    }
    csv += ",query_mean_us,query_worst_us,refit_mean_us,refit_worst_us,boxes_per_query,"
           "triangles_per_query,cells_per_query,different_answers\n";
    for (const HcollideRow& r : study.row) {
        csv += fmt::format("{},{},{},{}", r.mesh, int{r.deforming}, r.method, int{r.witness});
        for (const QueryCost& c : r.kind)
            csv += fmt::format(",{},{:.3f},{:.3f}", c.count, c.mean_us(), c.worst_us);
        csv += fmt::format(",{:.3f},{:.3f},{:.1f},{:.1f},{:.2f},{:.2f},{:.2f},{}\n",
                           r.all.mean_us(), r.all.worst_us, r.refit.mean_us(), r.refit.worst_us,
                           per_query(r.counts.boxes, r), per_query(r.counts.triangles, r),
                           per_query(r.counts.cells, r), r.different);
    }
    return csv;
}

std::string table_of(const HcollideStudy& study, bool deforming) {
    std::string page = "| mesh | method |";
    for (const std::string_view kind : kQueryKinds)
        page += fmt::format(" {} |", kind);
    page += fmt::format(" average query |{} boxes / triangles / cells |\n|---|---|---|---|---|---|"
                        "---|{}---|\n",
                        deforming ? " refit, ms |" : "", deforming ? "---|" : "");
    for (const HcollideRow& r : study.row) {
        if (r.deforming != deforming)
            continue;
        page += fmt::format("| {} | {} |", r.mesh, name_of(r));
        for (const QueryCost& c : r.kind)
            page += fmt::format(" {:.2f} / {:.2f} |", c.mean_us(), c.worst_us);
        page += fmt::format(" **{:.2f}** / {:.2f} |", r.all.mean_us(), r.all.worst_us);
        if (deforming)
            page += fmt::format(" {:.2f} |", 1e-3 * r.refit.mean_us());
        page += fmt::format(" {:.1f} / {:.1f} / {:.1f} |\n", per_query(r.counts.boxes, r),
                            per_query(r.counts.triangles, r), per_query(r.counts.cells, r));
    }
    return page;
}

const HcollideRow* find(const HcollideStudy& study, const HcollideRow& like,
                        const std::string& method) {
    for (const HcollideRow& r : study.row)
        if (r.mesh == like.mesh && r.deforming == like.deforming && r.witness == like.witness &&
            r.method == method)
            return &r;
    return nullptr;
}

/// Is the hybrid at least as good as both of what it is made of?
std::string finding_of(const HcollideStudy& study) {
    std::string page;
    int good = 0, all = 0;
    for (const HcollideRow& r : study.row) {
        const HcollideRow *grid = find(study, r, "hash-grid"), *tree = find(study, r, "obb-tree");
        if (r.method != "hybrid" || r.deforming || r.witness || !grid || !tree)
            continue;
        const double best_us = std::min(grid->all.mean_us(), tree->all.mean_us());
        const bool is = r.all.mean_us() <= best_us;
        good += is;
        ++all;
        const auto work = [](const HcollideRow& of) {
            return fmt::format("{:.2f} us, worst {:.1f} ({:.1f} boxes, {:.1f} triangles, {:.1f} "
                               "cells)",
                               of.all.mean_us(), of.all.worst_us, per_query(of.counts.boxes, of),
                               per_query(of.counts.triangles, of), per_query(of.counts.cells, of));
        };
        page += fmt::format("- {}: hybrid {}; hash grid {}; OBB tree {}. {}\n", r.mesh, work(r),
                            work(*grid), work(*tree),
                            is ? "At least as good as both."
                               : fmt::format("{:.0f} % behind the better one.",
                                             100.0 * (r.all.mean_us() / best_us - 1.0)));
    }
    return fmt::format(
        "At rest, without a witness, the hybrid's average query is at least as good "
        "as both alone on {} of {}:\n\n{}\n"
        "What the counts do not say: a box of the grid is six comparisons, one after "
        "the other in memory; a box of a tree is a turn of the segment into its "
        "axes, and a jump. So fewer boxes may take longer on average, where cells "
        "hold few triangles; where one holds many, the grid looks at all of them, and "
        "its worst query shows it.\n",
        good, all, page);
}

/// What the witness changes, method by method.
std::string witness_of(const HcollideStudy& study) {
    std::string page = "| mesh | method | average query, with / without | triangles | boxes |\n"
                       "|---|---|---|---|---|\n";
    for (const HcollideRow& r : study.row) {
        HcollideRow like = r;
        like.witness = false;
        const HcollideRow* without = find(study, like, r.method);
        if (!r.witness || r.deforming || !without)
            continue;
        page += fmt::format(
            "| {} | {} | {:.2f} | {:.1f} instead of {:.1f} | {:.1f} instead of "
            "{:.1f} |\n",
            r.mesh, r.method, r.all.mean_us() / without->all.mean_us(),
            per_query(r.counts.triangles, r), per_query(without->counts.triangles, *without),
            per_query(r.counts.boxes, r), per_query(without->counts.boxes, *without));
    }
    return page;
}

void write_charts(const HcollideStudy& study, const std::filesystem::path& out) {
    for (const bool deforming : {false, true}) {
        std::vector<std::string> series;
        std::vector<BarGroup> groups;
        for (const HcollideRow& r : study.row) {
            if (r.deforming != deforming)
                continue;
            if (groups.empty() || groups.back().name != r.mesh)
                groups.push_back({r.mesh, {}});
            groups.back().value.push_back(r.all.mean_us());
            if (groups.size() == 1)
                series.push_back(name_of(r));
        }
        write_text(out / (deforming ? "contact_deforming.svg" : "contact_rest.svg"),
                   bar_chart_svg(deforming ? "Average query, deforming" : "Average query, at rest",
                                 "microseconds", series, groups));
    }
}

} // namespace

void write_hcollide_study(const HcollideOptions& o, const HcollideStudy& study,
                          const std::filesystem::path& out) {
    std::filesystem::create_directories(out);
    std::uint64_t different = 0;
    for (const HcollideRow& r : study.row)
        different += r.different;
    const std::string page = fmt::format(
        "# Collision methods in the table of H-Collide\n\n"
        "After Gregory, Lin, Gottschalk, Taylor 1999, A Framework for Fast and Accurate Collision "
        "Detection for Haptic Interaction, on **stand-ins** made by recipe for their models: a "
        "height field of 12 000 triangles (nano-surface), an assembly of 18 000 with slivers (Ford "
        "Bronco), a thin wing with two sides of 79 000 (butterfly). Their averages, ms on a 400 "
        "MHz "
        "Pentium II: hash grid 0.022, 0.027, 0.030; hybrid 0.016, 0.014, 0.016; OBB tree 0.039, "
        "0.028, 0.016.\n\n"
        "Cells: average / worst, microseconds; average query: over all. Work: per query, counted "
        "in a separate pass (`ours` does not count its boxes). Collision: a segment from proxy to "
        "tip. Intersection: the nearest contact of a sphere of 1 mm. {} ticks of 1 ms, the same "
        "path for all, seed {}; methods take turns in blocks of 50 ticks; a query's time is the "
        "least of {} rounds and includes reading the clock, {:.3f} us. Deforming: the mesh waves "
        "by 1 mm and is refitted between blocks.\n\n"
        "{} of all answers differ from the first method's.\n\nMachine: {}.\n\n"
        "## At rest\n\n{}\n![at rest](contact_rest.svg)\n\n## Deforming\n\n{}\n"
        "![deforming](contact_deforming.svg)\n\n## Is the hybrid worth it?\n\n{}\n## Is the "
        "witness?\n\nIt is measured before the "
        "method is asked; triangles are those the method came up with. At rest:\n\n{}",
        o.queries, o.seed, o.rounds, study.clock_us, different, machine(), table_of(study, false),
        table_of(study, true), finding_of(study), witness_of(study));
    write_text(out / "contact.csv", csv_of(study));
    write_text(out / "contact.md", page);
    write_charts(study, out);
}

} // namespace sim
