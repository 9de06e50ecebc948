// tasks/exercise/exercise.h
// An exercise as its file says it: what has to be done, where, by which role, how gently. Every
// kind of exercise is places in the tissue in an order, each for one role; what counts as done
// there is the kind's own (touch_points.h, follow_path.h). Tool index = role index.
// Called by sim, live and headless, and by every re-score.
#pragma once

#include "tasks/exercise/level.h"
#include "tasks/exercise/observation.h"

#include <string>
#include <vector>

namespace tasks {

enum class ExerciseKind : std::uint8_t {
    touch_points, // touch each place, gently and long enough
    follow_path,  // draw along the curve through the places, in contact
};

struct ExerciseTarget {
    std::string id;
    Role role = Role::right;
    glm::dvec3 at_m{0.0}; // rest place near the surface; the scene snaps it on
    std::string organ{};  // whose surface; empty: the nearest
};

struct Exercise { // from assets/exercises/*.toml
    ExerciseKind kind = ExerciseKind::touch_points;
    std::string id = "touch-points";
    std::string title, card; // for people: name and instructions
    std::vector<ExerciseTarget> target;
    double radius_m = 3e-3; // how near a tip has to be: to a point, to the path
    double force_min_n = 0.1;
    double force_max_n = 1.0;
    double hold_s = 0.3;            // touch_points: how long
    double force_limit_n = 2.0;     // an error above
    double time_limit_s = 180.0;    // the attempt ends incomplete
    std::vector<MetricLevel> level; // at most one per metric
};

/// Bytes of an exercise file. Throws BadInput with file, line, key, value and what would be
/// accepted; unknown keys are errors. `file` is only for messages. Not real-time safe.
Exercise parse_exercise(std::string_view text, std::string_view file);

/// Name of the tables that say where: [[target]] or [[point]].
const char* table_of_targets(ExerciseKind kind) noexcept;

/// A path shorter than this, from point to point, is refused.
inline constexpr double kShortestPath_m = 0.12;

} // namespace tasks
