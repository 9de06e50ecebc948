// tasks/score/moments.h
// The worst moments of an attempt, to be shown again on the score page. Called when an attempt
// ends or is re-scored; pure, any thread.
#pragma once

#include "tasks/score/metrics.h"

namespace tasks {

struct Moment {
    std::int64_t tick = 0;
    int tool = -1; // -1: none in particular
    glm::dvec3 place_m{0.0};
    std::string kind;     // an event's name, or largest_force, hesitation
    double badness = 0.0; // of the whole second
    std::string text;     // a plain sentence
};

inline constexpr std::int64_t kMomentsApart_ticks = 2000;
inline constexpr double kHesitation_s = 1.0; // shorter is a pause anybody makes between movements

/// At most `count`, worst first, no two nearer than kMomentsApart_ticks. Every second has the sum
/// of what happened in it; its moment is the worst of that. What counts how much is our choice:
///   over_force      2 + largest force until it is let go, over the limit
///   wrong_role, off_target, errors of other kinds   2
///   out_of_view     1 + seconds unseen, at most 3
///   largest_force   force over the limit, if it stayed below; only if forces were on
///   hesitation      seconds / 10, at most 1: the longest time in which no tool touched, or moved
///                   by 2 mm/s over a tenth of a second; the tool is the one that moved next
std::vector<Moment> worst_moments(const ScoreState& score, const Progress& progress,
                                  const ScoreContext& context, std::size_t count = 3);

} // namespace tasks
