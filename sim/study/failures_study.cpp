#include "sim/study/failures_study.h"

#include "sim/io/files.h"
#include "sim/study/failure_bench.h"
#include "sim/study/failures_chart.h"
#include "sim/study/machine.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

namespace sim {
namespace {

/// One group of scenes: with a method, or of itself.
struct Group {
    std::string_view scene, about;
    void (*with_method)(const ContactMethod&, std::uint64_t, failure::Rows&) = nullptr;
    void (*alone)(std::uint64_t, failure::Rows&) = nullptr;
};

// To add scenes, add a line; what measures rows in its own way converts them to FailureRow.
constexpr std::array kGroups{
    Group{"F1", "a plate of 2 mm is pushed through", failure::plate},
    Group{"F2", "inside a box, across the bisector of an edge", failure::voronoi},
    Group{"F3", "a crack of 1 um; a vertex of 8 triangles", failure::cracks},
    Group{"F4", "a surface that jumps at 50 Hz", failure::moving},
    Group{"F5", "concave corners", failure::concave, failure::projections},
    Group{"F6", "a ridge of 20 degrees", failure::wedge, failure::stale_plane},
    Group{"F7", "friction", failure::friction, failure::signum_friction},
    Group{"F8", "a membrane of 0.5 mm is crossed", failure::membrane},
    Group{"F9", "inverted tetrahedra", nullptr, failure::inverted_tets},
    Group{"F10", "near nu = 1/2 a bar stiffens", nullptr, failure::locking},
    Group{"F11", "explicit steps that are too long", nullptr, failure::explicit_steps},
    Group{"F12", "a taut string moved to the side", nullptr, failure::taut_strings},
    Group{"F13", "stiffness by iterations", nullptr, failure::stiffness_by_iterations},
    Group{"F14", "a body turned as a whole", nullptr, failure::rigid_turns},
    Group{"F16", "a flat face by many points", nullptr, failure::rigid_clusters},
    Group{"F17", "deep in thin and concave things", nullptr, failure::rigid_depths},
    Group{"F18", "a flap between two instruments", failure::pinched_sheet, failure::pinched_flap},
};

void check(const FailureOptions& options) {
    std::string known;
    for (const Group& group : kGroups)
        known += fmt::format("{}{}", known.empty() ? "" : ", ", group.scene);
    for (const std::string& name : options.scenes)
        if (std::none_of(kGroups.begin(), kGroups.end(),
                         [&](const Group& g) { return g.scene == name; }))
            throw std::invalid_argument(
                fmt::format("failure scene \"{}\": it is one of {}", name, known));
}

std::string_view behaviour(const FailureRow& row) {
    if (!row.passed)
        return "UNEXPECTED";
    return row.wrong_expected ? "fails as known" : "right";
}

} // namespace

std::vector<FailureRow> run_failures_study(const FailureOptions& options) {
    check(options);
    failure::Rows rows;
    for (const Group& group : kGroups) {
        if (!options.scenes.empty() && std::find(options.scenes.begin(), options.scenes.end(),
                                                 group.scene) == options.scenes.end())
            continue;
        if (group.with_method)
            for (const ContactMethod& method : kContactMethods)
                group.with_method(method, options.seed, rows);
        if (group.alone)
            group.alone(options.seed, rows);
    }
    return rows.row;
}

std::string failures_table(const std::vector<FailureRow>& rows) {
    std::string text;
    for (const FailureRow& r : rows)
        text += fmt::format("{:<4} {:<24} {:<48} {:>11.4g} {} {:<11.4g} {:<14} {:+.2g}\n", r.scene,
                            r.method, r.quantity, r.measured, r.near ? "~ " : "<=", r.bound,
                            behaviour(r), r.margin);
    return text;
}

void write_failures_study(const FailureOptions& options, const std::vector<FailureRow>& rows,
                          const std::filesystem::path& out) {
    std::filesystem::create_directories(out);
    std::string csv = "scene,method,quantity,measured,bound,near,tolerance,wrong_expected,passed,"
                      "margin\n";
    const std::array caption{
        std::string("Gate: the bound that theory gives for a right method, in the unit of the "
                    "check. Each check with its value: failures.md, failures.csv."),
        std::string("Reference: closed forms of each scene (sim/study/failure_*.cpp); independent "
                    "programs on the same bodies (F10, F11, F13); brute force for depths (F17); "
                    "the tissue stepped in every tick for couplings (F18)."),
        fmt::format("Seed {}. Machine: {}; no time is measured.", options.seed, machine())};
    std::string page = fmt::format(
        "# Failure scenes\n\nMethods of contact and of tissue in scenes where they are known to "
        "fail. "
        "\"fails as known\": the published weakness shows where theory says, \"right\": it "
        "stays within the bound. ~: theory's value, within the tolerance.\n\n{}\n\n"
        "![Every method in every scene](failures.svg)\n",
        fmt::join(caption, "\n"));
    std::string scene;
    for (const FailureRow& r : rows) {
        csv += fmt::format("{},{},\"{}\",{:.9g},{:.9g},{},{:.4g},{},{},{:.4g}\n", r.scene, r.method,
                           r.quantity, r.measured, r.bound, int{r.near}, r.tolerance,
                           int{r.wrong_expected}, int{r.passed}, r.margin);
        if (r.scene != scene) {
            scene = r.scene;
            const auto group = std::find_if(kGroups.begin(), kGroups.end(),
                                            [&](const Group& g) { return g.scene == scene; });
            page += fmt::format("\n## {}: {}\n\n| method | quantity | measured | bound | behaviour "
                                "| margin |\n|---|---|---|---|---|---|\n",
                                scene, group->about);
        }
        page +=
            fmt::format("| {} | {} | {:.4g} | {} {:.4g} | {} | {:+.2g} |\n", r.method, r.quantity,
                        r.measured, r.near ? "~" : "<=", r.bound, behaviour(r), r.margin);
    }
    write_text(out / "failures.csv", csv);
    write_text(out / "failures.md", page);
    std::vector<FailureScene> scenes;
    for (const Group& group : kGroups)
        scenes.push_back({group.scene, group.about});
    write_text(out / "failures.svg", failures_svg(scenes, rows, caption));
}

} // namespace sim
