// sim/command/study.cpp
// trocar study NAME: the charts, with all their parameters on the command line.
#include "sim/command/commands.h"
#include "sim/study/coupling_study.h"
#include "sim/study/levels_study.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sim {
namespace {

struct StudyArguments {
    CouplingStudyOptions coupling;
    std::vector<double> place_mm{0.0, 0.0, 40.0}, heading{1.0, 0.0, 0.0};
    std::string out;
};

void say(const CouplingRow& r) {
    fmt::print(stderr,
               "{:<10} {:>4.0f} mm/s  {:<13} {:>3} Hz  rms {:6.2f} %  worst {:6.0f} mN  "
               "step p99.9 {:5.1f} max {:4.0f} mN\n",
               r.motion, r.speed_mmps, r.coupling, r.fem_hz, r.error.rms_percent, r.error.worst_mn,
               r.error.step_p999_mn, r.error.step_max_mn);
}

void add_coupling(CLI::App& study, const std::shared_ptr<StudyArguments>& a) {
    CLI::App* c = study.add_subcommand("coupling", "Force error against FEM rate, by coupling");
    CouplingStudyOptions& o = a->coupling;
    c->add_option("--scene", o.scene, "Its first organ is used");
    c->add_option("--motions", o.motions, "touch press slide scrub release two-tools grasp-pull");
    c->add_option("--speeds", o.speeds_mmps, "mm/s");
    c->add_option("--fem-hz", o.fem_hz, "FEM rates");
    c->add_option("--couplings", o.couplings, "anchored hold");
    c->add_option("--place", a->place_mm, "Near where on the organ, mm")->expected(3);
    c->add_option("--heading", a->heading, "Where slides go")->expected(3);
    c->add_option("--depth-scale", o.depth_scale, "1: 8 mm touch, 5 mm slide");
    c->add_option("--friction", o.friction, "Coulomb coefficient instead of the scene's");
    c->add_option("--young-kpa", o.young_kpa, "Modulus instead of the scene's");
    c->add_option("--damping-ms", o.damping_stiffness_ms, "beta instead of the scene's");
    c->add_option("--late", o.late_ticks, "Answers this many ms later than one period");
    c->add_option("--jitter", o.jitter_ticks, "... plus up to this many, seeded");
    c->add_flag("!--no-halved", o.halve, "Leave out the reference at half its step");
    c->add_option("--seed", o.seed, "Of the jitter");
    c->add_option("--out", a->out, "Folder for CSV and page")->required();
    c->callback([a] {
        a->coupling.place_mm = {a->place_mm[0], a->place_mm[1], a->place_mm[2]};
        a->coupling.heading = {a->heading[0], a->heading[1], a->heading[2]};
        write_coupling_study(a->coupling, run_coupling_study(a->coupling, say), a->out);
    });
}

void add_levels(CLI::App& study) {
    auto a = std::make_shared<LevelsStudyOptions>();
    auto seeds = std::make_shared<std::vector<std::uint64_t>>();
    CLI::App* c = study.add_subcommand("levels", "Levels for an exercise file from scripted hands");
    c->add_option("exercise", a->run.exercise, "Name or file of an exercise")->required();
    c->add_option("--scene", a->run.scene, "Name, directory or file of a scene");
    c->add_option("--hands", a->run.hands, "Skill whose mean is the expert level");
    c->add_option("--seeds", *seeds, "First and last")->expected(2);
    c->add_option("--metrics", a->metrics, "Which ones");
    c->callback([a, seeds] {
        if (!seeds->empty()) {
            a->first_seed = seeds->front();
            a->last_seed = seeds->back();
        }
        fmt::print("{}", levels_text(run_levels_study(*a)));
    });
}

} // namespace

void add_study(CLI::App& app, int& exit_code) {
    auto a = std::make_shared<StudyArguments>();
    CLI::App* c = app.add_subcommand("study", "The charts: CSV and one page each");
    c->require_subcommand(1);
    add_coupling(*c, a);
    add_study_indenter(*c);
    add_study_organ(*c);
    add_levels(*c);
    add_failures_study(*c, exit_code);
    add_scaling_study(*c, exit_code);
    add_complexity_study(*c);
    add_solid_studies(*c, exit_code);
    add_solid_charts(*c);
    add_study_contact(*c);
    add_why_study(*c);
}

} // namespace sim
