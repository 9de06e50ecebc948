#include "tasks/score/metrics.h"

#include "tasks/score/ideal_path.h"
#include "tasks/score/smoothness.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tasks {
namespace {

constexpr std::uint8_t kTouching = 1, kInView = 2, kPresent = 4;
constexpr double kFs_hz = 1.0 / kTick_s;
constexpr double kCutoff_hz = 10.0; // voluntary motion of the hand ends below

// The samples that count: [first, last], as indices into the score's vectors.
struct Window {
    std::size_t first = 0, count = 0;
    std::int64_t first_tick = 0, last_tick = -1;
    bool moved = false;
};

// Sums of one tool over the window; sums of tools are the combined ones.
struct Sums {
    bool present = false;
    double path_m = 0.0, ideal_m = 0.0, force_sum_n = 0.0, force_peak_n = 0.0;
    std::size_t ticks = 0, intervals = 0, idle = 0, hidden = 0, contact = 0, over = 0;
    std::vector<double> ldlj;
};

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

void add_motion(Sums& sums, const std::vector<glm::dvec3>& tip_m, const Window& window) {
    const std::vector<glm::dvec3> path_m = low_pass(tip_m, kFs_hz, kCutoff_hz);
    std::vector<double> speed_mps;
    for (std::size_t i = window.first + 1; i < window.first + window.count; ++i) {
        const double step_m = glm::distance(path_m[i], path_m[i - 1]);
        sums.path_m += step_m;
        sums.idle += step_m * kFs_hz < kMoving_mps;
        speed_mps.push_back(step_m * kFs_hz);
    }
    sums.intervals = speed_mps.size();
    for (const std::span<const double> movement : sub_movements(speed_mps, kFs_hz))
        if (const std::optional<double> smoothness = ldlj(movement, kFs_hz))
            sums.ldlj.push_back(*smoothness);
}

void add_forces(Sums& sums, const ScoreState& score, std::size_t t, const Window& window,
                double limit_n) {
    for (std::size_t i = window.first; i < window.first + window.count; ++i) {
        const std::uint8_t flags = score.flags[t][i];
        if (!(flags & kPresent))
            continue;
        ++sums.ticks;
        sums.hidden += !(flags & kInView);
        if (!(flags & kTouching))
            continue;
        const double force_n = static_cast<double>(score.force_n[t][i]);
        ++sums.contact;
        sums.force_sum_n += force_n;
        sums.force_peak_n = std::max(sums.force_peak_n, force_n);
        sums.over += force_n > limit_n;
    }
    sums.present = sums.ticks > 0;
}

void add_ideal(Sums& sums, const ScoreState& score, std::size_t t, const Window& window,
               const Progress& progress, const ScoreContext& context) {
    const std::size_t touched = std::min({static_cast<std::size_t>(std::max(progress.next, 0)),
                                          context.ideal_path_m.size(), context.ideal_role.size()});
    std::vector<glm::dvec3> place_m;
    for (std::size_t k = 0; k < touched; ++k)
        if (context.ideal_role[k] == context.role[t])
            place_m.push_back(context.ideal_path_m[k]);
    sums.ideal_m = shortest_tour_m(score.tip_m[t][window.first], place_m, context.target_radius_m);
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

Sums combined(const std::array<Sums, kTools>& tools) {
    Sums all;
    for (const Sums& tool : tools) {
        if (!tool.present)
            continue;
        all.present = true;
        all.path_m += tool.path_m;
        all.ideal_m += tool.ideal_m;
        all.force_sum_n += tool.force_sum_n;
        all.force_peak_n = std::max(all.force_peak_n, tool.force_peak_n);
        all.ticks += tool.ticks;
        all.intervals += tool.intervals;
        all.idle += tool.idle;
        all.hidden += tool.hidden;
        all.contact += tool.contact;
        all.ldlj.insert(all.ldlj.end(), tool.ldlj.begin(), tool.ldlj.end());
    }
    return all;
}

double share(std::size_t part, std::size_t of) {
    return of > 0 ? static_cast<double>(part) / static_cast<double>(of) : 0.0;
}

class Report {
  public:
    Report(const Window& window, bool forces_on) : window_(window), forces_on_(forces_on) {}
    void add(std::string id, double value, const char* unit, bool lower_is_better,
             bool of_force = false) {
        list_.push_back({std::move(id), 1, value, unit, lower_is_better, forces_on_ || !of_force,
                         window_.first_tick, window_.last_tick});
    }
    std::vector<Metric> list_;

  private:
    Window window_;
    bool forces_on_;
};

void report_sums(Report& report, const Sums& sums, const std::string& of) {
    const double travelled_s = static_cast<double>(sums.intervals) * kTick_s;
    const double economy = sums.path_m > 0.0 ? std::min(1.0, sums.ideal_m / sums.path_m) : 0.0;
    report.add("path_length" + of, sums.path_m, "m", true);
    report.add("economy" + of, economy, "1", false);
    report.add("speed_mean" + of, travelled_s > 0.0 ? sums.path_m / travelled_s : 0.0, "m/s",
               false);
    report.add("idle" + of, share(sums.idle, sums.intervals), "1", true);
    if (const std::optional<double> smoothness = median(sums.ldlj))
        report.add("ldlj" + of, *smoothness, "1", false);
    report.add("out_of_view" + of, share(sums.hidden, sums.ticks), "1", true);
    const double mean_n =
        sums.contact > 0 ? sums.force_sum_n / static_cast<double>(sums.contact) : 0.0;
    report.add("force_mean" + of, mean_n, "N", true, true);
    report.add("force_peak" + of, sums.force_peak_n, "N", true, true);
    report.add("impulse" + of, sums.force_sum_n * kTick_s, "N s", true, true);
    report.add("over_force" + of, static_cast<double>(sums.over) * kTick_s, "s", true, true);
}

void report_errors(Report& report, const Progress& progress) {
    constexpr std::array<EventKind, 6> kinds{EventKind::wrong_role, EventKind::over_force,
                                             EventKind::off_target, EventKind::out_of_view,
                                             EventKind::path_left,  EventKind::order_broken};
    const auto count = [&](EventKind kind) {
        return static_cast<double>(
            std::count_if(progress.events.begin(), progress.events.end(),
                          [&](const Event& event) { return event.kind == kind; }));
    };
    double total = 0.0;
    for (const EventKind kind : kinds)
        total += count(kind);
    report.add("over_force_episodes", count(EventKind::over_force), "1", true, true);
    report.add("errors", total, "1", true);
    for (const EventKind kind : kinds)
        report.add("errors." + std::string(event_name(kind)), count(kind), "1", true,
                   kind == EventKind::over_force);
}

} // namespace

void observe(ScoreState& score, const Observation& seen) {
    if (score.last_tick < 0)
        score.first_tick = seen.tick;
    score.last_tick = seen.tick;
    for (std::size_t t = 0; t < kTools; ++t) {
        const ToolObservation& tool = seen.tool[t];
        score.tip_m[t].push_back(tool.tip_m);
        score.force_n[t].push_back(static_cast<float>(glm::length(tool.force_n)));
        score.flags[t].push_back(static_cast<std::uint8_t>(
            (tool.touching ? kTouching : 0) | (in_view(seen.view, tool.tip_m) ? kInView : 0) |
            (tool.present ? kPresent : 0)));
    }
}

std::vector<Metric> finish(const ScoreState& score, const Progress& progress,
                           const ScoreContext& context) {
    const Window window = window_of(score, progress);
    std::array<Sums, kTools> tools;
    for (std::size_t t = 0; t < kTools && window.count > 0; ++t) {
        add_forces(tools[t], score, t, window, context.force_limit_n);
        if (!tools[t].present)
            continue;
        add_ideal(tools[t], score, t, window, progress, context);
        add_motion(tools[t], score.tip_m[t], window);
    }
    Sums all = combined(tools);
    if (window.count > 0)
        all.over = ticks_any_over(score, window, context.force_limit_n);

    Report report(window, context.forces_on);
    const double time_s = static_cast<double>(window.last_tick - window.first_tick) * kTick_s;
    report.add("time", window.moved ? time_s : 0.0, "s", true);
    report_sums(report, all, "");
    for (std::size_t t = 0; t < kTools; ++t)
        if (tools[t].present)
            report_sums(report, tools[t], "." + std::string(role_name(context.role[t])));
    report_errors(report, progress);
    return std::move(report.list_);
}

} // namespace tasks
