#include "tasks/exercise/touch_points.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tasks {
namespace {

constexpr double kFirstMove_m = 1e-3; // more than a held tool trembles or sags
// Two touches with a shorter gap are one: nobody taps faster than about 8 times a second.
constexpr int kContactGap_ticks = 50;
// A brush shorter than this is neither felt nor avoidable; a deliberate touch lasts longer.
constexpr int kWrongRole_ticks = 100;
constexpr int kOffTarget_ticks = 150;     // a slip gets half again as long as a wrong touch
constexpr double kOffTarget_m = 3e-3;     // beyond the target's radius: not aimed at it any more
constexpr double kOverForceRelease = 0.8; // of the limit: one push counts once
constexpr int kHidden_ticks = 500;
constexpr double kHiddenMove_m = 1e-3; // a tool that rests out of the picture does no harm

int ticks(double seconds) {
    return static_cast<int>(std::lround(seconds / kTick_s));
}

void append(TouchProgress& progress, EventKind kind, std::int64_t tick, int tool,
            const glm::dvec3& place_m, double value) {
    progress.events.push_back({tick, kind, static_cast<std::int8_t>(tool),
                               static_cast<std::int8_t>(progress.next), place_m, value});
}

void note_first_move(TouchProgress& progress, const Observation& seen, int t) {
    TouchProgress::Episode& episode = progress.episode[t];
    if (!episode.started) {
        episode.started = true;
        progress.first_tip_m[t] = seen.tool[t].tip_m;
    }
    if (progress.first_move_tick < 0 &&
        glm::distance(seen.tool[t].tip_m, progress.first_tip_m[t]) > kFirstMove_m)
        progress.first_move_tick = seen.tick;
}

// Begin at once, end after the gap; the end closes the episodes that belong to one contact.
void note_contact(TouchProgress& progress, const Observation& seen, int t) {
    TouchProgress::Episode& episode = progress.episode[t];
    const ToolObservation& tool = seen.tool[t];
    const double force_n = glm::length(tool.force_n);
    if (tool.present && tool.touching) {
        if (!episode.touching) {
            append(progress, EventKind::contact_begin, seen.tick, t, tool.contact_m, force_n);
            episode.contact_peak_n = 0.0;
        }
        episode.touching = true;
        episode.free_ticks = 0;
        episode.contact_peak_n = std::max(episode.contact_peak_n, force_n);
    } else if (episode.touching && ++episode.free_ticks >= kContactGap_ticks) {
        append(progress, EventKind::contact_end, seen.tick, t, tool.tip_m, episode.contact_peak_n);
        episode.touching = episode.wrong = episode.off = false;
        episode.wrong_ticks = episode.off_ticks = episode.free_ticks = 0;
    }
}

void note_over_force(TouchProgress& progress, const TouchPoints& exercise, const Observation& seen,
                     int t) {
    TouchProgress::Episode& episode = progress.episode[t];
    const double force_n = glm::length(seen.tool[t].force_n);
    if (!episode.over && force_n > exercise.force_limit_n) {
        episode.over = true;
        append(progress, EventKind::over_force, seen.tick, t, seen.tool[t].contact_m, force_n);
    } else if (force_n < kOverForceRelease * exercise.force_limit_n) {
        episode.over = false;
    }
}

// Counts ticks while `mistaken`; the event comes once per contact, when they are enough.
void note_while_touching(TouchProgress& progress, const Observation& seen, int t, bool mistaken,
                         int enough_ticks, int& count, bool& reported, EventKind kind) {
    const ToolObservation& tool = seen.tool[t];
    if (!tool.touching)
        return; // a gap inside one contact neither counts nor clears
    count = mistaken ? count + 1 : 0;
    if (count >= enough_ticks && !reported) {
        reported = true;
        append(progress, kind, seen.tick, t, tool.contact_m, glm::length(tool.force_n));
    }
}

void note_misplaced_touch(TouchProgress& progress, const TouchPoints& exercise,
                          const Observation& seen, int t) {
    const ToolObservation& tool = seen.tool[t];
    double nearest_m = std::numeric_limits<double>::infinity();
    for (int k = 0; k < seen.targets; ++k)
        nearest_m = std::min(nearest_m, reach_m(tool, seen.target[k].position_m));
    const bool named = t == static_cast<int>(exercise.target[progress.next].role);
    const bool at_next = reach_m(tool, seen.target[progress.next].position_m) <= exercise.radius_m;

    TouchProgress::Episode& episode = progress.episode[t];
    note_while_touching(progress, seen, t, !named && at_next, kWrongRole_ticks, episode.wrong_ticks,
                        episode.wrong, EventKind::wrong_role);
    note_while_touching(progress, seen, t, nearest_m > exercise.radius_m + kOffTarget_m,
                        kOffTarget_ticks, episode.off_ticks, episode.off, EventKind::off_target);
}

// A tool that starts out of the picture is not blamed before it was seen, or touches blindly.
void note_out_of_view(TouchProgress& progress, const Observation& seen, int t) {
    TouchProgress::Episode& episode = progress.episode[t];
    const ToolObservation& tool = seen.tool[t];
    if (in_view(seen.view, tool.tip_m)) {
        episode.was_seen = true;
        episode.hidden = false;
        episode.hidden_ticks = 0;
        return;
    }
    if (episode.hidden_ticks == 0)
        episode.hidden_from_m = tool.tip_m;
    if (!episode.was_seen && !tool.touching)
        return;
    ++episode.hidden_ticks;
    if (!episode.hidden && episode.hidden_ticks > kHidden_ticks &&
        glm::distance(tool.tip_m, episode.hidden_from_m) > kHiddenMove_m) {
        episode.hidden = true;
        append(progress, EventKind::out_of_view, seen.tick, t, tool.tip_m,
               episode.hidden_ticks * kTick_s);
    }
}

void note_hold(TouchProgress& progress, const TouchPoints& exercise, const Observation& seen) {
    const int t = static_cast<int>(exercise.target[progress.next].role);
    const ToolObservation& tool = seen.tool[t];
    const double force_n = glm::length(tool.force_n);
    const bool right = tool.present && tool.touching && force_n >= exercise.force_min_n &&
                       force_n <= exercise.force_max_n &&
                       reach_m(tool, seen.target[progress.next].position_m) <= exercise.radius_m;
    progress.held_ticks = right ? progress.held_ticks + 1 : 0;
    if (progress.held_ticks < ticks(exercise.hold_s))
        return;
    append(progress, EventKind::target_touched, seen.tick, t, tool.contact_m, force_n);
    progress.held_ticks = 0;
    ++progress.next;
    for (TouchProgress::Episode& episode : progress.episode)
        episode.wrong_ticks = 0; // what was right for the last target is not wrong for the next
    if (progress.next < static_cast<int>(exercise.target.size()))
        return;
    progress.complete = true;
    progress.complete_tick = seen.tick;
    append(progress, EventKind::completed, seen.tick, t, tool.contact_m, 0.0);
    progress.events.back().target = -1;
}

void forget_counts(TouchProgress& progress) {
    progress.held_ticks = 0;
    for (TouchProgress::Episode& episode : progress.episode)
        episode.off_ticks = episode.wrong_ticks = episode.hidden_ticks = episode.free_ticks = 0;
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
    constexpr std::array<std::string_view, 12> names{
        "target_touched", "wrong_role", "over_force", "off_target", "out_of_view", "contact_begin",
        "contact_end",    "paused",     "resumed",    "abandoned",  "completed",   "rig_fault"};
    return names[static_cast<std::size_t>(kind)];
}

bool is_error(EventKind kind) noexcept {
    return kind == EventKind::wrong_role || kind == EventKind::over_force ||
           kind == EventKind::off_target || kind == EventKind::out_of_view;
}

void observe(TouchProgress& progress, const TouchPoints& exercise, const Observation& seen) {
    if (progress.complete || exercise.target.empty())
        return;
    if (progress.last_tick >= 0 && seen.tick != progress.last_tick + 1)
        forget_counts(progress);
    progress.last_tick = seen.tick;
    for (int t = 0; t < kTools; ++t) {
        note_contact(progress, seen, t);
        if (!seen.tool[t].present)
            continue;
        note_first_move(progress, seen, t);
        note_over_force(progress, exercise, seen, t);
        note_misplaced_touch(progress, exercise, seen, t);
        note_out_of_view(progress, seen, t);
    }
    note_hold(progress, exercise, seen);
}

bool timed_out(const TouchProgress& progress, const TouchPoints& exercise) noexcept {
    return !progress.complete && progress.first_move_tick >= 0 &&
           progress.last_tick - progress.first_move_tick >= ticks(exercise.time_limit_s);
}

} // namespace tasks
