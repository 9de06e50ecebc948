#include "tasks/score/find_metrics.h"

#include <algorithm>
#include <bit>

namespace tasks {

std::vector<Metric> find_metrics(const Progress& progress, const Exercise& exercise,
                                 bool forces_on) {
    std::vector<Metric> list;
    if (exercise.kind != ExerciseKind::find_tubes)
        return list;
    const auto add = [&](const char* id, double value) {
        list.push_back(defined_metric(id, value, forces_on,
                                      std::max<std::int64_t>(progress.first_move_tick, 0),
                                      progress.last_tick));
    };
    add("tubes_found", std::popcount(found_tubes(progress)));
    if (!exercise.lift)
        return list;
    add("retraction_force", progress.lifted_sum_n / std::max(1, progress.lifted_ticks));
    add("retraction_force_peak", progress.lifted_peak_n);
    return list;
}

} // namespace tasks
