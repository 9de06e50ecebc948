// tasks/score/profile.h
// An attempt's metrics against the levels of its exercise, row by row: for the score page and for
// scripts. No composite: each metric stands for itself. Pure; any thread.
#pragma once

#include "tasks/score/metrics.h"

namespace tasks {

enum class Reached : std::uint8_t { good, pass, missed, not_judged };
std::string_view reached_name(Reached reached) noexcept; // "good", "pass", "missed", "not judged"

inline constexpr double kShareAtPass = 0.5, kShareAtGood = 0.9;

struct ProfileRow {
    std::string metric, name, unit;
    std::optional<double> value; // nothing: this attempt has no such metric
    bool lower_is_better = true;
    bool felt = true;
    double good = 0.0, pass = 0.0;
    Reached reached = Reached::not_judged;
    // Length of a bar, 0..1, longer is better: kShareAtPass at `pass`, kShareAtGood at `good`,
    // straight through both. If they are equal: kShareAtGood when reached, else 0.
    double share = 0.0;
};

/// One row per level, in their order. `judged` false (attempt not completed, or not valid) leaves
/// values and bars, but nothing counts as reached or missed; so does a force that was not felt.
std::vector<ProfileRow> profile(std::span<const Metric> metrics,
                                std::span<const MetricLevel> levels, bool judged);

} // namespace tasks
