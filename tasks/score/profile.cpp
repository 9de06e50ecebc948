#include "tasks/score/profile.h"

#include "tasks/score/definition.h"

#include <algorithm>
#include <cmath>

namespace tasks {
namespace {

// The newest version, if there are several.
const Metric* find_metric(std::span<const Metric> metrics, std::string_view id) {
    const Metric* best = nullptr;
    for (const Metric& metric : metrics)
        if (metric.id == id && (!best || metric.version > best->version))
            best = &metric;
    return best;
}

double share_of(double value, const MetricLevel& level, bool reached) {
    if (level.good == level.pass)
        return reached ? kShareAtGood : 0.0;
    const double along = (value - level.pass) / (level.good - level.pass); // 0 at pass, 1 at good
    return std::clamp(kShareAtPass + (kShareAtGood - kShareAtPass) * along, 0.0, 1.0);
}

} // namespace

std::string_view reached_name(Reached reached) noexcept {
    constexpr std::array<std::string_view, 4> names{"good", "pass", "missed", "not judged"};
    return names[static_cast<std::size_t>(reached)];
}

std::vector<ProfileRow> profile(std::span<const Metric> metrics,
                                std::span<const MetricLevel> levels, bool judged) {
    std::vector<ProfileRow> rows;
    for (const MetricLevel& level : levels) {
        const MetricDefinition* definition = definition_of(level.metric);
        ProfileRow row;
        row.metric = level.metric;
        row.name = metric_name(level.metric);
        row.unit = definition ? definition->unit : "1";
        row.lower_is_better = !definition || definition->better == Better::less;
        row.good = level.good;
        row.pass = level.pass;
        const Metric* metric = find_metric(metrics, level.metric);
        if (metric && std::isfinite(metric->value)) {
            const double value = metric->value;
            const auto within = [&](double limit) {
                return row.lower_is_better ? value <= limit : value >= limit;
            };
            row.value = value;
            row.felt = metric->felt;
            row.share = share_of(value, level, within(level.pass));
            if (judged && row.felt)
                row.reached = within(level.good)   ? Reached::good
                              : within(level.pass) ? Reached::pass
                                                   : Reached::missed;
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace tasks
