// tasks/exercise/exercise.h
// An exercise as its file says it: what has to be done, where, by which role, how gently. Every
// kind of exercise is places in the tissue in an order, each for one role; what counts as done
// there is the kind's own (touch_points.h, follow_path.h, find_tubes.h). Tool index = role index.
// Called by sim, live and headless, and by every re-score.
#pragma once

#include "tasks/exercise/level.h"
#include "tasks/exercise/observation.h"

#include <optional>
#include <string>
#include <vector>

namespace tasks {

enum class ExerciseKind : std::uint8_t {
    touch_points, // touch each place, gently and long enough
    follow_path,  // draw along the curve through the places, in contact
    find_tubes,   // lift what hides them, get each into the picture and point at it; any order
};

struct ExerciseTarget {
    std::string id;
    Role role = Role::right;
    glm::dvec3 at_m{0.0}; // rest place near the surface; the scene snaps it on
    std::string organ{};  // whose surface; empty: the nearest
};

/// Who holds the endoscope where no person does.
enum class ScopeHold : std::uint8_t { mount, assistant };

/// find_tubes: the flap, or the edge of an organ, that has to be out of the way.
struct Lift {
    Role role = Role::left;
    glm::dvec3 at_m{0.0};    // rest place to take hold of, near a surface
    std::string organ{};     // whose; empty: the nearest
    glm::dvec3 to_m{0.0};    // where that place is brought to, by hands and assistants
    double radius_m = 0.015; // of the place: contact so near is meant
};

struct Exercise { // from assets/exercises/*.toml
    ExerciseKind kind = ExerciseKind::touch_points;
    std::string id = "touch-points";
    std::string title, card; // for people: name and instructions
    std::vector<ExerciseTarget> target;
    double radius_m = 3e-3; // how near a tip has to be: to a point, to the path
    double force_min_n = 0.1;
    double force_max_n = 1.0;
    double hold_s = 0.3;         // touch_points, find_tubes: how long
    double force_limit_n = 2.0;  // an error above
    double time_limit_s = 180.0; // the attempt ends incomplete
    ScopeHold scope = ScopeHold::mount;
    // find_tubes: a tube counts as seen when its mark is clear, so near the middle of the picture
    // and so large, both as shares of the picture's height
    std::optional<Lift> lift;
    double centre_share = 0.15;
    double least_share = 0.04;
    double mark_radius_m = 3e-3;
    double point_within_s = 10.0;   // seen for so long and not pointed at: an error
    std::vector<MetricLevel> level; // at most one per metric
};

/// Bytes of an exercise file. Throws BadInput with file, line, key, value and what would be
/// accepted; unknown keys are errors. `file` is only for messages. Not real-time safe.
Exercise parse_exercise(std::string_view text, std::string_view file);

/// Places of an exercise in the tissue: its targets, then the place to lift if there is one.
std::size_t places_of(const Exercise& exercise) noexcept;

/// Name of the tables that say where: [[target]], [[point]] or [[tube]].
const char* table_of_targets(ExerciseKind kind) noexcept;

/// A path shorter than this, from point to point, is refused.
inline constexpr double kShortestPath_m = 0.12;

} // namespace tasks
