#include "tasks/score/path_metrics.h"

#include <cmath>

namespace tasks {
namespace {

constexpr double kRounding = 1e-9; // of a sum of thousands of pieces: all of it is all of it

} // namespace

std::vector<Metric> path_metrics(const Progress& progress, const Exercise& exercise,
                                 bool forces_on) {
    std::vector<Metric> list;
    if (exercise.kind != ExerciseKind::follow_path)
        return list;
    const PathSums& sums = progress.path;
    const auto add = [&](const char* id, double value) {
        list.push_back(defined_metric(id, value, forces_on,
                                      std::max<std::int64_t>(sums.begin_tick, 0), sums.last_tick));
    };
    const double contacts = static_cast<double>(std::max<std::int64_t>(sums.contact_ticks, 1));
    const double ticks = static_cast<double>(std::max<std::int64_t>(sums.ticks, 1));
    add("deviation_mean", sums.distance_m / contacts);
    add("deviation_rms", std::sqrt(sums.distance2_m2 / contacts));
    add("deviation_max", sums.farthest_m);
    add("path_inside", static_cast<double>(sums.inside_ticks) / ticks);
    add("path_in_band", static_cast<double>(sums.band_ticks) / contacts);
    const double covered = sums.length_m > 0.0 ? sums.covered_m / sums.length_m : 0.0;
    add("path_coverage", covered > 1.0 - kRounding ? 1.0 : covered);
    add("path_breaks", sums.breaks);
    return list;
}

} // namespace tasks
