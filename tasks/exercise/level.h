// tasks/exercise/level.h
// What counts as good enough in an exercise: optional [[level]] tables of its file, one per metric.
// Called by the parsers of exercises; not real-time safe.
#pragma once

#include "tasks/exercise/toml_reader.h"

namespace tasks {

struct MetricLevel {
    std::string metric; // id in score/definition.h, one that has a direction
    double good = 0.0;  // expert level
    double pass = 0.0;  // proficiency limit; not on the better side of `good`
};

/// All [[level]] tables of a file; none is fine. Throws BadInput.
std::vector<MetricLevel> parse_levels(const TomlTable& root);

} // namespace tasks
