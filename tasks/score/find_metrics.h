// tasks/score/find_metrics.h
// What find-tubes reports beside the metrics of every exercise. Called at the end of an attempt and
// by re-score; any thread, no state.
#pragma once

#include "tasks/score/metrics.h"

namespace tasks {

/// Version 1 of: tubes_found, a count; retraction_force and retraction_force_peak, N, on the tip of
/// the lifting tool while its jaws hold tissue. Nothing for another kind of exercise.
std::vector<Metric> find_metrics(const Progress& progress, const Exercise& exercise,
                                 bool forces_on);

} // namespace tasks
