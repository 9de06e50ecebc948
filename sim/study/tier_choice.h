// sim/study/tier_choice.h
// The cheapest tier that is accurate enough, organ by organ, from tracks of one motion through all
// tiers. A tier is enough if no dearer one says otherwise on 99 % of the steps in which a tool
// touches the organ:
//   force      7 % of the dearer tier's above 0.5 N, 35 mN below
//   stiffness  15 %: of the change of force over 50 ms, where the dearer tier's is 0.1 N or more
//   position   0.5 mm: the skin under the tip, and the organ's targets that no tip is near
// (the error budget A1, A2, A6). Comparing with the next tier only would keep a tier that locks as
// much as the next one does. Never a name, a list or a clock decides. Pure.
#pragma once

#include "sim/study/tier_track.h"

namespace sim {

inline constexpr double kForceGate = 0.07, kSmallForceGate_n = 0.035, kSmallForce_n = 0.5;
inline constexpr double kStiffnessGate = 0.15, kPositionGate_m = 0.5e-3;
inline constexpr double kShareOfSteps = 0.99;

/// Differences on the 99th of 100 steps, over their gates: at most 1 is enough.
struct TierMargin {
    double force = 0.0, stiffness = 0.0, position = 0.0;
    int steps = 0, windows = 0, places = 0; // that were compared
    bool finite = true;
    double worst() const { return std::max({force, stiffness, position}); }
    bool enough() const { return finite && worst() <= 1.0; }
};

/// `cheap` against `dear` on organ `body`.
TierMargin tier_margin(const TierTrack& cheap, const TierTrack& dear, int body, double step_s);

struct OrganChoice {
    std::string organ;
    bool touched = false;
    double peak_n = 0.0, deepest_m = 0.0; // of the dearest tier: force; and how far a target or the
                                          // skin under a tip went
    tissue::Tier tier = kUsualTier;
    // of each tier against each dearer one: margin[cheap][dear]
    std::array<std::array<TierMargin, tissue::kTierNames.size()>, tissue::kTierNames.size()>
        margin{};
};

/// `track`: one per tier, cheapest first, of the same poses. Untouched organs keep the usual tier:
/// at rest it costs nothing.
OrganChoice choose_tier(std::span<const TierTrack> track, int body, const std::string& organ,
                        double step_s);

/// In plain words, one paragraph.
std::string words_of(const OrganChoice& choice);

} // namespace sim
