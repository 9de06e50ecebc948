// sim/session/model_choice.h
// Which tier of tissue::Tier each organ of a scene runs on, and how that is written: on the command
// line, in the logbook. Setup only.
//   "corotated"                     every organ
//   "corotated,flap=quadratic"      the flap otherwise
#pragma once

#include "tissue/solver/solid.h"

#include <span>
#include <string>
#include <vector>

namespace sim {

/// One tier per organ, in the order of the scene; scenery is rigid whatever is said.
using ModelChoice = std::vector<tissue::Tier>;

/// The tier of organs that nothing else is said of.
inline constexpr tissue::Tier kUsualTier = tissue::Tier::corotated;

/// std::invalid_argument says which word is none of the tiers, or which organ the scene lacks, and
/// what would be accepted. `organ`: their names.
ModelChoice parse_model(const std::string& text, std::span<const std::string> organ);

/// The shortest text that parses to `choice`. `soft`: which organs are not scenery; of the others
/// nothing is said.
std::string model_text(const ModelChoice& choice, std::span<const std::string> organ,
                       const std::vector<bool>& soft);

} // namespace sim
