// sim/command/study.cpp
// trocar study NAME: the charts, with all their parameters on the command line.
#include "sim/command/commands.h"
#include "sim/study/coupling_study.h"
#include "sim/study/levels_study.h"
#include "sim/study/organ_study.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

struct OrganArguments {
    OrganStudyOptions organ;
    double young_kpa = 5.4;
    std::vector<double> from_mm{0.0, 0.0, 60.0}, heading{1.0, 0.0, 0.0};
    std::string out;
};

void organ(OrganArguments& a) {
    OrganStudyOptions& o = a.organ;
    o.material.young_pa = 1e3 * a.young_kpa;
    o.slide_from_mm = {a.from_mm[0], a.from_mm[1], a.from_mm[2]};
    o.slide_heading = {a.heading[0], a.heading[1], a.heading[2]};
    const OrganStudy study = run_organ_study(o);
    if (!a.out.empty())
        write_organ_study(o, study, a.out);
    std::vector<double> depth_m, force_n(o.depth_mm.size(), 0.0);
    for (std::size_t d = 0; d < o.depth_mm.size(); ++d) {
        depth_m.push_back(1e-3 * o.depth_mm[d]);
        for (const IndentPoint& p : study.point) {
            force_n[d] += p.force_n[d] / static_cast<double>(study.point.size());
        }
    }
    nlohmann::ordered_json json{{"nodes", study.nodes},
                                {"tets", study.tets},
                                {"points", study.point.size()},
                                {"seed", o.seed},
                                {"depth_m", depth_m},
                                {"force_n", force_n},
                                {"slide_step_percent", study.slide_step_percent}};
    if (!o.other.empty()) {
        json["other"] = {
            {"nodes", study.other_nodes},
            {"tets", study.other_tets},
            {"force_ratio",
             {{"min", study.ratio_min}, {"max", study.ratio_max}, {"mean", study.ratio_mean}}}};
    }
    fmt::print("{}\n", json.dump());
}

void add_organ(CLI::App& study) {
    auto a = std::make_shared<OrganArguments>();
    CLI::App* c = study.add_subcommand("organ", "Force against depth over an organ's skin");
    OrganStudyOptions& o = a->organ;
    c->add_option("organ", o.organ, "Name in the organ folder or file")->required();
    c->add_option("--against", o.other, "The same organ in another mesh: ratio place by place");
    c->add_option("--young", a->young_kpa, "Young's modulus, kPa");
    c->add_option("--poisson", o.material.poisson, "Poisson's ratio");
    c->add_option("--points", o.points, "Random places on the free skin");
    c->add_option("--seed", o.seed, "Of the places");
    c->add_option("--depths", o.depth_mm, "mm");
    c->add_option("--slide-from", a->from_mm, "Start of the slide, mm")->expected(3);
    c->add_option("--slide-heading", a->heading, "Its direction")->expected(3);
    c->add_option("--slide", o.slide_mm, "Its length, mm");
    c->add_option("--out", a->out, "Folder for the CSV");
    c->callback([a] { organ(*a); });
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
    add_organ(*c);
    add_levels(*c);
    add_failures_study(*c, exit_code);
    add_scaling_study(*c, exit_code);
    add_solid_studies(*c, exit_code);
    add_solid_charts(*c);
    add_study_contact(*c);
    add_why_study(*c);
}

} // namespace sim
