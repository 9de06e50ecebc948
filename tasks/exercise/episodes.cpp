#include "tasks/exercise/episodes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tasks {
namespace {

constexpr double kFirstMove_m = 1e-3; // more than a held tool trembles or sags
// Two touches with a shorter gap are one: nobody taps faster than about 8 times a second.
constexpr int kContactGap_ticks = 50;
constexpr double kOverForceRelease = 0.8; // of the limit: one push counts once
constexpr int kHidden_ticks = 500;
constexpr double kHiddenMove_m = 1e-3; // a tool that rests out of the picture does no harm

void note_first_move(Progress& progress, const Observation& seen, int t) {
    Progress::Episode& episode = progress.episode[t];
    if (!episode.started) {
        episode.started = true;
        progress.first_tip_m[t] = seen.tool[t].tip_m;
    }
    if (progress.first_move_tick < 0 &&
        glm::distance(seen.tool[t].tip_m, progress.first_tip_m[t]) > kFirstMove_m)
        progress.first_move_tick = seen.tick;
}

// Begin at once, end after the gap; the end closes the episodes that belong to one contact.
void note_contact(Progress& progress, const Observation& seen, int t) {
    Progress::Episode& episode = progress.episode[t];
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
        episode.left = episode.skipped = episode.on_path = false;
        episode.wrong_ticks = episode.off_ticks = episode.free_ticks = 0;
        episode.left_ticks = episode.skipped_ticks = 0;
    }
}

void note_over_force(Progress& progress, const Exercise& exercise, const Observation& seen, int t) {
    Progress::Episode& episode = progress.episode[t];
    const double force_n = glm::length(seen.tool[t].force_n);
    if (!episode.over && force_n > exercise.force_limit_n) {
        episode.over = true;
        append(progress, EventKind::over_force, seen.tick, t, seen.tool[t].contact_m, force_n);
    } else if (force_n < kOverForceRelease * exercise.force_limit_n) {
        episode.over = false;
    }
}

// A tool that starts out of the picture is not blamed before it was seen, or touches blindly.
void note_out_of_view(Progress& progress, const Observation& seen, int t) {
    Progress::Episode& episode = progress.episode[t];
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

void forget_counts(Progress& progress) {
    progress.held_ticks = progress.lost_ticks = 0;
    for (Progress::Episode& episode : progress.episode) {
        episode.off_ticks = episode.wrong_ticks = episode.hidden_ticks = episode.free_ticks = 0;
        episode.left_ticks = episode.skipped_ticks = 0;
        episode.blind_ticks = episode.misused_ticks = 0;
    }
    for (TubeSearch& tube : progress.tube)
        tube.good_ticks = tube.seen_ticks = 0;
}

} // namespace

void append(Progress& progress, EventKind kind, std::int64_t tick, int tool,
            const glm::dvec3& place_m, double value) {
    progress.events.push_back({tick, kind, static_cast<std::int8_t>(tool),
                               static_cast<std::int8_t>(progress.next), place_m, value});
}

void note_while_touching(Progress& progress, const Observation& seen, int t, bool mistaken,
                         int enough_ticks, int& count, bool& reported, EventKind kind,
                         double value) {
    const ToolObservation& tool = seen.tool[t];
    if (!tool.touching)
        return; // a gap inside one contact neither counts nor clears
    count = mistaken ? count + 1 : 0;
    if (count >= enough_ticks && !reported) {
        reported = true;
        append(progress, kind, seen.tick, t, tool.contact_m, value);
    }
}

void note_tools(Progress& progress, const Exercise& exercise, const Observation& seen) {
    if (progress.last_tick >= 0 && seen.tick != progress.last_tick + 1)
        forget_counts(progress);
    progress.last_tick = seen.tick;
    for (int t = 0; t < kTools; ++t) {
        note_contact(progress, seen, t);
        if (!seen.tool[t].present)
            continue;
        note_first_move(progress, seen, t);
        note_over_force(progress, exercise, seen, t);
        note_out_of_view(progress, seen, t);
    }
}

} // namespace tasks
