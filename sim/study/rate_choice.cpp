// See the header.
#include "sim/study/rate_choice.h"

#include <algorithm>
#include <fmt/format.h>

namespace sim {
namespace {

Poses every(const Poses& poses, int stride) {
    Poses out;
    for (std::size_t i = 0; i < poses.size(); i += static_cast<std::size_t>(stride))
        out.push_back(poses[i]);
    return out;
}

TriedRate try_rate(const LoadedScene& scene, std::span<const PosedMotion> motions,
                   std::span<const TierTrack> asked, const ModelChoice& choice, int asked_hz,
                   int hz) {
    TriedRate tried{.hz = hz};
    const int stride = asked_hz / hz;
    for (std::size_t m = 0; m < motions.size(); ++m) {
        const TierTrack slow =
            run_tier(scene, motions[m].targets, every(motions[m].poses, stride), choice, 1.0 / hz);
        for (std::size_t b = 0; b < scene.organ.size(); ++b) {
            if (scene.organ[b]->rigid)
                continue;
            const TierMargin margin =
                rate_margin(slow, asked[m], static_cast<int>(b), stride, 1.0 / asked_hz);
            if (margin.steps > 0)
                tried.margin.push_back({motions[m].name, scene.scene.organ[b].name, margin});
        }
    }
    return tried;
}

// Of several motions and organs, the margin that decides.
const RateMargin* worst_of(const TriedRate& tried) {
    const auto worse = [](const RateMargin& a, const RateMargin& b) {
        return a.margin.finite == b.margin.finite ? a.margin.worst() < b.margin.worst()
                                                  : a.margin.finite;
    };
    const auto worst = std::max_element(tried.margin.begin(), tried.margin.end(), worse);
    return worst == tried.margin.end() ? nullptr : &*worst;
}

} // namespace

bool TriedRate::enough() const {
    return solved() && fault.empty() &&
           std::all_of(margin.begin(), margin.end(),
                       [](const RateMargin& m) { return m.margin.enough(); });
}

TierMargin rate_margin(const TierTrack& cheap, const TierTrack& dear, int body, int stride,
                       double dear_step_s) {
    TierTrack thinned{.choice = dear.choice, .targets = dear.targets};
    thinned.target_body = dear.target_body;
    for (std::size_t i = 0; i < dear.step.size(); i += static_cast<std::size_t>(stride))
        thinned.step.push_back(dear.step[i]);
    return tier_margin(cheap, thinned, body, stride * dear_step_s);
}

RateChoice choose_rate(const LoadedScene& scene, std::span<const PosedMotion> motions,
                       const ModelChoice& choice, int asked_hz, const Attempted& attempt,
                       void (*progress)(const std::string&)) {
    RateChoice out{.asked_hz = asked_hz, .hz = asked_hz};
    std::vector<TierTrack> asked;
    for (int hz = asked_hz; hz % 2 == 0 && hz / 2 >= kLeastHz && 1000 % (hz / 2) == 0;) {
        hz /= 2;
        if (progress)
            progress(fmt::format("{} steps a second beside {}", hz, asked_hz));
        if (asked.empty()) {
            for (const PosedMotion& motion : motions)
                asked.push_back(
                    run_tier(scene, motion.targets, motion.poses, choice, 1.0 / asked_hz));
        }
        out.tried.push_back(try_rate(scene, motions, asked, choice, asked_hz, hz));
        TriedRate& tried = out.tried.back();
        for (std::size_t m = 0; tried.enough() && m < motions.size(); ++m)
            tried.fault = attempt(motions[m], hz);
        if (!out.tried.back().enough())
            break;
        out.hz = hz;
    }
    return out;
}

std::string words_of(const RateChoice& choice) {
    std::string text = fmt::format("{} FEM steps a second.", choice.hz);
    for (const TriedRate& tried : choice.tried) {
        const RateMargin* worst = worst_of(tried);
        if (!tried.solved()) {
            text += fmt::format(" {} are not: a step leaves {:.0e} of its linear system unsolved, "
                                "{:.0e} is allowed.",
                                tried.hz, tried.linear_residual, kMostLinearResidual);
            continue;
        }
        if (!tried.fault.empty()) {
            text += fmt::format(" {} are not: {}.", tried.hz, tried.fault);
            continue;
        }
        if (worst == nullptr)
            continue;
        const TierMargin& m = worst->margin;
        text += fmt::format(" {} {}: {} in {} differs from {} a second by {:.2f} of the gate in "
                            "force (7 % or 35 mN), {:.2f} in stiffness (15 %), {:.2f} in position "
                            "(0.5 mm){}.",
                            tried.hz, tried.enough() ? "are enough" : "are not", worst->organ,
                            worst->motion, choice.asked_hz, m.force, m.stiffness, m.position,
                            m.finite ? "" : ", and is not finite");
    }
    return text;
}

} // namespace sim
