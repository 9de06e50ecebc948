// trocar study complexity: steps and memory against the number of nodes.
#include "sim/command/commands.h"
#include "sim/io/files.h"
#include "sim/study/complexity_study.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sim {
namespace {

std::vector<tissue::Tier> tiers_of(const std::vector<std::string>& names) {
    std::vector<tissue::Tier> tiers;
    for (const std::string& name : names) {
        const auto tier = tissue::tier_named(name);
        if (!tier || *tier == tissue::Tier::rigid)
            throw std::invalid_argument(
                fmt::format("--models {}: accepted: {}: nothing rigid steps", name,
                            fmt::join(std::span(tissue::kTierNames).subspan(1), ", ")));
        tiers.push_back(*tier);
    }
    return tiers;
}

} // namespace

void add_complexity_study(CLI::App& study) {
    struct Arguments {
        ComplexityOptions options;
        std::vector<std::string> models;
        double young_kpa = 5.4, depth_mm = 4.0;
        std::string out;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = study.add_subcommand("complexity", "Time and memory of a step against the number "
                                                     "of nodes");
    c->add_option("--models", a->models, "linear-compliance corotated quadratic");
    c->add_option("--nodes", a->options.nodes, "About so many: 500 1000 ..");
    c->add_option("--steps", a->options.steps, "Of 10 ms")->capture_default_str();
    c->add_option("--young", a->young_kpa, "Young's modulus, kPa")->capture_default_str();
    c->add_option("--poisson", a->options.poisson, "From 0, below 0.5")->capture_default_str();
    c->add_option("--depth", a->depth_mm, "Of the presses, mm")->capture_default_str();
    c->add_option("--out", a->out, "Folder for CSV, charts and page")->required();
    c->callback([a] {
        ComplexityOptions& o = a->options;
        if (!a->models.empty())
            o.tiers = tiers_of(a->models);
        o.young_pa = 1e3 * a->young_kpa;
        o.depth_m = 1e-3 * a->depth_mm;
        const auto rows = run_complexity(o, [](const ComplexityRow& r) {
            fmt::print(stderr,
                       "{:<17} {:>6} nodes  mean {:>8.3f} ms  p99 {:>8.3f}  setup {:>7.2f} s  "
                       "{:>7.1f} MB\n",
                       tissue::name_of(r.tier), r.nodes, r.times.mean_ms, r.times.p99_ms, r.setup_s,
                       r.megabytes);
        });
        std::filesystem::create_directories(a->out);
        for (const auto& [name, text] : complexity_files(o, rows))
            write_text(std::filesystem::path(a->out) / name, text);
    });
}

} // namespace sim
