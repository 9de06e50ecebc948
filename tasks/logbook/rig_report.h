// tasks/logbook/rig_report.h
// The rig report as JSON, in the shape that the commands print:
// {"tick_us": {"p50", "p99", "p9999", "max"}, "fem_ms": {"p50", "p99", "max"}, "missed", "dropped",
//  "force_step_mn": {"p999", "max"}, "energy_min_j", "faults": [...]}
// Used by the logbook and by whoever prints an attempt. A number that is not finite is null.
#pragma once

#include "tasks/logbook/logbook.h"

namespace tasks {

std::string rig_json(const RigReport& rig);

/// Missing keys keep their defaults, null reads as NaN. Throws std::invalid_argument on anything
/// else than such an object.
RigReport parse_rig(std::string_view json);

} // namespace tasks
