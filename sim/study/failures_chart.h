// sim/study/failures_chart.h
// The rows of trocar study failures as a picture: one cell for every method in every scene, which
// says by colour, by a sign and in words whether the method holds there, fails as the literature
// says it does, or does what nobody expected. Called by failures_study; pure.
#pragma once

#include "sim/study/failures_study.h"

#include <span>
#include <string>
#include <vector>

namespace sim {

enum class FailureVerdict {
    holds,          // every check is right
    fails_as_known, // what is known to be wrong of it is, the rest is right
    unexpected,     // some check is not as expected, either way
};

/// All checks of one method in one scene.
struct FailureCell {
    std::string scene, method;
    FailureVerdict verdict = FailureVerdict::holds;
    int checks = 0, counted = 0; // of these so many have the verdict
    std::string worst{};         // of those that have it: measured over gate, in words
};

/// In the order in which the rows begin them.
std::vector<FailureCell> failure_cells(const std::vector<FailureRow>& rows);

struct FailureScene {
    std::string_view name, about;
};

/// The contact methods of kContactMethods as columns, below them what else is in the scenes, each
/// cell with its name. Scenes without a row are left out. `caption`: lines under the legend. Words
/// that are too long for their place are written smaller, so that nothing leaves it.
std::string failures_svg(std::span<const FailureScene> scenes, const std::vector<FailureRow>& rows,
                         std::span<const std::string> caption);

} // namespace sim
