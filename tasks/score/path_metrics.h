// tasks/score/path_metrics.h
// How well a path was followed, from its begin to its end. Called by sim after finish(), live and
// in every re-score. Version 1 of:
//   deviation_mean, deviation_rms, deviation_max   m, from the curve of the moment, over contact
//                                                  ticks; 0 without any
//   path_inside      share of all ticks from begin to end within the radius, in order and in band
//   path_in_band     share of contact ticks with the force in the exercise's band
//   path_coverage    share of the curve that was followed in order with the force in band
//   path_breaks      count of gaps in following
#pragma once

#include "tasks/score/metrics.h"

namespace tasks {

/// Nothing for other kinds of exercise.
std::vector<Metric> path_metrics(const Progress& progress, const Exercise& exercise,
                                 bool forces_on);

} // namespace tasks
