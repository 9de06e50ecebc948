// tests/tasks/attempt.h
// Observations made by hand, for the tests of exercises and scores.
#pragma once

#include "tasks/exercise/progress.h"

#include <algorithm>

namespace tasks::testing {

inline constexpr glm::dvec3 kFar{0.0, 0.0, 0.08}; // above the tissue, in the picture

/// Two targets on the plane z = 0: "a" for the right tool, "b" for the left one.
inline Exercise two_points() {
    Exercise exercise;
    exercise.target = {{"a", Role::right, {0.0, 0.0, 0.0}}, {"b", Role::left, {0.03, 0.0, 0.0}}};
    return exercise;
}

/// All tools rest above the tissue, camera looks down from z = 0.2.
inline Observation at_rest(const Exercise& exercise) {
    Observation seen;
    seen.view.eye_m = {0.0, 0.0, 0.2};
    seen.targets = static_cast<int>(exercise.target.size());
    for (int k = 0; k < seen.targets; ++k)
        seen.target[k].position_m = exercise.target[k].at_m;
    for (ToolObservation& tool : seen.tool)
        tool.tip_m = kFar;
    return seen;
}

inline void touch(Observation& seen, Role role, const glm::dvec3& place_m, double force_n) {
    ToolObservation& tool = seen.tool[static_cast<int>(role)];
    tool.touching = true;
    tool.contact_m = place_m;
    tool.tip_m = place_m + glm::dvec3{0.0, 0.0, 3e-3};
    tool.force_n = {0.0, 0.0, force_n};
}

/// The same millisecond, n times.
inline void repeat(Progress& progress, const Exercise& exercise, Observation seen, int n) {
    for (int i = 0; i < n; ++i) {
        seen.tick = progress.last_tick + 1;
        observe(progress, exercise, seen);
    }
}

inline int count(const Progress& progress, EventKind kind) {
    return static_cast<int>(std::count_if(progress.events.begin(), progress.events.end(),
                                          [&](const Event& e) { return e.kind == kind; }));
}

} // namespace tasks::testing
