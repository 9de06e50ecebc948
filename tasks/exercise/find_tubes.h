// tasks/exercise/find_tubes.h
// Tubes hidden under a flap or behind an organ: one tool lifts, another points, and the endoscope
// is brought to show them. Found: the tube's mark is unoccluded, near the middle of the picture and
// large enough, while the tool of its role points at it, for exercise.hold_s. In any order.
// Called by observe(); pure.
#pragma once

#include "tasks/exercise/progress.h"

namespace tasks {

void observe_tubes(Progress& progress, const Exercise& exercise, const Observation& seen);

/// So many of kSightRays are enough: the tool that points may hide a part of the mark.
inline constexpr int kEnoughRays = 5;

/// In the picture as it has to be.
bool tube_seen(const Exercise& exercise, const Observation& seen, std::size_t tube) noexcept;
/// The tip is as near as it has to be; the tissue need not be touched.
bool tube_pointed(const Exercise& exercise, const Observation& seen, std::size_t tube,
                  int tool) noexcept;

/// The lifting tool holds tissue, and the place to lift comes along with it.
bool is_held_to_lift(const Exercise& exercise, const Observation& seen) noexcept;
/// That place is more than half-way up. True where nothing has to be lifted.
bool is_lifted(const Exercise& exercise, const Observation& seen) noexcept;

} // namespace tasks
