// tasks/score/scope_metrics.h
// What the endoscope did in the time that counts. Called by finish(); any thread, no state.
#pragma once

#include "tasks/score/sums.h"

namespace tasks {

struct ScopeSums {
    double path_m = 0.0; // of the low-passed eye
    double horizon_rms_rad = 0.0, horizon_over = 0.0;
};
/// Of a score that has the endoscope in every tick of the window.
ScopeSums scope_sums(const ScoreState& score, const Window& window);

} // namespace tasks
