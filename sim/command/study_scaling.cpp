// sim/command/study_scaling.cpp
// trocar study scaling: contact against the size of the mesh, in turn with the peers.
#include "sim/command/commands.h"
#include "sim/io/files.h"
#include "sim/study/peer_program.h"
#include "sim/study/scaling_study.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sim {
namespace {

struct ScalingArguments {
    ScalingOptions options;
    double breathe_mm = 0.0;
    std::string wave = "radial", out;
};

void say_scaling(const ScalingRow& r) {
    fmt::print(stderr,
               "{:<5} round {}  {:<24} mean {:>8.0f} ns  p99 {:>8.0f}  cold {:>8.0f}  refit "
               "{:>8.3f} ms\n",
               r.size, r.round, r.name, r.times.mean_ns, r.times.p99_ns, r.times.cold_mean_ns,
               r.times.refit_ms);
}

void scaling(ScalingArguments& a) {
    ScalingOptions& o = a.options;
    o.breathing = {1e-3 * a.breathe_mm, wave_of(a.wave)};
    o.peer_dir = peer_dir();
    const ScalingStudy study = run_scaling_study(o, say_scaling);
    std::filesystem::create_directories(a.out);
    for (const auto& [name, text] : scaling_files(o, study))
        write_text(std::filesystem::path(a.out) / name, text);
    for (const auto& [peer, why] : study.gap)
        fmt::print(stderr, "missing: {}: {}\n", peer, why);
}

} // namespace

void add_scaling_study(CLI::App& study, int&) {
    auto a = std::make_shared<ScalingArguments>();
    CLI::App* c = study.add_subcommand("scaling", "Contact against the size of the mesh, by method "
                                                  "and beside the peers");
    ScalingOptions& o = a->options;
    c->add_option("--shape", o.shape, "organ, sheet");
    c->add_option("--sizes", o.sizes, "Triangles: 1k 10k 100k 1M");
    c->add_option("--methods", o.methods, fmt::format("{}", fmt::join(o.methods, " ")));
    c->add_option("--contacts", o.contacts, "Whole ticks besides the query alone: none for none");
    c->add_option("--peers", o.peers, "embree bullet");
    c->add_option("--rounds", o.rounds, "All take turns this often");
    c->add_option("--seconds", o.seconds, "Of the path");
    c->add_option("--seed", o.seed, "Of mesh and path");
    c->add_option("--probe-radius", o.radius_m, "Of the ball, m");
    c->add_option("--reach", o.reach_m, "Initial radius of the queries, m");
    c->add_option("--breathe", a->breathe_mm, "Amplitude at 1 Hz, mm");
    c->add_option("--wave", a->wave, "radial, travelling");
    c->add_option("--cold-every", o.cold_every,
                  "Cold caches before every how manyth contact tick; "
                  "0: no cold times");
    c->add_option("--out", a->out, "Folder for CSV, chart and page")->required();
    c->callback([a] { scaling(*a); });
}

} // namespace sim
