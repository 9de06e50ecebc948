// See the header.
#include "sim/study/tier_choice.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace sim {
namespace {

using glm::dvec3;

// The 99th of 100 values; 0 without any.
double at_share(std::vector<double>& values) {
    if (values.empty())
        return 0.0;
    std::sort(values.begin(), values.end());
    const auto last = static_cast<double>(values.size() - 1);
    return values[static_cast<std::size_t>(std::ceil(kShareOfSteps * last))];
}

bool touches(const TierSample& s, int tool, int body) {
    return s.body[tool] == body && s.force_n[tool] != dvec3{0.0};
}

// Of two tracks, in one of which the tool touches: a tool that is over another organ feels 0 here.
dvec3 force_on(const TierSample& s, int tool, int body) {
    return s.body[tool] == body ? s.force_n[tool] : dvec3{0.0};
}

dvec3 target_m(const TierSample& s, int target) {
    const auto& um = s.target_um[static_cast<std::size_t>(target)];
    return 1e-6 * dvec3{um[0], um[1], um[2]};
}

bool is_finite(const dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

struct Differences {
    std::vector<double> force, stiffness, position;
    bool finite = true;
};

void compare_forces(const TierSample& cheap, const TierSample& dear, int tool, int body,
                    Differences& out) {
    const dvec3 f = force_on(cheap, tool, body), truth = force_on(dear, tool, body);
    out.finite = out.finite && is_finite(f) && is_finite(truth);
    const double size_n = glm::length(truth);
    const double gate_n = size_n > kSmallForce_n ? kForceGate * size_n : kSmallForceGate_n;
    out.force.push_back(glm::distance(f, truth) / gate_n);
    if (touches(cheap, tool, body) && touches(dear, tool, body))
        out.position.push_back(glm::distance(cheap.skin_m[tool], dear.skin_m[tool]) /
                               kPositionGate_m);
}

// Both tools press all the while and more or less: how much the force changes for the same motion.
void compare_stiffness(std::span<const TierSample> cheap, std::span<const TierSample> dear,
                       int tool, int body, Differences& out) {
    constexpr double kLeast_n = 0.1;
    for (std::size_t k = 0; k < cheap.size(); ++k) {
        if (!touches(cheap[k], tool, body) || !touches(dear[k], tool, body))
            return;
    }
    const double truth_n =
        glm::length(dear.back().force_n[tool]) - glm::length(dear.front().force_n[tool]);
    const double n =
        glm::length(cheap.back().force_n[tool]) - glm::length(cheap.front().force_n[tool]);
    if (std::abs(truth_n) >= kLeast_n)
        out.stiffness.push_back(std::abs(n - truth_n) / (kStiffnessGate * std::abs(truth_n)));
}

} // namespace

TierMargin tier_margin(const TierTrack& cheap, const TierTrack& dear, int body, double step_s) {
    constexpr double kWindow_s = 0.05;
    const auto window = static_cast<std::size_t>(std::max(1.0, std::round(kWindow_s / step_s)));
    Differences all;
    for (std::size_t i = 0; i < dear.step.size(); ++i) {
        bool any = false;
        for (int tool = 0; tool < kTools; ++tool) {
            if (!touches(cheap.step[i], tool, body) && !touches(dear.step[i], tool, body))
                continue;
            any = true;
            compare_forces(cheap.step[i], dear.step[i], tool, body, all);
            if (i >= window) {
                compare_stiffness(std::span(cheap.step).subspan(i - window, window + 1),
                                  std::span(dear.step).subspan(i - window, window + 1), tool, body,
                                  all);
            }
        }
        for (int t = 0; any && t < dear.targets; ++t) {
            const auto k = static_cast<std::size_t>(t);
            if (dear.target_body[k] != body || !cheap.step[i].clear[k] || !dear.step[i].clear[k])
                continue;
            const double d_m = glm::distance(target_m(cheap.step[i], t), target_m(dear.step[i], t));
            all.position.push_back(d_m / kPositionGate_m);
        }
    }
    TierMargin m{.steps = static_cast<int>(all.force.size()),
                 .windows = static_cast<int>(all.stiffness.size()),
                 .places = static_cast<int>(all.position.size()),
                 .finite = all.finite};
    m.force = at_share(all.force);
    m.stiffness = at_share(all.stiffness);
    m.position = at_share(all.position);
    return m;
}

OrganChoice choose_tier(std::span<const TierTrack> track, int body, const std::string& organ,
                        double step_s) {
    OrganChoice out{.organ = organ};
    const TierTrack& dearest = track.back();
    for (std::size_t i = 0; i < dearest.step.size(); ++i) {
        for (int tool = 0; tool < kTools; ++tool) {
            for (const TierTrack& any : track)
                out.touched |= touches(any.step[i], tool, body);
            if (!touches(dearest.step[i], tool, body))
                continue;
            out.peak_n = std::max(out.peak_n, glm::length(dearest.step[i].force_n[tool]));
            // the rigid tier's skin stays where it was
            if (touches(track.front().step[i], tool, body))
                out.deepest_m =
                    std::max(out.deepest_m, glm::distance(dearest.step[i].skin_m[tool],
                                                          track.front().step[i].skin_m[tool]));
        }
    }
    if (!out.touched)
        return out;
    out.tier = static_cast<tissue::Tier>(track.size() - 1);
    for (std::size_t cheap = track.size() - 1; cheap-- > 0;) {
        bool enough = true;
        for (std::size_t dear = cheap + 1; dear < track.size(); ++dear) {
            out.margin[cheap][dear] = tier_margin(track[cheap], track[dear], body, step_s);
            enough &= out.margin[cheap][dear].enough();
        }
        if (enough)
            out.tier = static_cast<tissue::Tier>(cheap);
    }
    return out;
}

std::string words_of(const OrganChoice& choice) {
    if (!choice.touched) {
        return fmt::format("{}: no tool touches it. It stays {}, which costs nothing at rest.",
                           choice.organ, tissue::name_of(choice.tier));
    }
    const auto chosen = static_cast<std::size_t>(choice.tier);
    std::string text = fmt::format("{}: {}. Pressed with {:.2f} N at most, its skin went {:.1f} mm "
                                   "from where it lies.",
                                   choice.organ, tissue::name_of(choice.tier), choice.peak_n,
                                   1e3 * choice.deepest_m);
    const auto differs = [&](std::size_t cheap, std::size_t dear) {
        const TierMargin& m = choice.margin[cheap][dear];
        return fmt::format("{} differs from {} by {:.2f} of the gate in force (7 % or 35 mN), "
                           "{:.2f} in stiffness (15 %), {:.2f} in position (0.5 mm)",
                           tissue::kTierNames[cheap], tissue::kTierNames[dear], m.force,
                           m.stiffness, m.position);
    };
    for (std::size_t dear = chosen + 1; dear < tissue::kTierNames.size(); ++dear)
        text += fmt::format(" It is enough: {}.", differs(chosen, dear));
    if (chosen == 0)
        return text;
    // what the next cheaper one missed, against the tier that it is farthest from
    std::size_t worst = chosen;
    for (std::size_t dear = chosen; dear < tissue::kTierNames.size(); ++dear) {
        if (choice.margin[chosen - 1][dear].worst() > choice.margin[chosen - 1][worst].worst())
            worst = dear;
    }
    return text + fmt::format(" The next cheaper one is not: {}.", differs(chosen - 1, worst));
}

} // namespace sim
