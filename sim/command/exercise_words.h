// sim/command/exercise_words.h
// What menu and instruction card say of an exercise. Called by the window's command; pure.
#pragma once

#include "sim/view/screens.h"
#include "tasks/exercise/exercise.h"

namespace sim {

view::MenuExercise menu_entry(const tasks::Exercise& exercise);
view::CardModel card_model(const tasks::Exercise& exercise);

} // namespace sim
