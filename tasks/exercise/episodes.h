// tasks/exercise/episodes.h
// What every exercise watches in every tool: contact, force, place in the picture. One mistake is
// one event, however long it lasts. Called by the kinds' observe functions.
#pragma once

#include "tasks/exercise/progress.h"

namespace tasks {

/// A slip off the path or onto the wrong place gets half again as long as a wrong touch, which a
/// person neither feels nor can avoid if it is shorter.
inline constexpr int kWrongRole_ticks = 100;
inline constexpr int kOffTarget_ticks = 150;
inline constexpr double kOffTarget_m = 3e-3; // beyond the radius: not aimed at it any more

inline int ticks_of(double seconds) noexcept {
    return static_cast<int>(seconds / kTick_s + 0.5);
}

void append(Progress& progress, EventKind kind, std::int64_t tick, int tool,
            const glm::dvec3& place_m, double value);

/// Contact, first movement, force and picture of all tools; a gap in the ticks first clears the
/// counts.
void note_tools(Progress& progress, const Exercise& exercise, const Observation& seen);

/// Counts ticks while `mistaken`; the event comes once per contact, when they are enough.
void note_while_touching(Progress& progress, const Observation& seen, int t, bool mistaken,
                         int enough_ticks, int& count, bool& reported, EventKind kind,
                         double value);

} // namespace tasks
