// sim/command/study_organ.cpp
// trocar study organ: force against depth over an organ's skin; two meshes of one organ; beside the
// reference.
#include "sim/command/commands.h"
#include "sim/io/files.h"
#include "sim/study/organ_reference.h"
#include "sim/study/organ_study.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

namespace sim {
namespace {

struct OrganArguments {
    OrganStudyOptions organ;
    double young_kpa = 5.4;
    std::vector<double> from_mm{0.0, 0.0, 60.0}, heading{1.0, 0.0, 0.0};
    std::string out;
    bool reference = false;
    std::vector<double> toward{0.0, 0.0, 0.0};
    double hold_share = 0.3, hold_length_mm = 10.0, tip_mm = 1.5, friction = 0.1;
    std::string tier = "corotated", record;
    OrganReferenceOptions beside;
};

// From 0.5 mm to 10 mm unless depths were given.
std::vector<double> reference_depths_m(const std::vector<double>& given_mm, bool given) {
    std::vector<double> depth_m;
    for (int i = 1; !given && i <= 20; ++i)
        depth_m.push_back(0.5e-3 * i);
    for (std::size_t i = 0; given && i < given_mm.size(); ++i)
        depth_m.push_back(1e-3 * given_mm[i]);
    return depth_m;
}

HoldSide hold_of(const OrganArguments& a) {
    return {{a.toward[0], a.toward[1], a.toward[2]}, a.hold_share, 1e-3 * a.hold_length_mm};
}

void beside_reference(OrganArguments& a, bool depths_given) {
    OrganReferenceOptions& o = a.beside;
    o.organ = a.organ.organ;
    o.material = a.organ.material;
    o.material.young_pa = 1e3 * a.young_kpa;
    o.seed = a.organ.seed;
    o.places = a.organ.points;
    o.hold = hold_of(a);
    o.press.radius_m = 1e-3 * a.tip_mm;
    o.press.friction = a.friction;
    o.press.depth_m = reference_depths_m(a.organ.depth_mm, depths_given);
    const std::optional<tissue::Tier> tier = tissue::tier_named(a.tier);
    if (!tier)
        throw std::invalid_argument("--tier " + a.tier +
                                    ": want linear-compliance, corotated or quadratic");
    o.tier = *tier;
    if (!a.record.empty())
        o.record = a.record;
    else if (!a.out.empty())
        o.record = std::filesystem::path(a.out) / "reference.presses";
    const auto keep = [&](const OrganReference& study) {
        for (const auto& [name, text] : organ_reference_files(o, study)) {
            if (!a.out.empty())
                write_text(std::filesystem::path(a.out) / name, text);
        }
    };
    const OrganReference study = run_organ_reference(
        o, [](const std::string& line) { fmt::print(stderr, "{}\n", line); }, keep);
    for (const auto& [name, text] : organ_reference_files(o, study)) {
        if (name == "reference.json")
            fmt::print("{}", text);
    }
}

void organ(OrganArguments& a) {
    OrganStudyOptions& o = a.organ;
    o.material.young_pa = 1e3 * a.young_kpa;
    o.hold = hold_of(a);
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

} // namespace

void add_study_organ(CLI::App& study) {
    auto a = std::make_shared<OrganArguments>();
    CLI::App* c = study.add_subcommand("organ", "Force against depth over an organ's skin");
    OrganStudyOptions& o = a->organ;
    c->add_option("organ", o.organ, "Name in the organ folder or file")->required();
    c->add_option("--against", o.other, "The same organ in another mesh: ratio place by place");
    c->add_option("--young", a->young_kpa, "Young's modulus, kPa");
    c->add_option("--poisson", o.material.poisson, "Poisson's ratio");
    c->add_option("--points", o.points, "Random places on skin that nothing holds");
    c->add_option("--seed", o.seed, "Of the places");
    c->add_option("--depths", o.depth_mm, "mm");
    c->add_option("--slide-from", a->from_mm, "Start of the slide, mm")->expected(3);
    c->add_option("--slide-heading", a->heading, "Its direction")->expected(3);
    c->add_option("--slide", o.slide_mm, "Its length, mm");
    c->add_option("--out", a->out, "Folder for the CSV");
    c->add_flag(
        "--reference", a->reference,
        "Beside the reference solver: minutes for each place; 10 places to 10 mm unless given");
    c->add_option("--tip-radius", a->tip_mm, "Of the reference study's tip, mm: 1.5 is a 3 mm tip");
    c->add_option("--friction", a->friction, "Of its tip on the skin");
    c->add_option("--edge", a->beside.press.edge_share,
                  "Longest edge under its tip, of the radius");
    c->add_option("--core", a->beside.press.core_share,
                  "How far around it and the line below it edges are that short, of the radius");
    c->add_option("--down", a->beside.press.down_share,
                  "How long that line is, of the greatest depth");
    c->add_flag("--onto-skin,!--facets", a->beside.press.onto_skin,
                "Lay its facets around the place on the organ's skin, or leave them flat");
    c->add_option("--step", a->beside.press.step_share, "Its greatest step, of the radius");
    c->add_option("--tier", a->tier,
                  "Of the trainer's tissue beside it: linear-compliance, corotated, quadratic");
    c->add_option("--model", a->beside.model, "The organ's mesh for the trainer's tissue");
    c->add_option("--record", a->record,
                  "What the reference has pressed: goes on where it was; else in --out");
    c->add_option("--hold-toward", a->toward, "Hold the organ by a bed on this side instead")
        ->expected(3);
    c->add_option("--hold-share", a->hold_share, "Of its extent that way");
    c->add_option("--hold-length", a->hold_length_mm, "Over which motion dies out in it, mm");
    c->callback([a, c] {
        if (!a->reference) {
            organ(*a);
            return;
        }
        if (c->count("--points") == 0)
            a->organ.points = 10;
        if (!a->out.empty())
            std::filesystem::create_directories(a->out);
        beside_reference(*a, c->count("--depths") > 0);
    });
}

} // namespace sim
