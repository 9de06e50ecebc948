// tasks/logbook/schema.cpp
// The SQL of every schema version and the walk from one to the next; see schema.h.
#include "tasks/logbook/schema.h"

#include <fmt/format.h>

namespace tasks {
namespace {

// Attempt ids are never used twice (AUTOINCREMENT): notes on paper and exports name them.
// Numbers of enums (event.kind: EventKind) are part of the format: append only.
constexpr const char* kLogbook1 = R"sql(
CREATE TABLE session (
    id INTEGER PRIMARY KEY,
    build TEXT NOT NULL, machine TEXT NOT NULL, blas TEXT NOT NULL, dispatch TEXT NOT NULL,
    input_class TEXT NOT NULL
        CHECK (input_class IN ('haptic', 'force-free', 'mouse', 'scripted')),
    device_serials_hash TEXT NOT NULL
) STRICT;
CREATE TABLE attempt (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    session INTEGER NOT NULL REFERENCES session (id),
    trainee TEXT, -- pseudonym (UUID); NULL: anonymous
    exercise TEXT NOT NULL, exercise_text TEXT NOT NULL,
    scene_text TEXT NOT NULL, scene_hash TEXT NOT NULL,
    model TEXT NOT NULL, coupling TEXT NOT NULL, hands TEXT NOT NULL,
    seed INTEGER NOT NULL, -- the 64 bits of an unsigned number
    fem_hz INTEGER NOT NULL, realtime INTEGER NOT NULL, forces_on INTEGER NOT NULL,
    started_utc TEXT NOT NULL,
    start_counts TEXT NOT NULL, -- JSON: [[a, b, c] per tool]
    ended INTEGER NOT NULL DEFAULT 0, completed INTEGER NOT NULL DEFAULT 0,
    valid INTEGER NOT NULL DEFAULT 0,
    log_sha256 TEXT NOT NULL DEFAULT '',
    rig TEXT NOT NULL DEFAULT '{}' -- JSON, see rig_report.h
) STRICT;
CREATE INDEX attempt_by_trainee ON attempt (trainee);
CREATE TABLE trace (
    attempt INTEGER NOT NULL REFERENCES attempt (id) ON DELETE CASCADE,
    first_tick INTEGER NOT NULL,
    bytes BLOB NOT NULL, -- see trace.h
    UNIQUE (attempt, first_tick)
) STRICT;
CREATE TABLE event (
    id INTEGER PRIMARY KEY,
    attempt INTEGER NOT NULL REFERENCES attempt (id) ON DELETE CASCADE,
    tick INTEGER NOT NULL, kind INTEGER NOT NULL,
    tool INTEGER NOT NULL, target INTEGER NOT NULL,
    x_m REAL, y_m REAL, z_m REAL, value REAL -- NULL: not a number
) STRICT;
CREATE INDEX event_by_attempt ON event (attempt);
CREATE TABLE metric (
    seq INTEGER PRIMARY KEY,
    attempt INTEGER NOT NULL REFERENCES attempt (id) ON DELETE CASCADE,
    id TEXT NOT NULL, version INTEGER NOT NULL,
    value REAL, -- NULL: not a number
    unit TEXT NOT NULL, lower_is_better INTEGER NOT NULL, felt INTEGER NOT NULL,
    first_tick INTEGER NOT NULL, last_tick INTEGER NOT NULL,
    UNIQUE (attempt, id, version)
) STRICT;
CREATE TABLE note (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    attempt INTEGER NOT NULL REFERENCES attempt (id) ON DELETE CASCADE,
    tick INTEGER NOT NULL, text TEXT NOT NULL,
    written_utc TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%SZ', 'now'))
) STRICT;
CREATE INDEX note_by_attempt ON note (attempt);
)sql";

// Why `model` was taken, where the program chose it.
constexpr const char* kLogbook2 =
    "ALTER TABLE attempt ADD COLUMN model_why TEXT NOT NULL DEFAULT '';";

constexpr const char* kNames1 = R"sql(
CREATE TABLE trainee (id TEXT PRIMARY KEY NOT NULL, name TEXT NOT NULL UNIQUE) STRICT;
)sql";

constexpr Migration kLogbookSteps[] = {{1, kLogbook1}, {2, kLogbook2}};
constexpr Migration kNamesSteps[] = {{1, kNames1}};

constexpr std::int64_t kOursButUnset = 0;

// Throws unless the file is empty or of this kind, and not newer than this build. Returns its
// version.
int checked_version(sqlite::Database& database, const Schema& schema) {
    const auto action = "read the schema version";
    const std::int64_t version = database.integer("PRAGMA user_version", action);
    const std::int64_t kind = database.integer("PRAGMA application_id", action);
    const bool empty = database.integer("SELECT count(*) FROM sqlite_schema", action) == 0;
    if (kind != schema.application_id && !(empty && kind == kOursButUnset))
        database.refuse("open",
                        fmt::format("this is a database, but not a Trocar {}; nothing was changed",
                                    schema.what));
    if (version > schema.version())
        database.refuse("open",
                        fmt::format("made by a newer Trocar: schema {}, this build knows up to {}; "
                                    "open it with that release or a later one; nothing was changed",
                                    version, schema.version()));
    if (version < 0)
        database.refuse("open", fmt::format("schema version {} does not exist", version));
    return static_cast<int>(version);
}

} // namespace

// "TROC" and "TRON" as big-endian integers.
const Schema kLogbookSchema{"logbook", 0x54524f43, kLogbookSteps};
const Schema kNamesSchema{"names file", 0x54524f4e, kNamesSteps};

void migrate(sqlite::Database& database, const Schema& schema) {
    if (checked_version(database, schema) == schema.version())
        return;
    sqlite::Transaction transaction(database, "migrate");
    // Another process may have migrated while this one waited for the lock.
    const int from = checked_version(database, schema);
    database.run(fmt::format("PRAGMA application_id = {};"
                             "CREATE TABLE IF NOT EXISTS migration (version INTEGER PRIMARY KEY, "
                             "taken_utc TEXT NOT NULL) STRICT",
                             schema.application_id)
                     .c_str(),
                 "migrate");
    for (const Migration& step : schema.steps) {
        if (step.to <= from)
            continue;
        const std::string action = fmt::format("migrate to schema {}", step.to);
        database.run(step.sql, action);
        database.run(fmt::format("INSERT INTO migration VALUES ({0}, "
                                 "strftime('%Y-%m-%dT%H:%M:%SZ', 'now'));"
                                 "PRAGMA user_version = {0}",
                                 step.to)
                         .c_str(),
                     action);
    }
    transaction.commit();
}

} // namespace tasks
