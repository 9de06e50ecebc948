// sim/study/levels_study.h
// trocar study levels: what the shipped scripted hands reach in an exercise, as [[level]] tables
// for its file: mean, and mean plus two standard deviations towards worse.
#pragma once

#include "sim/session/session.h"

namespace sim {

struct LevelsStudyOptions {
    RunOptions run; // its seed is not used
    std::uint64_t first_seed = 101, last_seed = 110;
    std::vector<std::string> metrics{"time",       "path_length", "economy",    "errors",
                                     "force_peak", "ldlj",        "out_of_view"};
};

struct LevelRow {
    tasks::MetricLevel level; // good: mean, pass: two SD worse
    double sd = 0.0;          // of the sample: n - 1
    int attempts = 0;         // that have this metric
};

/// From the values of one metric over attempts. Throws std::invalid_argument for an unknown metric,
/// one without a direction, or fewer than two values.
LevelRow level_of(const std::string& metric, std::span<const double> value);

/// One completed attempt in lockstep per seed; throws std::runtime_error if one is not completed.
std::vector<LevelRow> run_levels_study(const LevelsStudyOptions& options);

/// The tables, four significant digits, each with its SD in a comment.
std::string levels_text(std::span<const LevelRow> rows);

} // namespace sim
