// tasks/logbook/schema.h
// The tables of the logbook and of the names file, as a list of steps from version to version.
// Used when a file is opened; outside the 1 kHz thread.
//
// A file's version is SQLite's user_version; its kind is application_id. Every step taken is also
// a row of the table `migration` (version, when), so that a file tells its own history. A shipped
// step is never edited: a change of the schema is a new step at the end of the list.
#pragma once

#include "tasks/logbook/sqlite.h"

namespace tasks {

struct Migration {
    int to = 0;      // the version after this step; steps stand in ascending order
    const char* sql; // runs inside the transaction of the whole migration
};

struct Schema {
    const char* what; // for messages: "logbook"
    std::int32_t application_id = 0;
    std::span<const Migration> steps;
    int version() const { return steps.empty() ? 0 : steps.back().to; }
};

extern const Schema kLogbookSchema;
extern const Schema kNamesSchema;

/// Brings a file to the newest version: all missing steps, or none. An empty file gets them all.
/// Throws LogbookError, with the file unchanged, when it is of another kind, made by a newer
/// Trocar, or a step fails.
void migrate(sqlite::Database& database, const Schema& schema);

} // namespace tasks
