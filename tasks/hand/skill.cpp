// tasks/hand/skill.cpp
// The skills of scripted hands, with where each number comes from. Called when an attempt is set
// up.
#include "tasks/hand/skill.h"

#include <stdexcept>

namespace tasks {
namespace {

// reaction   simple visual reaction, any level.
// speed      one movement differs little between levels; 95th percentile tip speed in 204 tracks of
//            a robotic suturing data set 38 / 46 / 32 mm/s, scaled by 1.45 because laparoscopic
//            tips are faster (residents 11-32 mm/s in the mean, Hagelsteen et al.).
// tremor     3-12 Hz rms at rest, the same tracks: 33 / 58 / 42 um.
// path_bow   straightness 0.96 / 0.92 / 0.96 of one movement: a parabola of height b is
//            1 + (8/3) b^2 times its chord, so b = 0.12 / 0.18 / 0.12.
// pause      0.63 / 0.53 / 0.58 s between movements with the reaction in it; novices are given
//            longer ones since they look at each step of an unfamiliar task.
// force_sd   grip force SD 1.43 N (experienced) against 3.54 N (novice), Araki et al. 2017: 1
// : 2.5. aim, depth end points spread with skill, depth more than aim: the picture is flat. stride,
// plan, lapse   levels differ in how many movements they need, in repeated and wrong ones:
//            novice / expert 1.1-1.6 in time on the robot, 3.9 in time and 3.5 in path on a box
//            trainer (9:53 against 2:33, 11.4 m against 3.3 m). No published number per target:
//            our assumption, between the two.
const HandSkill kSkills[] = {
    {"expert", 0.25, 0.055, 33e-6, 0.0010, 0.0015, 0.15, 0.01, 0.30, 0.12, 0.060, 0.3},
    {"intermediate", 0.25, 0.066, 58e-6, 0.0020, 0.0030, 0.25, 0.05, 0.35, 0.18, 0.035, 0.7},
    {"novice", 0.25, 0.046, 42e-6, 0.0030, 0.0045, 0.38, 0.15, 0.45, 0.12, 0.022, 1.0},
    // Two profiles for the review pages, beside the levels: pace and care traded for one another.
    {"fast-careless", 0.22, 0.090, 45e-6, 0.0035, 0.0050, 0.40, 0.18, 0.10, 0.12, 0.080, 0.1},
    {"slow-precise", 0.30, 0.025, 33e-6, 0.0007, 0.0010, 0.10, 0.00, 0.60, 0.08, 0.040, 0.8},
};

} // namespace

HandSkill skill_named(std::string_view name) {
    std::string known;
    for (const HandSkill& skill : kSkills) {
        if (skill.name == name)
            return skill;
        known += (known.empty() ? "" : ", ") + skill.name;
    }
    throw std::invalid_argument("hands = \"" + std::string(name) + "\": one of " + known +
                                ", or a script FILE.toml");
}

HandSkill without_errors(HandSkill skill) {
    skill.tremor_m = skill.aim_m = skill.depth_m = 0.0;
    skill.force_sd = skill.lapse = skill.path_bow = 0.0;
    return skill;
}

} // namespace tasks
