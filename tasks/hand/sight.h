// tasks/hand/sight.h
// What a scripted hand is told in every millisecond, and what it answers. Between sim and hands.
#pragma once

#include "tasks/exercise/exercise.h"

#include <optional>

namespace tasks {

/// What the hand's owner perceives in this tick.
struct HandSight {
    std::int64_t tick = 0;
    Observation now;
    int next_target = 0;
    std::uint32_t found = 0; // find-tubes: bit k, tube k
    bool done = false;
    // In somebody else's hands: the hand that is told follows them, so that what it gets back goes
    // on from where it is.
    std::array<bool, kTools> held{};
    bool scope_held = false;
};

/// How the endoscope is to be held; sim turns it into a place of its handle.
struct ScopeGoal {
    bool given = false; // false: this hand does not hold it
    glm::dvec3 look_at_m{0.0};
    double distance_m = 0.0;  // of the eye from there
    double horizon_rad = 0.0; // turn of the picture against a level one
    // An oblique optic sees a place from a circle of places: the one nearest to here; none: to
    // where the scene starts.
    std::optional<glm::dvec3> near_m{};
};

struct HandGoals {
    std::array<glm::dvec3, kTools> tip_m{};
    std::array<double, kTools> jaw{};
    ScopeGoal scope{};
};

} // namespace tasks
