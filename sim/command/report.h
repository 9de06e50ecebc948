// sim/command/report.h
// What a run tells: one JSON object with the keys that others rely on, or a table for people.
#pragma once

#include "sim/session/attempt.h"

#include <nlohmann/json.hpp>
#include <string>

namespace sim {

nlohmann::ordered_json outcome_json(const Attempt::Outcome& outcome);
std::string outcome_table(const Attempt::Outcome& outcome);

} // namespace sim
