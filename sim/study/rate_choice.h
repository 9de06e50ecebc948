// sim/study/rate_choice.h
// How many FEM steps a second a scene needs, once its tiers are chosen: half as many are enough if
// the same motion through the same tiers then differs from the rate asked for by no more than the
// gates of sim/study/tier_choice.h. An implicit step damps what is faster than itself: a blow needs
// more steps than a press. Called by the choice of models; no threads, and nothing of a clock
// decides anything.
#pragma once

#include "sim/study/tier_choice.h"

#include <functional>

namespace sim {

/// Fewer than that are not tried: the local model is shown to hold the budget down to here
/// (`trocar study coupling`).
inline constexpr int kLeastHz = 50;

/// One motion of a scene, as each FEM step at the rate asked for sees it.
struct PosedMotion {
    std::string name;
    Poses poses;
    std::vector<TargetWish> targets;
};

struct RateMargin {
    std::string motion, organ;
    TierMargin margin;
};

/// A rate that was tried against the one asked for.
struct TriedRate {
    int hz = 0;
    std::vector<RateMargin> margin{}; // of each organ that a tool touches, motion by motion
    double linear_residual = 0.0;     // the worst of all steps
    std::string fault{};              // of an attempt at this rate; empty: none
    bool solved() const { return linear_residual <= kMostLinearResidual; }
    bool enough() const; // every margin is, every step was solved, and no attempt has a fault
};

struct RateChoice {
    int asked_hz = 0, hz = 0;       // hz: the one to take
    std::vector<TriedRate> tried{}; // from fast to slow; the last may be one that is not enough
};

/// `cheap`, of every `stride`-th pose, against `dear` where both have one.
TierMargin rate_margin(const TierTrack& cheap, const TierTrack& dear, int body, int stride,
                       double dear_step_s);

/// What is wrong with the attempt that a motion is of, if it is made anew at so many steps a
/// second: there the tools answer to the tissue, as they do not where their poses are given. Empty:
/// nothing.
using Attempted = std::function<std::string(const PosedMotion&, int hz)>;

/// Halves `asked_hz` for as long as that is enough for all motions. `progress` (may be empty) hears
/// what is being done.
RateChoice choose_rate(const LoadedScene& scene, std::span<const PosedMotion> motions,
                       const ModelChoice& choice, int asked_hz, const Attempted& attempt,
                       void (*progress)(const std::string&));

/// In plain words, one line.
std::string words_of(const RateChoice& choice);

} // namespace sim
