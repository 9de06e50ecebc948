// sim/command/study_why.cpp
// trocar study why SCENE: which model each organ needs, and what the next cheaper one would miss.
#include "sim/command/commands.h"
#include "sim/study/motions.h"
#include "sim/study/why_study.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace sim {
namespace {

struct WhyArguments {
    WhyOptions options;
    double young_kpa = -1.0, speed_mmps = 50.0;
    std::vector<double> place_mm, heading{1.0, 0.0, 0.0};
    std::string out;
    bool json = false;
};

void add_margin(const TierMargin& m, nlohmann::ordered_json& to) {
    to["force"] = m.force;
    to["stiffness"] = m.stiffness;
    to["position"] = m.position;
    to["enough"] = m.enough();
}

nlohmann::ordered_json json_of(const WhyStudy& study) {
    nlohmann::ordered_json json{
        {"scene", study.scene}, {"model", study.model}, {"fem_hz", study.rate.hz}};
    if (!study.rate.tried.empty())
        json["rate_why"] = words_of(study.rate);
    for (const TriedRate& tried : study.rate.tried) {
        for (const RateMargin& m : tried.margin) {
            nlohmann::ordered_json rate{{"hz", tried.hz}, {"motion", m.motion}, {"organ", m.organ}};
            add_margin(m.margin, rate);
            json["rates"].push_back(rate);
        }
    }
    for (const WhyMotion& motion : study.motion) {
        nlohmann::ordered_json one{{"motion", motion.name}, {"steps", motion.steps}};
        for (std::size_t t = 0; t < motion.track.size(); ++t)
            one["ms_per_step"][std::string(tissue::kTierNames[t])] = {
                {"mean", motion.track[t].mean_ms}, {"p99", motion.track[t].p99_ms}};
        for (const OrganChoice& organ : motion.organ) {
            if (!organ.touched)
                continue;
            nlohmann::ordered_json o{{"organ", organ.organ},
                                     {"model", tissue::name_of(organ.tier)},
                                     {"peak_n", organ.peak_n},
                                     {"why", words_of(organ)}};
            for (std::size_t c = 0; c < tissue::kTierNames.size(); ++c) {
                for (std::size_t d = c + 1; d < tissue::kTierNames.size(); ++d) {
                    nlohmann::ordered_json pair{{"cheap", tissue::kTierNames[c]},
                                                {"dear", tissue::kTierNames[d]}};
                    add_margin(organ.margin[c][d], pair);
                    o["margins"].push_back(pair);
                }
            }
            one["organs"].push_back(o);
        }
        json["motions"].push_back(one);
    }
    return json;
}

void why(WhyArguments& a) {
    WhyOptions& o = a.options;
    o.young_pa = a.young_kpa > 0.0 ? 1e3 * a.young_kpa : -1.0;
    o.speed_mps = 1e-3 * a.speed_mmps;
    o.heading = {a.heading[0], a.heading[1], a.heading[2]};
    if (!a.place_mm.empty())
        o.place_m = 1e-3 * glm::dvec3{a.place_mm[0], a.place_mm[1], a.place_mm[2]};
    const WhyStudy study =
        run_why_study(o, [](const std::string& doing) { fmt::print(stderr, "{}\n", doing); });
    if (!a.out.empty())
        write_why_study(o, study, a.out);
    if (a.json)
        fmt::print("{}\n", json_of(study).dump());
    else
        fmt::print("{}", why_words(study));
}

} // namespace

void add_why_study(CLI::App& study) {
    auto a = std::make_shared<WhyArguments>();
    CLI::App* c = study.add_subcommand("why", "Which model each organ of a scene needs, and why");
    WhyOptions& o = a->options;
    c->add_option("scene", o.scene, "Name, directory or file of a scene")->required();
    c->add_option("--exercise", o.exercise, "Whose expert moves the tools; default: the scene's");
    c->add_option("--motion", o.motion,
                  fmt::format("Instead: {} on one organ", fmt::join(kMotionNames, " ")));
    c->add_option("--organ", o.organ, "That motions are made on; default: the first soft one");
    c->add_option("--place", a->place_mm, "Near where on it, mm; default: where the scene looks")
        ->expected(3);
    c->add_option("--heading", a->heading, "Where slides go")->expected(3);
    c->add_option("--speed", a->speed_mmps, "Of motions, mm/s");
    c->add_option("--depth-scale", o.depth_scale, "Of motions: 1 is an 8 mm touch, a 5 mm slide");
    c->add_option("--poisson", o.poisson, "Poisson's ratio of all organs instead of the scene's");
    c->add_option("--young-kpa", a->young_kpa, "Modulus of all organs instead of the scene's");
    c->add_option("--fem-hz", o.fem_hz,
                  "FEM steps a second; divides 1000. Default: 100, or fewer where they are enough");
    c->add_option("--seed", o.seed, "Of the expert");
    c->add_option("--max-seconds", o.max_seconds, "Of the expert's attempt");
    c->add_option("--out", a->out, "Folder for CSV and page");
    c->add_flag("--json", a->json, "One JSON object instead of words");
    c->callback([a, c] {
        a->options.choose_rate = c->count("--fem-hz") == 0;
        why(*a);
    });
}

} // namespace sim
