// tests/tasks/scored.h
// Whole attempts made by hand and their metrics, for the tests of scores.
#pragma once

#include "tasks/score/metrics.h"

#include "attempt.h"

#include <doctest/doctest.h>
#include <functional>

namespace tasks::testing {

struct Scored {
    ScoreState score;
    Progress progress;
    std::vector<Metric> metrics;
};

/// Changes the resting observation into what is seen at this time.
using Motion = std::function<void(Observation&, double t_s)>;

inline ScoreContext with_ideal_path(ScoreContext context, const Exercise& exercise) {
    for (const ExerciseTarget& target : exercise.target) {
        context.ideal_path_m.push_back(target.at_m);
        context.ideal_role.push_back(target.role);
    }
    return context;
}

/// Ticks [from, to) of an attempt into the folds.
inline void observe_ticks(Scored& out, const Exercise& exercise, int from, int to,
                          const Motion& at) {
    for (int i = from; i < to; ++i) {
        Observation seen = at_rest(exercise);
        seen.tick = i;
        at(seen, i * kTick_s);
        observe(out.progress, exercise, seen);
        observe(out.score, seen);
    }
}

/// Runs an attempt of n ticks at two_points().
inline Scored scored(int n, const Motion& at, ScoreContext context = {}) {
    const Exercise exercise = two_points();
    Scored out;
    observe_ticks(out, exercise, 0, n, at);
    out.metrics = finish(out.score, out.progress, with_ideal_path(std::move(context), exercise));
    return out;
}

inline const Metric* find(const Scored& scored, std::string_view id) {
    for (const Metric& metric : scored.metrics)
        if (metric.id == id)
            return &metric;
    return nullptr;
}

inline double value(const Scored& scored, std::string_view id) {
    const Metric* metric = find(scored, id);
    REQUIRE_MESSAGE(metric != nullptr, std::string(id));
    return metric->value;
}

} // namespace tasks::testing
