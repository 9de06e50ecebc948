#include "tasks/score/sums.h"

#include "tasks/score/ideal_path.h"

#include <algorithm>

namespace tasks {

Window window_of(const ScoreState& score, const Progress& progress) {
    Window window;
    const auto samples = static_cast<std::int64_t>(score.tip_m[0].size());
    if (samples == 0)
        return window;
    window.moved = progress.first_move_tick >= 0;
    const std::int64_t end = score.first_tick + samples - 1;
    window.first_tick = window.moved ? std::clamp(progress.first_move_tick, score.first_tick, end)
                                     : score.first_tick;
    window.last_tick =
        progress.complete ? std::clamp(progress.complete_tick, window.first_tick, end) : end;
    window.first = static_cast<std::size_t>(window.first_tick - score.first_tick);
    window.count = static_cast<std::size_t>(window.last_tick - window.first_tick + 1);
    return window;
}

void add_forces(Sums& sums, const ScoreState& score, std::size_t tool, const Window& window,
                double limit_n) {
    for (std::size_t i = window.first; i < window.first + window.count; ++i) {
        const std::uint8_t flags = score.flags[tool][i];
        if (!(flags & kPresent))
            continue;
        ++sums.ticks;
        sums.hidden += !(flags & kInView);
        if (!(flags & kTouching))
            continue;
        const double force_n = static_cast<double>(score.force_n[tool][i]);
        ++sums.contact;
        sums.force_sum_n += force_n;
        sums.force_peak_n = std::max(sums.force_peak_n, force_n);
        sums.over += force_n > limit_n;
    }
    sums.present = sums.ticks > 0;
}

void add_ideal(Sums& sums, const ScoreState& score, std::size_t tool, const Window& window,
               const Progress& progress, const ScoreContext& context) {
    const std::size_t touched = std::min({static_cast<std::size_t>(std::max(progress.next, 0)),
                                          context.ideal_path_m.size(), context.ideal_role.size()});
    std::vector<glm::dvec3> place_m;
    for (std::size_t k = 0; k < touched; ++k)
        if (context.ideal_role[k] == context.role[tool])
            place_m.push_back(context.ideal_path_m[k]);
    const glm::dvec3 start_m = score.tip_m[tool][window.first];
    const glm::dvec3 port_m = start_m - static_cast<double>(score.insertion_m[tool][window.first]) *
                                            glm::dvec3(score.shaft[tool][window.first]);
    sums.ideal_m = shortest_tour_m(start_m, place_m, context.target_radius_m);
    sums.retraction_m = retraction_tour_m(port_m, start_m, place_m, context.target_radius_m);
}

Sums combined(const std::array<Sums, kTools>& tools) {
    Sums all;
    for (const Sums& tool : tools) {
        if (!tool.present)
            continue;
        all.present = true;
        all.ticks += tool.ticks;
        all.hidden += tool.hidden;
        all.contact += tool.contact;
        all.force_sum_n += tool.force_sum_n;
        all.force_peak_n = std::max(all.force_peak_n, tool.force_peak_n);
        all.intervals += tool.intervals;
        all.idle += tool.idle;
        all.bends += tool.bends;
        all.path_m += tool.path_m;
        all.depth_m += tool.depth_m;
        all.angle_rad += tool.angle_rad;
        all.roll_rad += tool.roll_rad;
        all.accel_sum_mps2 += tool.accel_sum_mps2;
        all.squared_jerk_m2ps5 += tool.squared_jerk_m2ps5;
        all.work_j += tool.work_j;
        all.ideal_m += tool.ideal_m;
        all.retraction_m += tool.retraction_m;
        all.ldlj.insert(all.ldlj.end(), tool.ldlj.begin(), tool.ldlj.end());
        all.sparc.insert(all.sparc.end(), tool.sparc.begin(), tool.sparc.end());
    }
    return all;
}

std::size_t ticks_any_over(const ScoreState& score, const Window& window, double limit_n) {
    std::size_t over = 0;
    for (std::size_t i = window.first; i < window.first + window.count; ++i) {
        bool any = false;
        for (std::size_t t = 0; t < kTools; ++t)
            any = any || ((score.flags[t][i] & kTouching) && (score.flags[t][i] & kPresent) &&
                          static_cast<double>(score.force_n[t][i]) > limit_n);
        over += any;
    }
    return over;
}

} // namespace tasks
