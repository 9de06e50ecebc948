// sim/study/tier_track.h
// One motion of the tools through one tier of tissue: what each tool felt and where the skin went,
// FEM step by FEM step. The poses are given, so tracks of different tiers differ by the tissue
// alone. Called by the choice of models; no threads, and nothing of a clock decides anything.
#pragma once

#include "sim/session/scene.h"

#include <tuple>
#include <vector>

namespace sim {

/// The tools as each FEM step sees them, one period apart.
using Poses = std::vector<ToolsNow>;

struct TierSample {
    std::array<int, kTools> body;                   // that the tool is over; -1: none
    std::array<glm::dvec3, kTools> force_n, skin_m; // skin: the point under the tip, as drawn
    std::array<glm::dvec3, kTools> tip_m;
    TargetPlaces target_um;
    std::array<bool, std::tuple_size_v<TargetPlaces>> clear; // of the dimples of touching tips
};

struct TierTrack {
    ModelChoice choice;
    std::vector<TierSample> step{};
    int targets = 0;
    std::vector<int> target_body{};
    double linear_residual = 0.0, residual = 0.0; // the worst, see StepOutcome
    int inverted = 0;                             // steps with tissue inside out
    double mean_ms = 0.0, p99_ms = 0.0; // CPU time of a step, all threads; to be told only
};

TierTrack run_tier(const LoadedScene& scene, std::span<const TargetWish> targets,
                   const Poses& poses, const ModelChoice& choice, double step_s);

} // namespace sim
