#include "tasks/score/metrics.h"

#include "tasks/score/definition.h"
#include "tasks/score/scope_metrics.h"
#include "tasks/score/smoothness.h"
#include "tasks/score/sums.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace tasks {
namespace {

double share(std::size_t part, std::size_t of) {
    return of > 0 ? static_cast<double>(part) / static_cast<double>(of) : 0.0;
}

class Report {
  public:
    Report(const Window& window, bool forces_on) : window_(window), forces_on_(forces_on) {}
    /// `id` is in the table of definitions, or a role's version of one that is.
    void add(std::string id, double value) {
        list_.push_back(defined_metric(std::move(id), value, forces_on_, window_.first_tick,
                                       window_.last_tick));
    }
    void add(std::string id, const std::optional<double>& value) {
        if (value)
            add(std::move(id), *value);
    }
    std::vector<Metric> list_;

  private:
    Window window_;
    bool forces_on_;
};

void report_motion(Report& report, const Sums& sums, const std::string& of, double time_s) {
    const double travelled_s = static_cast<double>(sums.intervals) * kTick_s;
    const auto per_path = [&](double way_m) {
        return sums.path_m > 0.0 ? way_m / sums.path_m : 0.0;
    };
    report.add("path_length" + of, sums.path_m);
    report.add("economy" + of, std::min(1.0, per_path(sums.ideal_m)));
    report.add("retraction_length" + of, per_path(sums.retraction_m));
    report.add("depth_length" + of, sums.depth_m);
    report.add("angular_path" + of, sums.angle_rad);
    report.add("roll_path" + of, sums.roll_rad);
    report.add("speed_mean" + of, travelled_s > 0.0 ? sums.path_m / travelled_s : 0.0);
    report.add("accel_mean" + of,
               sums.bends > 0 ? sums.accel_sum_mps2 / static_cast<double>(sums.bends) : 0.0);
    report.add("idle" + of, share(sums.idle, sums.intervals));
    report.add("ldlj" + of, median(sums.ldlj));
    report.add("sparc" + of, median(sums.sparc));
    report.add("jerk_norm" + of, jerk_norm(time_s, sums.path_m, sums.squared_jerk_m2ps5));
    report.add("out_of_view" + of, share(sums.hidden, sums.ticks));
}

void report_forces(Report& report, const Sums& sums, const std::string& of) {
    const double mean_n =
        sums.contact > 0 ? sums.force_sum_n / static_cast<double>(sums.contact) : 0.0;
    report.add("force_mean" + of, mean_n);
    report.add("force_peak" + of, sums.force_peak_n);
    report.add("impulse" + of, sums.force_sum_n * kTick_s);
    report.add("work" + of, sums.work_j);
    report.add("over_force" + of, static_cast<double>(sums.over) * kTick_s);
}

void report_errors(Report& report, const Progress& progress) {
    constexpr std::array<EventKind, 8> kinds{EventKind::wrong_role,       EventKind::over_force,
                                             EventKind::off_target,       EventKind::out_of_view,
                                             EventKind::path_left,        EventKind::order_broken,
                                             EventKind::tube_not_pointed, EventKind::tube_not_seen};
    const auto count = [&](EventKind kind) {
        return static_cast<double>(
            std::count_if(progress.events.begin(), progress.events.end(),
                          [&](const Event& event) { return event.kind == kind; }));
    };
    double total = 0.0;
    for (const EventKind kind : kinds)
        total += count(kind);
    report.add("over_force_episodes", count(EventKind::over_force));
    report.add("errors", total);
    for (const EventKind kind : kinds)
        report.add("errors." + std::string(event_name(kind)), count(kind));
}

// Speeds by role; a role that no present tool has moved nothing.
std::optional<double> bimanual(const std::array<std::vector<double>, kTools>& speed_mps,
                               const std::array<Role, kTools>& role) {
    const auto of = [&](Role wanted) -> std::span<const double> {
        const auto tool = std::find(role.begin(), role.end(), wanted);
        if (tool == role.end())
            return {};
        return speed_mps[static_cast<std::size_t>(tool - role.begin())];
    };
    return speed_correlation(of(Role::left), of(Role::right));
}

// The endoscope and the tissue, over the same time as the tools.
void report_scope(Report& report, const ScoreState& score, const Window& window) {
    if (window.count == 0)
        return;
    if (score.eye_m.size() == score.stress_pa.size()) {
        const ScopeSums scope = scope_sums(score, window);
        report.add("path_length.scope", scope.path_m);
        report.add("horizon_rms", scope.horizon_rms_rad);
        report.add("horizon_over", scope.horizon_over);
    }
    const auto first = score.stress_pa.begin() + static_cast<std::ptrdiff_t>(window.first);
    const auto last = first + static_cast<std::ptrdiff_t>(window.count);
    report.add("stress_peak", static_cast<double>(*std::max_element(first, last)));
}

} // namespace

Metric defined_metric(std::string id, double value, bool forces_on, std::int64_t first_tick,
                      std::int64_t last_tick) {
    const MetricDefinition* definition = definition_of(id);
    if (!definition)
        throw std::logic_error("metric without a definition: " + id);
    return {std::move(id),
            definition->version,
            value,
            std::string(definition->unit),
            definition->better == Better::less,
            forces_on || !definition->of_force,
            first_tick,
            last_tick};
}

void observe(ScoreState& score, const Observation& seen) {
    if (score.last_tick < 0)
        score.first_tick = seen.tick;
    score.last_tick = seen.tick;
    if (seen.scope_present) {
        score.eye_m.push_back(seen.view.eye_m);
        score.horizon_rad.push_back(static_cast<float>(seen.horizon_rad));
    }
    score.stress_pa.push_back(static_cast<float>(seen.stress_pa));
    for (std::size_t t = 0; t < kTools; ++t) {
        const ToolObservation& tool = seen.tool[t];
        score.tip_m[t].push_back(tool.tip_m);
        score.shaft[t].emplace_back(tool.shaft);
        score.insertion_m[t].push_back(static_cast<float>(tool.insertion_m));
        score.roll_rad[t].push_back(static_cast<float>(tool.roll_rad));
        score.force_on_n[t].emplace_back(tool.force_n);
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
    std::array<std::vector<double>, kTools> speed_mps;
    for (std::size_t t = 0; t < kTools && window.count > 0; ++t) {
        add_forces(tools[t], score, t, window, context.force_limit_n);
        if (!tools[t].present)
            continue;
        add_ideal(tools[t], score, t, window, progress, context);
        speed_mps[t] = add_motion(tools[t], score, t, window);
    }
    Sums all = combined(tools);
    if (window.count > 0)
        all.over = ticks_any_over(score, window, context.force_limit_n);

    Report report(window, context.forces_on);
    const double time_s = static_cast<double>(window.last_tick - window.first_tick) * kTick_s;
    report.add("time", window.moved ? time_s : 0.0);
    const auto report_sums = [&](const Sums& sums, const std::string& of) {
        report_motion(report, sums, of, time_s);
        report_forces(report, sums, of);
    };
    report_sums(all, "");
    for (std::size_t t = 0; t < kTools; ++t)
        if (tools[t].present)
            report_sums(tools[t], "." + std::string(role_name(context.role[t])));
    report.add("bimanual", bimanual(speed_mps, context.role));
    report_errors(report, progress);
    report_scope(report, score, window);
    return std::move(report.list_);
}

} // namespace tasks
