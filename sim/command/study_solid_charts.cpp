// sim/command/study_solid_charts.cpp
// trocar study locking | large | tradeoff: tissue models on the same solids, charted.
#include "sim/command/commands.h"
#include "sim/io/files.h"
#include "sim/study/large_study.h"
#include "sim/study/locking_study.h"
#include "sim/study/peer_program.h"
#include "sim/study/tradeoff_study.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sim {
namespace {

void write(const std::string& out, const std::vector<std::pair<std::string, std::string>>& files) {
    std::filesystem::create_directories(out);
    for (const auto& [name, text] : files)
        write_text(std::filesystem::path(out) / name, text);
}

// "MODEL:NXxNYxNZ".
std::pair<std::string, std::array<int, 3>> model_and_cells(const std::string& option,
                                                           const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos)
        throw std::invalid_argument(fmt::format(
            "--{} {}: accepted: MODEL:NXxNYxNZ, such as corotated:10x2x2", option, text));
    return {text.substr(0, colon), cells_of(text.substr(colon + 1))};
}

// Of the bar that all are about.
void add_bar(CLI::App& c, SolidCase& bar, double& young_kpa) {
    young_kpa = 1e-3 * bar.material.young_pa;
    c.add_option("--length", bar.length_m, "Along x, m")->capture_default_str();
    c.add_option("--height", bar.height_m, "Along y, m")->capture_default_str();
    c.add_option("--width", bar.width_m, "Along z, m")->capture_default_str();
    c.add_option("--young", young_kpa, "Young's modulus, kPa")->capture_default_str();
}

void add_locking(CLI::App& study) {
    struct Arguments {
        LockingOptions options;
        double young_kpa = 0.0;
        std::vector<std::string> curves;
        std::string reference_cells, out;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = study.add_subcommand("locking", "Deflection of a bar against Poisson's ratio");
    LockingOptions& o = a->options;
    add_bar(*c, o.bar, a->young_kpa);
    c->add_option("--load", o.bar.load_n, "N on the end; keep the deflection small")->expected(1);
    c->add_option("--poisson", o.poissons, "0.3 0.35 ..");
    c->add_option("--curves", a->curves, "MODEL:NXxNYxNZ ..: corotated:10x2x2 quadratic:10x2x2");
    c->add_option("--reference-cells", a->reference_cells,
                  "Of the coarsest of its three meshes; without it 10x2x2");
    c->add_option("--out", a->out, "Folder for CSV, chart and page")->required();
    c->callback([a] {
        LockingOptions& options = a->options;
        options.bar.material.young_pa = 1e3 * a->young_kpa;
        if (!a->reference_cells.empty())
            options.reference_cells = cells_of(a->reference_cells);
        if (!a->curves.empty())
            options.curves.clear();
        for (const std::string& text : a->curves) {
            const auto [model, cells] = model_and_cells("curves", text);
            options.curves.push_back({model, cells});
        }
        const LockingStudy done = run_locking_study(options, [](const LockingRow& r) {
            fmt::print(stderr, "nu {:<6g} {:<10} {:<8} {:>8.4f} mm  {:.4f} {}\n", r.poisson,
                       r.model, cells_name(r.cells), 1e3 * r.mean_m, r.ratio, r.failure);
        });
        write(a->out, locking_files(options, done));
    });
}

void add_large(CLI::App& study) {
    struct Arguments {
        LargeOptions options;
        double young_kpa = 0.0;
        std::string cells, out;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = study.add_subcommand("large", "A slender bar's large bending, beside the "
                                                "elastica");
    LargeOptions& o = a->options;
    add_bar(*c, o.bar, a->young_kpa);
    c->add_option("--poisson", o.bar.material.poisson, "The theory knows none: 0");
    c->add_option("--cells", a->cells, "NXxNYxNZ; without it " + cells_name(o.bar.cells));
    c->add_option("--alphas", o.alphas, "P L^2/(E I), above 0");
    c->add_option("--models", o.models, "linear corotated quadratic reference ..");
    c->add_option("--out", a->out, "Folder for CSV, charts and page")->required();
    c->callback([a] {
        LargeOptions& options = a->options;
        options.bar.material.young_pa = 1e3 * a->young_kpa;
        if (!a->cells.empty())
            options.bar.cells = cells_of(a->cells);
        const auto rows = run_large_study(options, [](const LargeRow& r) {
            fmt::print(stderr,
                       "{:<10} alpha {:<5g} w/L {:.5f} ({:+.2f} %)  u/L {:.5f} ({:+.2f} %) "
                       "{}\n",
                       r.model, r.alpha, r.deflection, 1e2 * r.deflection_error, r.shortening,
                       1e2 * r.shortening_error, r.failure);
        });
        write(a->out, large_files(options, rows));
    });
}

void tradeoff(TradeoffOptions& o, const std::string& out) {
    const auto say = [](const std::string& line) { fmt::print(stderr, "{}\n", line); };
    const TradeoffStudy done = run_tradeoff_study(o, say);
    write(out, tradeoff_files(o, done));
    for (const auto& [peer, why] : done.gap)
        fmt::print(stderr, "missing: {}: {}\n", peer, why);
}

void add_tradeoff(CLI::App& study) {
    struct Arguments {
        TradeoffOptions options;
        double young_kpa = 0.0;
        std::vector<std::string> works, peer_cells;
        std::string reference_cells, out;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = study.add_subcommand("tradeoff", "Error of a falling beam against time per step, "
                                                   "every model and mesh, beside the peers");
    TradeoffOptions& o = a->options;
    add_bar(*c, o.beam, a->young_kpa);
    c->add_option("--poisson", o.beam.material.poisson, "From 0, below 0.5")->capture_default_str();
    c->add_option("--density", o.beam.material.density_kgpm3, "kg/m3")->capture_default_str();
    c->add_option("--gravity", o.beam.gravity_mps2, "In -y, m/s2")->capture_default_str();
    c->add_option("--dt", o.beam.dt_s, "Step, s")->capture_default_str();
    c->add_option("--steps", o.beam.steps, "Timed, from the straight state")->capture_default_str();
    c->add_option("--works", a->works,
                  "MODEL:NXxNYxNZ ..; without it every model on four meshes and more");
    c->add_option("--reference-cells", a->reference_cells,
                  "Of the coarsest of its meshes; without it 10x2x2");
    c->add_option("--rounds", o.rounds, "The quickest counts")->capture_default_str();
    c->add_option("--peers", o.peers, "Programs PEER_peer: mujoco; none for none");
    c->add_option("--peer-cells", a->peer_cells, "NXxNYxNZ ..");
    c->add_option("--out", a->out, "Folder for CSV, charts and page")->required();
    c->callback([a] {
        TradeoffOptions& options = a->options;
        options.beam.material.young_pa = 1e3 * a->young_kpa;
        options.peer_dir = peer_dir();
        if (options.peers == std::vector<std::string>{"none"})
            options.peers.clear();
        if (!a->reference_cells.empty())
            options.reference_cells = cells_of(a->reference_cells);
        if (!a->works.empty())
            options.works.clear();
        for (const std::string& text : a->works) {
            const auto [model, cells] = model_and_cells("works", text);
            options.works.push_back({model, cells});
        }
        if (!a->peer_cells.empty())
            options.peer_cells.clear();
        for (const std::string& text : a->peer_cells)
            options.peer_cells.push_back(cells_of(text));
        tradeoff(options, a->out);
    });
}

} // namespace

void add_solid_charts(CLI::App& study) {
    add_locking(study);
    add_large(study);
    add_tradeoff(study);
}

} // namespace sim
