// tasks/logbook/summary.h
// Who did what: the attempts of every trainee with a few key metrics, as a table and as JSON. For
// `trocar trainee list` and the window's picker; not for the 1 kHz thread.
#pragma once

#include "tasks/logbook/logbook.h"

namespace tasks {

struct AttemptSummary {
    std::int64_t id = 0;
    std::string started_utc, exercise, input_class;
    bool ended = false, completed = false, valid = false, forces_on = true;
    // In the newest version that was stored; empty: not measured (the attempt was broken off).
    std::optional<Metric> time, path_length, errors, force_peak;
};

struct TraineeSummary {
    std::string id;                       // empty: attempts without a trainee
    std::string name;                     // empty: deleted, or never known here
    std::vector<AttemptSummary> attempts; // in the order they were begun
};

/// Trainees by name, also those without attempts; then pseudonyms without a name, by id; then the
/// attempts of nobody.
std::vector<TraineeSummary> summarise(Logbook& logbook);

/// One heading line and one table per trainee. Ends with a newline unless empty.
std::string summary_text(std::span<const TraineeSummary> trainees);

/// {"trainees": [{"id", "name" or null, "attempts": [{"id", "started_utc", "exercise",
/// "input_class", "ended", "completed", "valid", "forces_on", "metrics": {id: {"value", "unit",
/// "version", "felt"}}}]}]}
std::string summary_json(std::span<const TraineeSummary> trainees);

} // namespace tasks
