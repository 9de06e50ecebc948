// sim/study/why_study.h
// trocar study why SCENE: which tier each organ of a scene needs on the scene's own motions, and
// why. `--model auto` asks the same and takes the answer. Called by commands.
#pragma once

#include "sim/session/session.h"
#include "sim/study/rate_choice.h"

#include <filesystem>

namespace sim {

struct WhyOptions {
    std::string scene = "basic";       // name, directory or file
    std::vector<std::string> exercise; // whose expert moves the tools; empty: all of the scene's
    std::vector<std::string> motion;   // of sim/study/motions.h, instead of an exercise
    std::string organ;                 // that motions are made on; empty: the first that is soft
    std::optional<glm::dvec3> place_m; // near where; none: nearest to where the scene looks
    glm::dvec3 heading{1.0, 0.0, 0.0};
    double speed_mps = 0.05, depth_scale = 1.0;
    // instead of the scene's, of all organs; below 0: the scene's
    double poisson = -1.0, young_pa = -1.0;
    int fem_hz = 100;
    bool choose_rate = false; // fewer steps a second, where they are enough
    std::uint64_t seed = 1;   // of the expert
    double max_seconds = 0.0;
};

struct WhyMotion {
    std::string name;
    int steps = 0;
    std::vector<TierTrack> track{}; // one per tier, cheapest first; their steps are let go of
    std::vector<OrganChoice> organ{};
};

struct WhyStudy {
    std::string scene, scene_hash;
    std::vector<std::string> organ{};
    std::vector<WhyMotion> motion{};
    ModelChoice choice{}; // per organ the dearest that a motion needs
    std::string model{};  // as --model takes it
    RateChoice rate{};    // the rate asked for, unless choose_rate
};

/// `progress` (may be empty) hears what is being done, for a person who waits.
WhyStudy run_why_study(const WhyOptions& options, void (*progress)(const std::string&));

/// why.csv, why.md. Throws if they cannot be written.
void write_why_study(const WhyOptions& options, const WhyStudy& study,
                     const std::filesystem::path& out);

/// A line or two per organ that a tool touches, for a terminal and the logbook.
std::string why_words(const WhyStudy& study);

} // namespace sim
