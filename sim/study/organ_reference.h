// sim/study/organ_reference.h
// trocar study organ --reference: what a tip of the trainer feels at places of an organ, by its own
// steps, beside what the reference solver says, against the gates for accuracy:
//   A1 force within 7 % above 0.5 N, 35 mN below
//   A2 stiffness, between neighbouring depths, within 15 %
//   A3 direction within 10 degrees
// Where the reference finds no equilibrium there is a gap, counted apart from what is inside.
#pragma once

#include "sim/study/hold_side.h"
#include "sim/study/reference_press.h"
#include "sim/study/three_tips.h"
#include "sim/study/trainer_press.h"

#include <filesystem>

namespace sim {

struct OrganReferenceOptions {
    std::string organ; // name in the organ folder, or file
    tissue::Material material;
    HoldSide hold;
    int places = 10;
    std::uint64_t seed = 1;
    tissue::Tier tier = tissue::Tier::corotated; // of ours
    std::string model;                           // the organ's mesh for ours; empty: the same
    std::filesystem::path record{};              // of the reference's presses; empty: none
    bool only_recorded = false;                  // presses nothing that the record lacks
    ReferencePressOptions press{.depth_m = {}};
    ThreeTipsOptions tips{.steps = 300}; // what a step costs
};

struct Gates {
    double force_percent = 7.0, full_force_n = 0.5, small_force_n = 0.035;
    double stiffness_percent = 15.0, direction_deg = 10.0;
};

/// One place and depth. Errors are ours against the reference's.
struct ReferenceRow {
    int place = 0;
    double depth_m = 0.0;
    double force_n = 0.0, reference_n = 0.0; // lengths
    double error_n = 0.0, error_percent = 0.0;
    double stiffness_npm = 0.0, reference_npm = 0.0,
           stiffness_percent = 0.0; // since the last depth
    double direction_deg = 0.0;     // between the two forces
    bool solved = false;            // by the reference; else its columns mean nothing
    bool a1 = false, a2 = false, a3 = false;
};

struct OrganReference {
    int nodes = 0, tets = 0;
    std::vector<TrainerPress> place{};
    std::vector<ReferencePress> reference{};
    std::vector<ReferenceRow> row{}; // place by place, depths ascending
    StepTimes times{};               // of three tips at places of its own
};

/// Places are on free skin (indent.h) of the corotated tier's mesh of `organ`, whatever ours is.
/// `say` gets a line for each place. Throws as make_body() and press_reference() do. `keep` (may be
/// empty) gets the study after each place. With only_recorded, a place that the record lacks is
/// std::invalid_argument.
OrganReference run_organ_reference(const OrganReferenceOptions& options,
                                   const std::function<void(const std::string&)>& say,
                                   const std::function<void(const OrganReference&)>& keep = {});

/// Over the rows that were solved.
struct ReferenceSummary {
    int rows = 0, solved = 0, a1 = 0, a2 = 0, a3 = 0, places_inside = 0, places_to_the_end = 0;
    double worst_n = 0.0, worst_percent = 0.0, worst_stiffness_percent = 0.0, worst_deg = 0.0;
    double least_reached_m = 0.0;
};
ReferenceSummary summary_of(const OrganReferenceOptions& options, const OrganReference& study);

/// reference.csv, reference.svg, reference.md, reference.json: names and texts.
std::vector<std::pair<std::string, std::string>>
organ_reference_files(const OrganReferenceOptions& options, const OrganReference& study);

} // namespace sim
