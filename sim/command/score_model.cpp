#include "sim/command/score_model.h"

#include "tasks/score/definition.h"

#include <cmath>
#include <fmt/format.h>

namespace sim {
namespace {

std::string plain_unit(std::string_view unit) {
    return unit == "1" ? "" : fmt::format(" {}", unit);
}

// Counts whole, the rest with three significant digits: finer no level is.
std::string number(double value) {
    return value == std::round(value) && std::abs(value) < 1e6 ? fmt::format("{:.0f}", value)
                                                               : fmt::format("{:.3g}", value);
}

view::ProfileBar bar_of(const tasks::ProfileRow& row) {
    using Mark = view::ProfileBar::Mark;
    view::ProfileBar bar;
    bar.name = row.name;
    bar.value = !row.value  ? "not measured"
                : !row.felt ? "not felt"
                            : number(*row.value) + plain_unit(row.unit);
    bar.limit = fmt::format("pass: {} {}", row.lower_is_better ? "at most" : "at least",
                            number(row.pass) + plain_unit(row.unit));
    bar.share = row.reached == tasks::Reached::not_judged ? 0.0 : row.share;
    bar.pass_share = tasks::kShareAtPass;
    bar.good_share = tasks::kShareAtGood;
    switch (row.reached) {
    case tasks::Reached::good:
        bar.mark = Mark::good;
        bar.word = "expert level";
        break;
    case tasks::Reached::pass:
        bar.mark = Mark::pass;
        bar.word = "passed";
        break;
    case tasks::Reached::missed:
        bar.mark = Mark::missed;
        bar.word = "missed";
        break;
    case tasks::Reached::not_judged:
        bar.word = "not judged";
        break;
    }
    return bar;
}

view::ScoreMetric metric_of(const tasks::Metric& m) {
    const tasks::MetricDefinition* definition = tasks::definition_of(m.id);
    view::ScoreMetric metric;
    metric.name = definition ? std::string(definition->name) : m.id;
    metric.value = m.value;
    metric.unit = m.unit == "1" ? "" : m.unit;
    metric.lower_is_better = m.lower_is_better;
    metric.directed = !definition || definition->better != tasks::Better::neither;
    metric.felt = m.felt;
    const double size = std::abs(m.value);
    metric.decimals = m.value == std::round(m.value) || size >= 1000.0 ? 0 : size < 0.1 ? 4 : 2;
    return metric;
}

} // namespace

view::ScoreModel score_model(const Attempt::Outcome& outcome, const std::string& title,
                             const std::string& saved) {
    view::ScoreModel score;
    score.title = title;
    score.completed = outcome.row.completed;
    score.valid = outcome.row.valid;
    score.invalid_reasons = outcome.row.rig.faults;
    score.saved = saved;
    for (const tasks::Metric& m : outcome.metrics)
        if (m.id.find('.') == std::string::npos) // per tool and per kind: the review's business
            score.metrics.push_back(metric_of(m));
    for (const tasks::ProfileRow& row : outcome.profile)
        score.profile.push_back(bar_of(row));
    for (const tasks::Moment& moment : outcome.moments)
        score.moments.push_back({double(moment.tick) * kTick_s, moment.text});
    score.moments_can_be_shown = !outcome.chunks.empty();
    for (const tasks::Event& e : outcome.events) {
        if (!tasks::is_error(e.kind))
            continue;
        score.errors.push_back(
            {.time_s = double(e.tick) * kTick_s,
             .text = fmt::format("{}: tool {}", tasks::event_name(e.kind),
                                 e.tool >= 0 ? tasks::role_name(tasks::Role(e.tool))
                                             : std::string_view("-"))});
    }
    return score;
}

} // namespace sim
