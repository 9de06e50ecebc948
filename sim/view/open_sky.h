// sim/view/open_sky.h
// How much light from all around reaches the rest surfaces, past each other: the dark where organs
// lie on one another. Computed once per surface at upload, not per picture. Pure; render thread.
#pragma once

#include "sim/view/frame.h"

#include <vector>

namespace view {

/// Per vertex of surfaces[index]: 1 open .. 0 buried. Every surface counts as a set of discs, one
/// per few vertices, that hide A cos cos' / (pi d^2 + A) of the sky (Bunnell, GPU Gems 2, ch. 14).
std::vector<float> open_sky(std::span<const SurfaceView> surfaces, std::size_t index);

} // namespace view
