// sim/command/study_solid.cpp
// trocar study beam | block | cook: one solid, one model, everything on the command line; one JSON
// object. Exit 1 if the model exploded or found no rest.
#include "sim/command/commands.h"
#include "sim/io/files.h"
#include "sim/study/solid_run.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace sim {
namespace {

struct SolidArguments {
    SolidCase work;
    double young_kpa = 100.0;
    std::string cells, press = "pressure", out;
    bool json = true;
};

const char* energy_of(const SolidResult& r) {
    if (r.model == "linear")
        return "linear elasticity";
    if (r.model == "corotated")
        return "corotated linear elasticity";
    if (r.model == "mass-spring")
        return "springs along the edges, Poisson's ratio 1/4";
    if (r.model == "xpbd")
        return "neo-Hooke of Macklin and Mueller 2021";
    if (r.model == "projective")
        return "distances to the nearest rotation and to the nearest shape of rest volume";
    return "neo-Hooke: mu/2 (J^-2/3 I1 - 3) + K/2 (J - 1)^2";
}

nlohmann::json number(double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::ordered_json json_of(const SolidResult& r) {
    std::vector<double> force_n, depth_m;
    // statics: one entry per load; steps: the last
    const std::size_t first = r.row.size() > 1 && r.row.back().t_s > 0.0 ? r.row.size() - 1 : 0;
    for (std::size_t i = first; i < r.row.size(); ++i) {
        force_n.push_back(r.row[i].force_n);
        depth_m.push_back(r.row[i].depth_m);
    }
    const glm::dvec3 tip = r.row.empty() ? glm::dvec3{kUnknown} : r.row.back().tip_m;
    const SolidTimes t = r.ms();
    return {{"model", r.model},
            {"element", r.element},
            {"energy", energy_of(r)},
            {"nodes", r.nodes},
            {"tets", r.tets},
            {"tip_m", {number(tip.x), number(tip.y), number(tip.z)}},
            {"force_n", force_n},
            {"depth_m", depth_m},
            {"relative_residual", number(r.own_residual())},
            {"linear_residual", number(r.worst_linear_residual())},
            {"nonlinear_residual", number(r.worst_residual())},
            {"newton_iterations", r.newton_iterations()},
            {"linear_iterations", r.linear_iterations()},
            {"substeps", r.substeps()},
            {"ms_per_step", {{"mean", t.mean}, {"p50", t.p50}, {"p99", t.p99}, {"max", t.max}}},
            {"steps", r.row.size()},
            {"settled", r.settled},
            {"failure", r.failure}};
}

void run(SolidArguments& a, int& exit_code) {
    a.work.material.young_pa = 1e3 * a.young_kpa;
    if (!a.cells.empty())
        a.work.cells = cells_of(a.cells);
    if (a.press != "pressure" && a.press != "punch")
        throw std::invalid_argument("--press " + a.press + ": accepted: pressure, punch");
    a.work.press = a.press == "punch" ? SolidPress::punch : SolidPress::pressure;
    const SolidResult result = run_solid(a.work);
    if (!a.out.empty()) {
        std::filesystem::create_directories(a.out);
        write_text(std::filesystem::path(a.out) / "trajectory.csv", solid_csv(result));
    }
    fmt::print("{}\n", json_of(result).dump());
    if (!result.failure.empty()) {
        fmt::print(stderr, "{}: {}\n", result.model, result.failure);
        exit_code = 1;
    }
}

void add_solid(CLI::App& study, const char* name, const char* what, const SolidCase& standard,
               int& exit_code) {
    auto a = std::make_shared<SolidArguments>();
    a->work = standard;
    a->young_kpa = 1e-3 * standard.material.young_pa;
    SolidCase& w = a->work;
    CLI::App* c = study.add_subcommand(name, what);
    const auto option = [&](const char* words, auto& value, const std::string& means) {
        c->add_option(words, value, means)->capture_default_str();
    };
    option("--length", w.length_m, "Along x, m");
    option("--height", w.height_m, "Along y, upwards, m");
    option("--width", w.width_m, "Along z, m");
    c->add_option("--cells", a->cells,
                  fmt::format("NXxNYxNZ, six tets a cell; without it {}", cells_name(w.cells)));
    option("--young", a->young_kpa, "Young's modulus, kPa");
    option("--poisson", w.material.poisson, "Poisson's ratio, from 0, below 0.5");
    option("--density", w.material.density_kgpm3, "kg/m3");
    option("--damping-mass", w.material.damping_mass_1ps, "alpha of C = alpha M + beta K, 1/s");
    option("--damping-stiffness", w.material.damping_stiffness_s,
           "beta, s; mass-spring, xpbd, tled and projective have none");
    option("--gravity", w.gravity_mps2, "In -y, m/s2");
    c->add_option("--load", w.load_n,
                  "N in all, evenly over the loaded face; several with --static");
    option("--model", w.model, fmt::format("{}", fmt::join(solid_models(), ", ")));
    c->add_option("--element", w.element, "p1, p2; without it the model's own (linear: p2)");
    option("--dt", w.dt_s, "Step, s");
    option("--steps", w.steps, "From the straight state; times are of all of them");
    c->add_flag("--static", w.statics, "Equilibrium instead of steps");
    if (w.shape == SolidShape::block) {
        option("--press", a->press, "pressure: dead load; punch: a glued plate");
        option("--patch", w.patch_m, "Side of the pressed square, m; 0: the whole top");
        c->add_option("--depths", w.depth_m, "Of the punch, m; several with --static");
    }
    c->add_option("--out", a->out, "Folder for trajectory.csv");
    c->add_flag("--json", a->json, "As it is without")->group("");
    c->callback([a, &exit_code] { run(*a, exit_code); });
}

} // namespace

void add_solid_studies(CLI::App& study, int& exit_code) {
    add_solid(study, "beam", "A bar clamped at x = 0 under its weight and a load in -y on its end",
              {}, exit_code);
    SolidCase block{.shape = SolidShape::block,
                    .length_m = 0.08,
                    .height_m = 0.04,
                    .width_m = 0.08,
                    .cells = {8, 4, 8},
                    .gravity_mps2 = 0.0,
                    .load_n = {1.0}};
    block.material.young_pa = 6e3;
    add_solid(study, "block", "A block clamped at y = 0 and pressed in -y from above", block,
              exit_code);
    SolidCase cook{.shape = SolidShape::membrane,
                   .length_m = 0.048,
                   .height_m = 0.044,
                   .width_m = 0.010,
                   .cells = {8, 8, 2},
                   .gravity_mps2 = 0.0,
                   .load_n = {0.01}};
    cook.material.young_pa = 1e3;
    cook.material.poisson = 1.0 / 3.0;
    add_solid(
        study, "cook",
        "Cook's membrane, clamped at x = 0, sheared in +y; the standard is E = 1, F = 10 with "
        "lengths in mm",
        cook, exit_code);
}

} // namespace sim
