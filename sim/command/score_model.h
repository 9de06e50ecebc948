// sim/command/score_model.h
// What an attempt's outcome says on the score page: numbers become words here. Called by `train`.
#pragma once

#include "sim/session/attempt.h"
#include "sim/view/screens.h"

namespace sim {

/// `title`: the exercise as people know it. `saved`: where the attempt was kept, in words.
view::ScoreModel score_model(const Attempt::Outcome& outcome, const std::string& title,
                             const std::string& saved);

} // namespace sim
