#include "tasks/exercise/touch_points.h"

#include "tasks/exercise/episodes.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace tasks {
namespace {

void note_misplaced_touch(Progress& progress, const Exercise& exercise, const Observation& seen,
                          int t) {
    const ToolObservation& tool = seen.tool[t];
    const double force_n = glm::length(tool.force_n);
    double nearest_m = std::numeric_limits<double>::infinity();
    for (int k = 0; k < seen.targets; ++k)
        nearest_m = std::min(nearest_m, reach_m(tool, seen.target[k].position_m));
    const bool named = t == static_cast<int>(exercise.target[progress.next].role);
    const bool at_next = reach_m(tool, seen.target[progress.next].position_m) <= exercise.radius_m;

    Progress::Episode& episode = progress.episode[t];
    note_while_touching(progress, seen, t, !named && at_next, kWrongRole_ticks, episode.wrong_ticks,
                        episode.wrong, EventKind::wrong_role, force_n);
    note_while_touching(progress, seen, t, nearest_m > exercise.radius_m + kOffTarget_m,
                        kOffTarget_ticks, episode.off_ticks, episode.off, EventKind::off_target,
                        force_n);
}

void note_hold(Progress& progress, const Exercise& exercise, const Observation& seen) {
    const int t = static_cast<int>(exercise.target[progress.next].role);
    const ToolObservation& tool = seen.tool[t];
    const double force_n = glm::length(tool.force_n);
    const bool right = tool.present && tool.touching && force_n >= exercise.force_min_n &&
                       force_n <= exercise.force_max_n &&
                       reach_m(tool, seen.target[progress.next].position_m) <= exercise.radius_m;
    progress.held_ticks = right ? progress.held_ticks + 1 : 0;
    if (progress.held_ticks < ticks_of(exercise.hold_s))
        return;
    append(progress, EventKind::target_touched, seen.tick, t, tool.contact_m, force_n);
    progress.held_ticks = 0;
    ++progress.next;
    for (Progress::Episode& episode : progress.episode)
        episode.wrong_ticks = 0; // what was right for the last target is not wrong for the next
    if (progress.next < static_cast<int>(exercise.target.size()))
        return;
    progress.complete = true;
    progress.complete_tick = seen.tick;
    append(progress, EventKind::completed, seen.tick, t, tool.contact_m, 0.0);
    progress.events.back().target = -1;
}

} // namespace

void observe_points(Progress& progress, const Exercise& exercise, const Observation& seen) {
    note_tools(progress, exercise, seen);
    for (int t = 0; t < kTools; ++t) {
        if (seen.tool[t].present)
            note_misplaced_touch(progress, exercise, seen, t);
    }
    note_hold(progress, exercise, seen);
}

} // namespace tasks
