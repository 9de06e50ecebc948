// tasks/exercise/exercise_file.cpp
// Bytes of an exercise file -> Exercise. Called by sim when an attempt is set up or re-scored.
#include "tasks/exercise/exercise.h"

#include "tasks/exercise/toml_reader.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace tasks {
namespace {

constexpr double kRounding_m = 1e-9;      // of millimetres in a file
constexpr Range kPlace_mm{-500.0, 500.0}; // no abdomen is larger
constexpr Range kForce_n{0.01, 20.0};     // below: not felt through a port; above: any organ tears
const std::vector<std::string> kKinds{"touch-points", "follow-path", "find-tubes"}; // as the enum

std::string mm(double metres) {
    return std::to_string(std::lround(1e3 * metres));
}

// What a kind wants where the file says nothing.
Exercise standard(ExerciseKind kind) {
    Exercise exercise;
    exercise.kind = kind;
    if (kind == ExerciseKind::follow_path)
        exercise.radius_m = 4e-3;
    if (kind == ExerciseKind::find_tubes) {
        exercise.radius_m = 5e-3;
        exercise.hold_s = 1.0;
        exercise.scope = ScopeHold::assistant; // nobody finds anything with a fixed picture
    }
    return exercise;
}

Role parse_role(const TomlTable& table) {
    return static_cast<Role>(table.choice("role", {"left", "right", "assist"}));
}

ExerciseTarget parse_target(const TomlTable& table, const Exercise& exercise) {
    table.accept_only({"id", "role", "at_mm", "organ"});
    ExerciseTarget target;
    target.id = table.text("id");
    target.role = parse_role(table);
    target.at_m = table.place_mm("at_mm", kPlace_mm);
    target.organ = table.text("organ", "");
    for (const ExerciseTarget& other : exercise.target) {
        if (other.id == target.id)
            table.refuse("id", "an id that no other target has");
        if (glm::distance(other.at_m, target.at_m) < 2.0 * exercise.radius_m)
            table.refuse("at_mm", "a place two radii or more away from target \"" + other.id +
                                      "\": one touch must not count for both");
    }
    return target;
}

// Points of a path: numbered, one role for all, near enough to each other to be one curve.
ExerciseTarget parse_point(const TomlTable& table, const Exercise& exercise, Role role) {
    constexpr double kNearest_m = 2e-3, kFarthest_m = 25e-3;
    table.accept_only({"at_mm", "organ"});
    ExerciseTarget point;
    point.id = std::to_string(exercise.target.size() + 1);
    point.role = role;
    point.at_m = table.place_mm("at_mm", kPlace_mm);
    point.organ = table.text("organ", "");
    if (exercise.target.empty())
        return point;
    const double way_m = glm::distance(exercise.target.back().at_m, point.at_m);
    if (way_m < kNearest_m - kRounding_m || way_m > kFarthest_m + kRounding_m)
        table.refuse("at_mm", "a place " + mm(kNearest_m) + " to " + mm(kFarthest_m) +
                                  " mm from the point before; it is " + mm(way_m) + " mm from it");
    return point;
}

void parse_path(const TomlTable& root, Exercise& exercise) {
    const Role role = parse_role(root);
    double length_m = 0.0;
    for (const TomlTable& table : root.tables("point")) {
        if (static_cast<int>(exercise.target.size()) == kMaxTargets)
            table.refuse("at_mm", "at most " + std::to_string(kMaxTargets) + " points");
        exercise.target.push_back(parse_point(table, exercise, role));
        const std::size_t n = exercise.target.size();
        if (n > 1)
            length_m += glm::distance(exercise.target[n - 2].at_m, exercise.target[n - 1].at_m);
    }
    if (length_m < kShortestPath_m - kRounding_m)
        root.refuse("point", "tables written as [[point]], " + mm(kShortestPath_m) +
                                 " mm long together or more; they are " + mm(length_m) + " mm");
}

void parse_targets(const TomlTable& root, Exercise& exercise, int most) {
    const char* name = table_of_targets(exercise.kind);
    for (const TomlTable& table : root.tables(name)) {
        if (static_cast<int>(exercise.target.size()) == most)
            table.refuse("id",
                         "at most " + std::to_string(most) + " tables written as [[" + name + "]]");
        exercise.target.push_back(parse_target(table, exercise));
    }
    if (exercise.target.empty())
        root.refuse(name, "1 to " + std::to_string(most) + " tables written as [[" + name + "]]");
}

void parse_lift(const TomlTable& table, Exercise& exercise) {
    table.accept_only({"role", "at_mm", "organ", "to_mm", "radius_mm"});
    Lift lift;
    lift.role = parse_role(table);
    lift.at_m = table.place_mm("at_mm", kPlace_mm);
    lift.organ = table.text("organ", "");
    lift.to_m = table.place_mm("to_mm", kPlace_mm);
    lift.radius_m = 1e-3 * table.number("radius_mm", {1.0, 50.0}, 1e3 * lift.radius_m);
    for (const ExerciseTarget& tube : exercise.target)
        if (tube.role == lift.role)
            table.refuse("role", "another role than tube \"" + tube.id +
                                     "\" has: a tool that lifts cannot point");
    exercise.lift = std::move(lift);
}

void parse_tubes(const TomlTable& root, Exercise& exercise) {
    exercise.centre_share = root.number("centre_share", {0.02, 0.5}, exercise.centre_share);
    exercise.least_share = root.number("least_share", {0.005, 0.5}, exercise.least_share);
    exercise.mark_radius_m =
        1e-3 * root.number("mark_radius_mm", {0.5, 10.0}, 1e3 * exercise.mark_radius_m);
    exercise.point_within_s = root.number("point_within_s", {1.0, 600.0}, exercise.point_within_s);
    parse_targets(root, exercise, kMaxTargets - 1);
    if (root.has("lift"))
        parse_lift(root.table("lift"), exercise);
}

void accept_keys(const TomlTable& root, ExerciseKind kind) {
    switch (kind) {
    case ExerciseKind::touch_points:
        return root.accept_only({"kind", "id", "title", "card", "scope", "radius_m", "force_min_n",
                                 "force_max_n", "hold_s", "force_limit_n", "time_limit_s", "target",
                                 "level"});
    case ExerciseKind::follow_path:
        return root.accept_only({"kind", "id", "title", "card", "scope", "role", "radius_m",
                                 "force_min_n", "force_max_n", "force_limit_n", "time_limit_s",
                                 "point", "level"});
    case ExerciseKind::find_tubes:
        return root.accept_only({"kind", "id", "title", "card", "scope", "radius_m", "hold_s",
                                 "force_limit_n", "time_limit_s", "centre_share", "least_share",
                                 "mark_radius_mm", "point_within_s", "tube", "lift", "level"});
    }
}

ExerciseKind parse_kind(const TomlTable& root) {
    return root.has("kind") ? static_cast<ExerciseKind>(root.choice("kind", kKinds))
                            : ExerciseKind::touch_points; // files from before there were others
}

} // namespace

const char* table_of_targets(ExerciseKind kind) noexcept {
    constexpr std::array<const char*, 3> kNames{"target", "point", "tube"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::size_t places_of(const Exercise& exercise) noexcept {
    return exercise.target.size() + (exercise.lift ? 1 : 0);
}

Exercise parse_exercise(std::string_view text, std::string_view file) {
    const TomlTable root = TomlTable::parse(text, file);
    Exercise exercise = standard(parse_kind(root));
    accept_keys(root, exercise.kind);
    if (root.has("hold_s"))
        exercise.hold_s = root.number("hold_s", {0.05, 10.0});
    if (root.has("scope"))
        exercise.scope = static_cast<ScopeHold>(root.choice("scope", {"mount", "assistant"}));
    exercise.id = root.text("id");
    exercise.title = root.text("title");
    exercise.card = root.text("card");
    exercise.radius_m = root.number("radius_m", {0.5e-3, 20e-3}, exercise.radius_m);
    exercise.force_min_n = root.number("force_min_n", kForce_n, exercise.force_min_n);
    exercise.force_max_n = root.number("force_max_n", kForce_n, exercise.force_max_n);
    exercise.force_limit_n = root.number("force_limit_n", kForce_n, exercise.force_limit_n);
    exercise.time_limit_s = root.number("time_limit_s", {5.0, 3600.0}, exercise.time_limit_s);
    const bool band = exercise.kind != ExerciseKind::find_tubes; // that has a limit only
    if (band && exercise.force_min_n >= exercise.force_max_n)
        root.refuse("force_max_n", "a number above force_min_n");
    if (band && exercise.force_max_n > exercise.force_limit_n)
        root.refuse("force_limit_n", "a number not below force_max_n");
    switch (exercise.kind) {
    case ExerciseKind::touch_points:
        parse_targets(root, exercise, kMaxTargets);
        break;
    case ExerciseKind::follow_path:
        parse_path(root, exercise);
        break;
    case ExerciseKind::find_tubes:
        parse_tubes(root, exercise);
        break;
    }
    exercise.level = parse_levels(root);
    return exercise;
}

} // namespace tasks
