// sim/command/report.h
// What a run tells: one JSON object with the keys that others rely on, or a table for people.
#pragma once

#include "sim/session/attempt.h"

#include <nlohmann/json.hpp>
#include <string>

namespace sim {

/// [{metric, name, unit, value or null, good, pass, lower_is_better, felt, reached, share}]
nlohmann::ordered_json profile_json(const Attempt::Outcome& outcome);
/// [{tick, tool, place_m, kind, badness, text}], worst first
nlohmann::ordered_json moments_json(const Attempt::Outcome& outcome);
nlohmann::ordered_json outcome_json(const Attempt::Outcome& outcome);
std::string outcome_table(const Attempt::Outcome& outcome);

} // namespace sim
