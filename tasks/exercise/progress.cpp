#include "tasks/exercise/progress.h"

#include "tasks/exercise/episodes.h"
#include "tasks/exercise/find_tubes.h"
#include "tasks/exercise/follow_path.h"
#include "tasks/exercise/touch_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

namespace tasks {
namespace {

// Of the tube that is nearest to being found: they come in any order.
int longest_good_ticks(const Progress& progress) noexcept {
    int most = 0;
    for (const TubeSearch& tube : progress.tube)
        most = tube.found ? most : std::max(most, tube.good_ticks);
    return most;
}

} // namespace

double reach_m(const ToolObservation& tool, const glm::dvec3& place_m) noexcept {
    const glm::dvec3 line = tool.tip_m - tool.contact_m;
    const double length2 = glm::dot(line, line);
    const double along =
        length2 > 0.0 ? std::clamp(glm::dot(place_m - tool.contact_m, line) / length2, 0.0, 1.0)
                      : 0.0;
    return glm::distance(place_m, tool.contact_m + along * line);
}

std::string_view event_name(EventKind kind) noexcept {
    constexpr std::array<std::string_view, 18> names{
        "target_touched", "wrong_role",       "over_force",   "off_target", "out_of_view",
        "contact_begin",  "contact_end",      "paused",       "resumed",    "abandoned",
        "completed",      "rig_fault",        "path_begun",   "path_left",  "order_broken",
        "tube_found",     "tube_not_pointed", "tube_not_seen"};
    static_assert(names.size() == static_cast<std::size_t>(kLastEventKind) + 1);
    return names[static_cast<std::size_t>(kind)];
}

bool is_error(EventKind kind) noexcept {
    switch (kind) {
    case EventKind::wrong_role:
    case EventKind::over_force:
    case EventKind::off_target:
    case EventKind::out_of_view:
    case EventKind::path_left:
    case EventKind::order_broken:
    case EventKind::tube_not_pointed:
    case EventKind::tube_not_seen:
        return true;
    default:
        return false;
    }
}

void observe(Progress& progress, const Exercise& exercise, const Observation& seen) {
    if (progress.complete || exercise.target.empty())
        return;
    switch (exercise.kind) {
    case ExerciseKind::touch_points:
        observe_points(progress, exercise, seen);
        return;
    case ExerciseKind::follow_path:
        observe_path(progress, exercise, seen);
        return;
    case ExerciseKind::find_tubes:
        observe_tubes(progress, exercise, seen);
        return;
    }
}

double share_done(const Progress& progress, const Exercise& exercise) noexcept {
    const auto targets = static_cast<double>(exercise.target.size());
    if (exercise.kind == ExerciseKind::follow_path)
        return progress.path.length_m > 0.0 ? progress.path.done_m / progress.path.length_m : 0.0;
    if (exercise.kind == ExerciseKind::find_tubes)
        return targets > 0.0 ? std::popcount(found_tubes(progress)) / targets : 0.0;
    return targets > 0.0 ? progress.next / targets : 0.0;
}

std::uint32_t found_tubes(const Progress& progress) noexcept {
    std::uint32_t found = 0;
    for (std::size_t k = 0; k < progress.tube.size(); ++k)
        found |= progress.tube[k].found ? 1U << k : 0U;
    return found;
}

double share_at_next(const Progress& progress, const Exercise& exercise) noexcept {
    if (exercise.kind == ExerciseKind::follow_path)
        return progress.path.begin_tick < 0 ? 0.0 : progress.path_u - std::floor(progress.path_u);
    if (exercise.kind == ExerciseKind::find_tubes)
        return longest_good_ticks(progress) * kTick_s / exercise.hold_s;
    return progress.held_ticks * kTick_s / exercise.hold_s;
}

bool timed_out(const Progress& progress, const Exercise& exercise) noexcept {
    return !progress.complete && progress.first_move_tick >= 0 &&
           progress.last_tick - progress.first_move_tick >= ticks_of(exercise.time_limit_s);
}

} // namespace tasks
