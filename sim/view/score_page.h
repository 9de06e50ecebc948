// sim/view/score_page.h
// The score of an attempt: profile against the levels, worst moments, all numbers, errors. Called
// by draw_page().
#pragma once

#include "sim/view/input.h"
#include "sim/view/look.h"
#include "sim/view/screens.h"

namespace view {

/// A moment's button asks for Action::show with its index.
void draw_score(const ScoreModel& score, const Fonts& fonts, bool fresh, UserInput& input);

} // namespace view
