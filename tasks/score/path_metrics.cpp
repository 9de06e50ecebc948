#include "tasks/score/path_metrics.h"

#include <cmath>

namespace tasks {

std::vector<Metric> path_metrics(const Progress& progress, const Exercise& exercise,
                                 bool forces_on) {
    std::vector<Metric> list;
    if (exercise.kind != ExerciseKind::follow_path)
        return list;
    const PathSums& sums = progress.path;
    const auto add = [&](const char* id, double value, const char* unit, bool lower, bool force) {
        list.push_back({.id = id,
                        .version = 1,
                        .value = value,
                        .unit = unit,
                        .lower_is_better = lower,
                        .felt = forces_on || !force,
                        .first_tick = std::max<std::int64_t>(sums.begin_tick, 0),
                        .last_tick = sums.last_tick});
    };
    const double contacts = static_cast<double>(std::max<std::int64_t>(sums.contact_ticks, 1));
    const double ticks = static_cast<double>(std::max<std::int64_t>(sums.ticks, 1));
    add("deviation_mean", sums.distance_m / contacts, "m", true, false);
    add("deviation_rms", std::sqrt(sums.distance2_m2 / contacts), "m", true, false);
    add("deviation_max", sums.farthest_m, "m", true, false);
    add("path_inside", static_cast<double>(sums.inside_ticks) / ticks, "1", false, true);
    add("path_in_band", static_cast<double>(sums.band_ticks) / contacts, "1", false, true);
    add("path_coverage", sums.length_m > 0.0 ? sums.covered_m / sums.length_m : 0.0, "1", false,
        true);
    add("path_breaks", sums.breaks, "1", true, false);
    return list;
}

} // namespace tasks
