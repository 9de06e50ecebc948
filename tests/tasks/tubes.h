// tests/tasks/tubes.h
// Observations of a search for tubes, made by hand, for the tests of the exercise and its scores.
#pragma once

#include "tests/tasks/attempt.h"

namespace tasks::testing {

/// On the plane z = 0: "a" and "b" for the right tool, "c" for the assistant's; the left one lifts.
inline Exercise three_tubes() {
    Exercise exercise;
    exercise.kind = ExerciseKind::find_tubes;
    exercise.radius_m = 5e-3;
    exercise.hold_s = 1.0;
    exercise.target = {{"a", Role::right, {0.0, 0.0, 0.0}},
                       {"b", Role::right, {0.03, 0.0, 0.0}},
                       {"c", Role::assist, {-0.03, 0.0, 0.0}}};
    exercise.lift = Lift{.at_m = {0.0, -0.05, 0.0}, .to_m = {0.0, 0.05, 0.05}};
    return exercise;
}

inline constexpr double kNear_m = 0.08; // of the eye from a tube that it looks at

/// Nothing is clear, nobody points, every tool is in the picture.
inline Observation all_hidden(const Exercise& exercise) {
    Observation seen = at_rest(exercise);
    seen.view.eye_m = {0.0, 0.0, kNear_m};
    if (exercise.lift)
        seen.target[static_cast<std::size_t>(seen.targets++)].position_m = exercise.lift->at_m;
    for (ToolObservation& tool : seen.tool)
        tool.tip_m = {0.0, 0.01, 0.03};
    return seen;
}

/// Tube k clear, in the middle and large.
inline void show(Observation& seen, int k) {
    Target& mark = seen.target[static_cast<std::size_t>(k)];
    mark.clear_rays = kSightRays;
    seen.view.eye_m = mark.position_m + glm::dvec3{0.0, 0.0, kNear_m};
}

inline void point(Observation& seen, Role role, int k) {
    seen.tool[static_cast<std::size_t>(role)].tip_m =
        seen.target[static_cast<std::size_t>(k)].position_m + glm::dvec3{0.0, 0.0, 4e-3};
}

using Kinds = std::vector<EventKind>;

struct Search {
    Exercise exercise = three_tubes();
    Progress progress;

    Observation hidden() const { return all_hidden(exercise); }
    /// Tube k in the picture; `role` points at it, if it is one of a tool.
    Observation shown(int k, Role role = Role::scope) const {
        Observation seen = hidden();
        show(seen, k);
        if (role != Role::scope)
            point(seen, role, k);
        return seen;
    }
    void go(const Observation& seen, int ticks) { repeat(progress, exercise, seen, ticks); }

    /// Without contacts' begins and ends.
    Kinds kinds() const {
        Kinds out;
        for (const Event& event : progress.events) {
            if (event.kind != EventKind::contact_begin && event.kind != EventKind::contact_end)
                out.push_back(event.kind);
        }
        return out;
    }
    int count_of(EventKind kind) const { return count(progress, kind); }
};

} // namespace tasks::testing
