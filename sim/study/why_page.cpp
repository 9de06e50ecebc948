// The files of trocar study why: every margin as CSV, and the page that says what they mean.
#include "sim/study/why_study.h"

#include "sim/io/files.h"
#include "sim/study/machine.h"

#include <fmt/format.h>

namespace sim {
namespace {

std::string csv_line(const std::string& motion, const std::string& organ, const std::string& cheap,
                     const std::string& dear, const TierMargin& m, const std::string& chosen) {
    return fmt::format("{},{},{},{},{},{},{},{:.4f},{:.4f},{:.4f},{},{}\n", motion, organ, cheap,
                       dear, m.steps, m.windows, m.places, m.force, m.stiffness, m.position,
                       m.enough() ? 1 : 0, chosen);
}

std::string hz(int rate) {
    return fmt::format("{} Hz", rate);
}

std::string csv_of(const WhyStudy& study) {
    std::string csv = "motion,organ,cheap,dear,steps,windows,places,force_of_gate,"
                      "stiffness_of_gate,position_of_gate,enough,chosen\n";
    for (const WhyMotion& motion : study.motion) {
        for (const OrganChoice& organ : motion.organ) {
            if (!organ.touched)
                continue;
            for (std::size_t c = 0; c < tissue::kTierNames.size(); ++c) {
                for (std::size_t d = c + 1; d < tissue::kTierNames.size(); ++d) {
                    csv += csv_line(motion.name, organ.organ, std::string(tissue::kTierNames[c]),
                                    std::string(tissue::kTierNames[d]), organ.margin[c][d],
                                    std::string(tissue::name_of(organ.tier)));
                }
            }
        }
    }
    for (const TriedRate& tried : study.rate.tried) {
        for (const RateMargin& m : tried.margin) {
            csv += csv_line(m.motion, m.organ, hz(tried.hz), hz(study.rate.asked_hz), m.margin,
                            hz(study.rate.hz));
        }
    }
    return csv;
}

std::string costs(const WhyMotion& motion) {
    std::string text = "| model | CPU ms a step, mean | p99 | worst linear residual | worst "
                       "nonlinear residual | steps inside out |\n|---|---|---|---|---|---|\n";
    for (std::size_t t = 0; t < motion.track.size(); ++t) {
        const TierTrack& track = motion.track[t];
        text += fmt::format("| {} | {:.2f} | {:.2f} | {:.1e} | {:.1e} | {} |\n",
                            tissue::kTierNames[t], track.mean_ms, track.p99_ms,
                            track.linear_residual, track.residual, track.inverted);
    }
    return text;
}

std::string margins(const OrganChoice& organ) {
    std::string text = "| cheaper | dearer | force | stiffness | position | enough |\n"
                       "|---|---|---|---|---|---|\n";
    for (std::size_t c = 0; c < tissue::kTierNames.size(); ++c) {
        for (std::size_t d = c + 1; d < tissue::kTierNames.size(); ++d) {
            const TierMargin& m = organ.margin[c][d];
            text += fmt::format("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {} |\n",
                                tissue::kTierNames[c], tissue::kTierNames[d], m.force, m.stiffness,
                                m.position, m.enough() ? "yes" : "no");
        }
    }
    return text;
}

std::string rates(const RateChoice& rate) {
    std::string text = fmt::format(
        "\n## Steps a second\n\n{}\n\nThe chosen tiers at half the rate beside {} a second, with "
        "the same gates.\n\n| motion | organ | steps a second | force | stiffness | position | "
        "enough |\n|---|---|---|---|---|---|---|\n",
        words_of(rate), rate.asked_hz);
    for (const TriedRate& tried : rate.tried) {
        for (const RateMargin& m : tried.margin) {
            text += fmt::format("| {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {} |\n", m.motion,
                                m.organ, tried.hz, m.margin.force, m.margin.stiffness,
                                m.margin.position, m.margin.enough() ? "yes" : "no");
        }
    }
    return text;
}

std::string page_of(const WhyOptions& o, const WhyStudy& study) {
    std::string page = fmt::format(
        "# Why this model\n\nScene `{}` (hash {:.16}), FEM {} Hz, seed {}, {}. Model: `{}`.\n\n"
        "The poses of the tools in each FEM step go through every tier. A tier is enough for an "
        "organ if no dearer\none differs from it by more than the gates on 99 % of the steps in "
        "which a tool touches the organ:\nforce 7 % above 0.5 N and 35 mN below, change of force "
        "over 50 ms 15 %, skin under the tip and targets 0.5 mm.\nNumbers are the 99th of 100 "
        "differences over their gate: 1 just passes. Times are told and decide nothing.\n",
        study.scene, study.scene_hash, o.fem_hz, o.seed, machine(), study.model);
    for (const WhyMotion& motion : study.motion) {
        page += fmt::format("\n## {}\n\n{} steps.\n\n{}", motion.name, motion.steps, costs(motion));
        for (const OrganChoice& organ : motion.organ) {
            page += fmt::format("\n{}\n", words_of(organ));
            if (organ.touched)
                page += "\n" + margins(organ);
        }
    }
    return study.rate.tried.empty() ? page : page + rates(study.rate);
}

} // namespace

void write_why_study(const WhyOptions& o, const WhyStudy& study, const std::filesystem::path& out) {
    std::filesystem::create_directories(out);
    write_text(out / "why.csv", csv_of(study));
    write_text(out / "why.md", page_of(o, study));
}

} // namespace sim
