#include "tasks/exercise/find_tubes.h"

#include "tasks/exercise/episodes.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace tasks {
namespace {

constexpr double kBlind_s = 0.5;         // beyond the holding time: whoever points, means it
constexpr int kWrongPointer_ticks = 500; // near a tube with the wrong tool, and not in passing

std::size_t tubes_of(const Exercise& exercise, const Observation& seen) {
    return std::min(exercise.target.size(), static_cast<std::size_t>(seen.targets));
}

void append_at(Progress& progress, EventKind kind, const Observation& seen, int tool,
               std::size_t tube, double value) {
    append(progress, kind, seen.tick, tool, seen.target[tube].position_m, value);
    progress.events.back().target = static_cast<std::int8_t>(tube);
}

// The tube that the picture is about: of those that are seen and not found, the most central one;
// none while a tool points at any of them.
std::size_t shown_tube(const Progress& progress, const Exercise& exercise, const Observation& seen,
                       std::size_t tubes) {
    std::size_t shown = tubes;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < tubes; ++k) {
        if (progress.tube[k].found)
            continue;
        if (tube_pointed(exercise, seen, k, static_cast<int>(exercise.target[k].role)))
            return tubes;
        const double off = off_centre(seen.view, seen.target[k].position_m);
        if (off < least && tube_seen(exercise, seen, k)) {
            least = off;
            shown = k;
        }
    }
    return shown;
}

// One tube in one millisecond: found, or in the picture for long and nobody points.
void note_tube(Progress& progress, const Exercise& exercise, const Observation& seen, std::size_t k,
               bool waits) {
    TubeSearch& tube = progress.tube[k];
    const int t = static_cast<int>(exercise.target[k].role);
    const bool shown = tube_seen(exercise, seen, k);
    const bool pointed = tube_pointed(exercise, seen, k, t);
    tube.good_ticks = shown && pointed ? tube.good_ticks + 1 : 0;
    tube.seen_ticks = waits ? tube.seen_ticks + 1 : 0;
    if (!waits)
        tube.not_pointed = false;
    if (!tube.not_pointed && tube.seen_ticks >= ticks_of(exercise.point_within_s)) {
        tube.not_pointed = true;
        append_at(progress, EventKind::tube_not_pointed, seen, t, k, tube.seen_ticks * kTick_s);
    }
    if (tube.good_ticks < ticks_of(exercise.hold_s))
        return;
    tube.found = true;
    append_at(progress, EventKind::tube_found, seen, t, k, tube.good_ticks * kTick_s);
}

// Pointing that cannot count: at what nobody sees, or with a tool that is for something else.
void note_pointing(Progress& progress, const Exercise& exercise, const Observation& seen,
                   std::size_t tubes, int t) {
    Progress::Episode& episode = progress.episode[t];
    bool near = false, own = false, shown = false;
    std::size_t which = 0;
    for (std::size_t k = 0; k < tubes; ++k) {
        if (progress.tube[k].found || !tube_pointed(exercise, seen, k, t))
            continue;
        near = true;
        which = k;
        own = own || static_cast<int>(exercise.target[k].role) == t;
        shown = shown || tube_seen(exercise, seen, k);
    }
    if (!near) {
        episode.blind_ticks = episode.misused_ticks = 0;
        episode.blind = episode.misused = false;
        return;
    }
    episode.blind_ticks = own && !shown ? episode.blind_ticks + 1 : 0;
    if (!episode.blind && episode.blind_ticks >= ticks_of(exercise.hold_s + kBlind_s)) {
        episode.blind = true;
        append_at(progress, EventKind::tube_not_seen, seen, t, which,
                  episode.blind_ticks * kTick_s);
    }
    episode.misused_ticks = own ? 0 : episode.misused_ticks + 1;
    if (!episode.misused && episode.misused_ticks >= kWrongPointer_ticks) {
        episode.misused = true;
        append_at(progress, EventKind::wrong_role, seen, t, which,
                  glm::length(seen.tool[t].force_n));
    }
}

// Where contact is meant: at a tube, and for the lifting tool at the place to lift. What is held
// follows the tool.
void note_misplaced(Progress& progress, const Exercise& exercise, const Observation& seen,
                    std::size_t tubes, int t) {
    const ToolObservation& tool = seen.tool[t];
    double off_m = std::numeric_limits<double>::infinity(); // beyond what is meant
    for (std::size_t k = 0; k < tubes; ++k)
        off_m = std::min(off_m, reach_m(tool, seen.target[k].position_m) - exercise.radius_m);
    const bool lifts = exercise.lift && t == static_cast<int>(exercise.lift->role);
    if (lifts && static_cast<std::size_t>(seen.targets) > tubes)
        off_m =
            std::min(off_m, reach_m(tool, seen.target[tubes].position_m) - exercise.lift->radius_m);
    Progress::Episode& episode = progress.episode[t];
    note_while_touching(progress, seen, t, off_m > kOffTarget_m && !(lifts && tool.grasping),
                        kOffTarget_ticks, episode.off_ticks, episode.off, EventKind::off_target,
                        glm::length(tool.force_n));
}

void note_lift(Progress& progress, const Exercise& exercise, const Observation& seen) {
    if (!exercise.lift)
        return;
    const ToolObservation& tool = seen.tool[static_cast<std::size_t>(exercise.lift->role)];
    if (!tool.present || !tool.grasping)
        return;
    const double force_n = glm::length(tool.force_n);
    ++progress.lifted_ticks;
    progress.lifted_peak_n = std::max(progress.lifted_peak_n, force_n);
    progress.lifted_sum_n += force_n;
}

} // namespace

bool tube_seen(const Exercise& exercise, const Observation& seen, std::size_t tube) noexcept {
    const Target& mark = seen.target[tube];
    return mark.clear_rays >= kEnoughRays &&
           off_centre(seen.view, mark.position_m) <= exercise.centre_share &&
           size_in_view(seen.view, mark.position_m, exercise.mark_radius_m) >= exercise.least_share;
}

bool tube_pointed(const Exercise& exercise, const Observation& seen, std::size_t tube,
                  int tool) noexcept {
    const ToolObservation& t = seen.tool[static_cast<std::size_t>(tool)];
    return t.present && glm::distance(t.tip_m, seen.target[tube].position_m) <= exercise.radius_m;
}

bool is_held_to_lift(const Exercise& exercise, const Observation& seen) noexcept {
    if (!exercise.lift)
        return false;
    constexpr double kComesAlong_m = 12e-3; // what is held stays so near to the tip
    const ToolObservation& tool = seen.tool[static_cast<std::size_t>(exercise.lift->role)];
    const glm::dvec3& place_m = seen.target[exercise.target.size()].position_m;
    return tool.grasping &&
           glm::distance(tool.tip_m, place_m) < kComesAlong_m + exercise.lift->radius_m;
}

bool is_lifted(const Exercise& exercise, const Observation& seen) noexcept {
    if (!exercise.lift)
        return true;
    const Lift& lift = *exercise.lift;
    const glm::dvec3& place_m = seen.target[exercise.target.size()].position_m;
    return glm::distance(place_m, lift.at_m) > 0.5 * glm::distance(lift.to_m, lift.at_m);
}

void observe_tubes(Progress& progress, const Exercise& exercise, const Observation& seen) {
    note_tools(progress, exercise, seen);
    const std::size_t tubes = tubes_of(exercise, seen);
    note_lift(progress, exercise, seen);
    for (int t = 0; t < kTools; ++t) {
        if (!seen.tool[t].present)
            continue;
        note_pointing(progress, exercise, seen, tubes, t);
        note_misplaced(progress, exercise, seen, tubes, t);
    }
    const std::size_t waits = shown_tube(progress, exercise, seen, tubes);
    for (std::size_t k = 0; k < tubes; ++k)
        if (!progress.tube[k].found)
            note_tube(progress, exercise, seen, k, k == waits);
    while (progress.next < static_cast<int>(tubes) &&
           progress.tube[static_cast<std::size_t>(progress.next)].found)
        ++progress.next;
    if (progress.next < static_cast<int>(exercise.target.size()))
        return;
    progress.complete = true;
    progress.complete_tick = seen.tick;
    append(progress, EventKind::completed, seen.tick, static_cast<int>(exercise.target.back().role),
           seen.target[tubes - 1].position_m, 0.0);
    progress.events.back().target = -1;
}

} // namespace tasks
