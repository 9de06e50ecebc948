#include "sim/study/levels_study.h"

#include "tasks/score/definition.h"

#include <cmath>
#include <fmt/format.h>
#include <map>

namespace sim {

LevelRow level_of(const std::string& metric, std::span<const double> value) {
    const tasks::MetricDefinition* definition = tasks::definition_of(metric);
    if (!definition || definition->better == tasks::Better::neither)
        throw std::invalid_argument(
            fmt::format("metric \"{}\": one of which less or more is better", metric));
    if (value.size() < 2)
        throw std::invalid_argument(fmt::format(
            "metric \"{}\": {} attempts have it, two are needed", metric, value.size()));
    const auto n = static_cast<double>(value.size());
    double mean = 0.0, square = 0.0;
    for (const double v : value)
        mean += v / n;
    for (const double v : value)
        square += (v - mean) * (v - mean);
    const double sd = std::sqrt(square / (n - 1.0));
    const double worse = definition->better == tasks::Better::less ? 2.0 * sd : -2.0 * sd;
    return {{metric, mean, mean + worse}, sd, static_cast<int>(value.size())};
}

std::vector<LevelRow> run_levels_study(const LevelsStudyOptions& options) {
    std::map<std::string, std::vector<double>> value;
    for (std::uint64_t seed = options.first_seed; seed <= options.last_seed; ++seed) {
        RunOptions run = options.run;
        run.seed = seed;
        const auto session = make_session(run);
        const Attempt::Outcome outcome = run_lockstep(*session, nullptr, 0);
        if (!outcome.row.completed)
            throw std::runtime_error(
                fmt::format("seed {}: \"{}\" did not complete the exercise", seed, run.hands));
        for (const tasks::Metric& metric : outcome.metrics)
            value[metric.id].push_back(metric.value);
    }
    std::vector<LevelRow> rows;
    for (const std::string& metric : options.metrics)
        rows.push_back(level_of(metric, value[metric]));
    return rows;
}

std::string levels_text(std::span<const LevelRow> rows) {
    std::string text;
    for (const LevelRow& row : rows)
        text +=
            fmt::format("[[level]]\nmetric = \"{}\"\ngood = {:.4g}\npass = {:.4g} # SD {:.2g}\n\n",
                        row.level.metric, row.level.good, row.level.pass, row.sd);
    return text;
}

} // namespace sim
