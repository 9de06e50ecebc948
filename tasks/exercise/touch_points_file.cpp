// tasks/exercise/touch_points_file.cpp
// Bytes of an exercise file -> TouchPoints. Called by sim when an attempt is set up or re-scored.
#include "tasks/exercise/toml_reader.h"
#include "tasks/exercise/touch_points.h"

#include <glm/geometric.hpp>

namespace tasks {
namespace {

constexpr Range kPlace_mm{-500.0, 500.0}; // no abdomen is larger
constexpr Range kForce_n{0.01, 20.0};     // below: not felt through a port; above: any organ tears

TouchTarget parse_target(const TomlTable& table, const TouchPoints& exercise) {
    table.accept_only({"id", "role", "at_mm", "organ"});
    TouchTarget target;
    target.id = table.text("id");
    target.role = static_cast<Role>(table.choice("role", {"left", "right", "assist"}));
    target.at_m = table.place_mm("at_mm", kPlace_mm);
    target.organ = table.text("organ", "");
    for (const TouchTarget& other : exercise.target) {
        if (other.id == target.id)
            table.refuse("id", "an id that no other target has");
        if (glm::distance(other.at_m, target.at_m) < 2.0 * exercise.radius_m)
            table.refuse("at_mm", "a place two radii or more away from target \"" + other.id +
                                      "\": one touch must not count for both");
    }
    return target;
}

} // namespace

TouchPoints parse_touch_points(std::string_view text, std::string_view file) {
    const TomlTable root = TomlTable::parse(text, file);
    root.accept_only({"id", "title", "card", "radius_m", "force_min_n", "force_max_n", "hold_s",
                      "force_limit_n", "time_limit_s", "target"});
    const TouchPoints standard;
    TouchPoints exercise;
    exercise.id = root.text("id");
    exercise.title = root.text("title");
    exercise.card = root.text("card");
    exercise.radius_m = root.number("radius_m", {0.5e-3, 20e-3}, standard.radius_m);
    exercise.force_min_n = root.number("force_min_n", kForce_n, standard.force_min_n);
    exercise.force_max_n = root.number("force_max_n", kForce_n, standard.force_max_n);
    exercise.hold_s = root.number("hold_s", {0.05, 10.0}, standard.hold_s);
    exercise.force_limit_n = root.number("force_limit_n", kForce_n, standard.force_limit_n);
    exercise.time_limit_s = root.number("time_limit_s", {5.0, 3600.0}, standard.time_limit_s);
    if (exercise.force_min_n >= exercise.force_max_n)
        root.refuse("force_max_n", "a number above force_min_n");
    if (exercise.force_max_n > exercise.force_limit_n)
        root.refuse("force_limit_n", "a number not below force_max_n");

    for (const TomlTable& table : root.tables("target")) {
        if (static_cast<int>(exercise.target.size()) == kMaxTargets)
            table.refuse("id", "at most " + std::to_string(kMaxTargets) + " targets");
        exercise.target.push_back(parse_target(table, exercise));
    }
    if (exercise.target.empty())
        root.refuse("target",
                    "1 to " + std::to_string(kMaxTargets) + " tables written as [[target]]");
    return exercise;
}

} // namespace tasks
