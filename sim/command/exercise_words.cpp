// sim/command/exercise_words.cpp
#include "sim/command/exercise_words.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sim {
namespace {

using tasks::ExerciseKind;

// Its targets' and its lifting role, and the endoscope where somebody moves it.
std::vector<view::Role> roles_of(const tasks::Exercise& exercise) {
    std::array<bool, 4> used{};
    for (const tasks::ExerciseTarget& target : exercise.target)
        used[static_cast<std::size_t>(target.role)] = true;
    if (exercise.lift)
        used[static_cast<std::size_t>(exercise.lift->role)] = true;
    if (exercise.scope == tasks::ScopeHold::assistant)
        used[static_cast<std::size_t>(tasks::Role::scope)] = true;
    std::vector<view::Role> roles;
    for (std::size_t r = 0; r < used.size(); ++r)
        if (used[r])
            roles.push_back(static_cast<view::Role>(r));
    return roles;
}

const char* name_of(view::Role role) {
    return role == view::Role::scope ? "endoscope"
                                     : tasks::role_name(static_cast<tasks::Role>(role)).data();
}

std::vector<std::string> limits_of(const tasks::Exercise& e) {
    const std::string time = fmt::format("Time limit {:.0f} s", e.time_limit_s);
    const std::string band = fmt::format("Force {:.1f} to {:.1f} N, error above {:.1f} N",
                                         e.force_min_n, e.force_max_n, e.force_limit_n);
    switch (e.kind) {
    case ExerciseKind::follow_path:
        return {band, fmt::format("Stay within {:.0f} mm of the path", 1e3 * e.radius_m), time};
    case ExerciseKind::touch_points:
        return {band, fmt::format("Hold {:.1f} s within {:.0f} mm", e.hold_s, 1e3 * e.radius_m),
                time};
    case ExerciseKind::find_tubes:
        return {fmt::format("Force: error above {:.2f} N", e.force_limit_n),
                fmt::format("Hold {:.1f} s within {:.0f} mm, tube in the ring and large", e.hold_s,
                            1e3 * e.radius_m),
                time};
    }
    return {};
}

const char* count_word(ExerciseKind kind) {
    return kind == ExerciseKind::follow_path    ? "points of a path"
           : kind == ExerciseKind::touch_points ? "targets"
                                                : "tubes";
}

} // namespace

view::MenuExercise menu_entry(const tasks::Exercise& exercise) {
    std::vector<const char*> names;
    for (const view::Role role : roles_of(exercise))
        names.push_back(name_of(role));
    return {.title = exercise.title,
            .hands = fmt::format("{}", fmt::join(names, ", ")),
            .summary = fmt::format("{} {}", exercise.target.size(), count_word(exercise.kind))};
}

view::CardModel card_model(const tasks::Exercise& exercise) {
    return {.title = exercise.title,
            .text = exercise.card,
            .roles = roles_of(exercise),
            .limits = limits_of(exercise)};
}

} // namespace sim
