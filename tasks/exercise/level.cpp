#include "tasks/exercise/level.h"

#include "tasks/score/definition.h"

namespace tasks {
namespace {

constexpr Range kAny{-1e9, 1e9};

MetricLevel parse_level(const TomlTable& table, const std::vector<MetricLevel>& before) {
    table.accept_only({"metric", "good", "pass"});
    MetricLevel level{table.text("metric"), table.number("good", kAny), table.number("pass", kAny)};
    const MetricDefinition* definition = definition_of(level.metric);
    if (!definition)
        table.refuse("metric", "a metric's id, such as \"time\" or \"path_length.left\"");
    if (definition->better == Better::neither)
        table.refuse("metric", "a metric of which less or more is better");
    for (const MetricLevel& other : before)
        if (other.metric == level.metric)
            table.refuse("metric", "a metric that no other level has");
    const bool less = definition->better == Better::less;
    if (less ? level.pass < level.good : level.pass > level.good)
        table.refuse("pass", less ? "a number not below good: less is better"
                                  : "a number not above good: more is better");
    return level;
}

} // namespace

std::vector<MetricLevel> parse_levels(const TomlTable& root) {
    std::vector<MetricLevel> levels;
    for (const TomlTable& table : root.tables("level"))
        levels.push_back(parse_level(table, levels));
    return levels;
}

} // namespace tasks
