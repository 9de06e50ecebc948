// tasks/hand/skill.h
// How well a scripted hand does what it does: one skill vector, the same in all exercises, fitted
// to published motion data, not to scores. Called at set-up.
#pragma once

#include <string>
#include <string_view>

namespace tasks {

struct HandSkill {
    std::string name = "expert";
    double reaction_s = 0.25; // between seeing and moving; touch is felt in 0.6 of it
    double speed_mps = 0.055; // peak of one long movement
    double tremor_m = 33e-6;  // rms, 3-12 Hz
    double aim_m = 0.0010;    // sd of a movement's end point, across the line of sight
    double depth_m = 0.0015;  // sd along the line of sight
    double force_sd = 0.15;   // sd of ln(pressed force / what was wanted)
    double lapse = 0.01;      // chance per target of the wrong tool or the wrong place
    double pause_s = 0.3;     // between movements
    double path_bow = 0.12;   // sideways detour, sd as a share of the distance
    double stride_m = 0.060;  // longest way that is planned as one movement
    double plan_s = 0.3;      // to find the next target and decide, beside the reaction
};
/// expert, intermediate, novice, fast-careless, slow-precise; throws std::invalid_argument.
HandSkill skill_named(std::string_view name);
/// The same pace and habits without a single error: no noise, no lapse.
HandSkill without_errors(HandSkill skill);

} // namespace tasks
