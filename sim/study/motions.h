// sim/study/motions.h
// Prescribed tool motions on an organ, as functions of time only, for open-loop comparisons: the
// same motion goes through every coupling, FEM rate and reference. Paths follow the rest skin.
#pragma once

#include "sim/bridge/body.h"
#include "sim/exchange.h"

#include <string>

namespace sim {

/// Tip centres by tick, 1 ms apart; tools that do not take part stay far away.
struct Motion {
    std::string name;
    double speed_mps = 0.0;
    int tools = 1;
    std::vector<std::array<glm::dvec3, kTools>> tip_m;
    std::int64_t jaw_closes = -1, jaw_opens = -1; // ticks, of the first tool; -1: stays open
};

inline constexpr std::array<const char*, 7> kMotionNames{
    "touch", "press", "slide", "scrub", "release", "two-tools", "grasp-pull"};

/// `name`: one of kMotionNames. `place_m`: near where on the organ; `heading`: roughly where
/// slides go; a grasp-pull holds what the jaws of a scene's tools hold at most. Depths are scaled
/// by `depth_scale` (1: 8 mm touch, 5 mm slide). Throws std::invalid_argument for another name.
Motion make_motion(const std::string& name, double speed_mps, const Body& organ,
                   const glm::dvec3& place_m, const glm::dvec3& heading, double tip_radius_m,
                   double depth_scale = 1.0);

} // namespace sim
