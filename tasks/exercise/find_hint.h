// tasks/exercise/find_hint.h
// What is missing in find-tubes at this moment, in plain words, by the same functions as the score.
// Called by sim for the window, in the render thread; pure.
#pragma once

#include "tasks/exercise/find_tubes.h"

#include <string>

namespace tasks {

struct FindHint {
    int tube = -1;     // that it is about; -1: all are found
    bool lift = false; // about what hides it
    std::string words;
};

/// About the tube that counts just now; else, of those not found, the one nearest to the middle of
/// the picture; if all lie behind the endoscope, the first. `found`: bit k, tube k.
FindHint find_hint(const Exercise& exercise, const Observation& seen, std::uint32_t found);

} // namespace tasks
