// tasks/logbook/logbook.cpp
// Sessions, attempts, chunks, events, metrics and notes in SQLite. Called by the recorder thread
// while an attempt runs and by the commands afterwards; never at 1 kHz. Trainees: trainees.cpp.
#include "tasks/logbook/logbook.h"

#include "tasks/logbook/logbook_impl.h"
#include "tasks/logbook/rig_report.h"
#include "tasks/logbook/schema.h"
#include "tasks/logbook/uuid.h"

#include <bit>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tasks {

using sqlite::Statement;
using sqlite::Transaction;

namespace {

constexpr std::string_view kAttemptColumns =
    "id, session, trainee, exercise, exercise_text, scene_text, scene_hash, model, coupling, "
    "hands, seed, fem_hz, realtime, completed, valid, ended, forces_on, started_utc, log_sha256, "
    "start_counts, rig, model_why";

AttemptRow read_attempt(const Statement& row) {
    AttemptRow attempt;
    int column = 0;
    const auto flag = [&] { return row.integer(column++) != 0; };
    attempt.id = row.integer(column++);
    attempt.session = row.integer(column++);
    for (std::string* text :
         {&attempt.trainee, &attempt.exercise, &attempt.exercise_text, &attempt.scene_text,
          &attempt.scene_hash, &attempt.model, &attempt.coupling, &attempt.hands})
        *text = row.text(column++);
    attempt.seed = std::bit_cast<std::uint64_t>(row.integer(column++));
    attempt.fem_hz = static_cast<int>(row.integer(column++));
    attempt.realtime = flag();
    attempt.completed = flag();
    attempt.valid = flag();
    attempt.ended = flag();
    attempt.forces_on = flag();
    attempt.started_utc = row.text(column++);
    attempt.log_sha256 = row.text(column++);
    attempt.start_counts =
        nlohmann::json::parse(row.text(column++)).get<decltype(attempt.start_counts)>();
    attempt.rig = parse_rig(row.text(column++));
    attempt.model_why = row.text(column++);
    return attempt;
}

// All rows of a statement; what cannot be read is reported with the file.
template <class Read>
auto read_all(const sqlite::Database& database, Statement& statement, std::string_view action,
              Read read) {
    std::vector<decltype(read(statement))> rows;
    try {
        while (statement.step())
            rows.push_back(read(statement));
    } catch (const std::invalid_argument& error) {
        database.refuse(action, error.what());
    } catch (const nlohmann::json::exception& error) {
        database.refuse(action, error.what());
    }
    return rows;
}

} // namespace

// synchronous = FULL: in WAL mode NORMAL already survives a killed process, because a commit has
// reached the kernel. FULL also waits until it is on the disk, so that a pulled plug loses no more
// than a kill does. It costs one fsync a second, in the recorder's thread.
Logbook::Impl::Impl(const std::string& path) : main(path) {
    migrate(main, kLogbookSchema); // before WAL: a file that is refused stays as it was
    if (main.text("PRAGMA journal_mode = WAL", "open") != "wal")
        main.refuse("open", "this file system cannot share a write-ahead log; use a local disk");
    main.run("PRAGMA synchronous = FULL", "open");
}

Logbook::Logbook(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
Logbook::~Logbook() = default;
Logbook::Logbook(Logbook&&) noexcept = default;

std::int64_t Logbook::add_session(const SessionRow& session) {
    Statement insert(impl_->main,
                     "INSERT INTO session (build, machine, blas, dispatch, input_class, "
                     "device_serials_hash) VALUES (?, ?, ?, ?, ?, ?)",
                     "add session");
    insert.arg(session.build).arg(session.machine).arg(session.blas).arg(session.dispatch);
    insert.arg(session.input_class).arg(session.device_serials_hash).run();
    return impl_->main.last_id();
}

std::int64_t Logbook::begin_attempt(const AttemptRow& attempt) {
    constexpr std::string_view kAction = "begin attempt";
    if (!attempt.trainee.empty() && !is_uuid(attempt.trainee))
        impl_->main.refuse(kAction,
                           "the trainee must be given by id, names stay in their own file");
    Statement insert(impl_->main,
                     "INSERT INTO attempt (session, trainee, exercise, exercise_text, scene_text, "
                     "scene_hash, model, coupling, hands, seed, fem_hz, realtime, forces_on, "
                     "started_utc, start_counts, model_why) "
                     "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                     kAction);
    insert.arg(attempt.session);
    if (attempt.trainee.empty())
        insert.arg_null();
    else
        insert.arg(attempt.trainee);
    insert.arg(attempt.exercise).arg(attempt.exercise_text);
    insert.arg(attempt.scene_text).arg(attempt.scene_hash);
    insert.arg(attempt.model).arg(attempt.coupling).arg(attempt.hands);
    insert.arg(attempt.seed).arg(attempt.fem_hz);
    insert.arg(attempt.realtime).arg(attempt.forces_on).arg(attempt.started_utc);
    insert.arg(nlohmann::json(attempt.start_counts).dump()).arg(attempt.model_why).run();
    return impl_->main.last_id();
}

void Logbook::append_chunk(std::int64_t attempt, std::int64_t first_tick,
                           std::span<const std::byte> bytes) {
    constexpr std::string_view kAction = "append chunk";
    Statement insert(impl_->main,
                     "INSERT INTO trace (attempt, first_tick, bytes) "
                     "SELECT id, ?, ? FROM attempt WHERE id = ? AND ended = 0",
                     kAction);
    insert.arg(first_tick).arg(bytes).arg(attempt).run();
    if (impl_->main.changes() != 1)
        impl_->main.refuse(kAction, fmt::format("no running attempt {}", attempt));
}

void Logbook::append_events(std::int64_t attempt, std::span<const Event> events) {
    constexpr std::string_view kAction = "append events";
    Transaction transaction(impl_->main, kAction);
    Statement insert(impl_->main,
                     "INSERT INTO event (attempt, tick, kind, tool, target, x_m, y_m, z_m, value) "
                     "SELECT id, ?, ?, ?, ?, ?, ?, ?, ? FROM attempt WHERE id = ? AND ended = 0",
                     kAction);
    for (const Event& event : events) {
        insert.arg(event.tick).arg(static_cast<int>(event.kind));
        insert.arg(event.tool).arg(event.target);
        insert.arg(event.place_m.x).arg(event.place_m.y).arg(event.place_m.z);
        insert.arg(event.value).arg(attempt).run();
        if (impl_->main.changes() != 1)
            impl_->main.refuse(kAction, fmt::format("no running attempt {}", attempt));
    }
    transaction.commit();
}

void Logbook::end_attempt(std::int64_t attempt, const AttemptRow& result,
                          std::span<const Metric> metrics) {
    constexpr std::string_view kAction = "end attempt";
    Transaction transaction(impl_->main, kAction);
    Statement update(impl_->main,
                     "UPDATE attempt SET ended = 1, completed = ?, valid = ?, log_sha256 = ?, "
                     "rig = ? WHERE id = ? AND ended = 0",
                     kAction);
    update.arg(result.completed).arg(result.valid).arg(result.log_sha256);
    update.arg(rig_json(result.rig)).arg(attempt).run();
    if (impl_->main.changes() != 1)
        impl_->main.refuse(kAction, fmt::format("no running attempt {}", attempt));
    Statement insert(impl_->main,
                     "INSERT INTO metric (attempt, id, version, value, unit, lower_is_better, "
                     "felt, first_tick, last_tick) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
                     kAction);
    for (const Metric& metric : metrics) {
        insert.arg(attempt).arg(metric.id).arg(metric.version).arg(metric.value);
        insert.arg(metric.unit).arg(metric.lower_is_better).arg(metric.felt);
        insert.arg(metric.first_tick).arg(metric.last_tick).run();
    }
    transaction.commit();
}

std::optional<AttemptRow> Logbook::attempt(std::int64_t id) {
    constexpr std::string_view kAction = "read attempt";
    Statement select(impl_->main,
                     fmt::format("SELECT {} FROM attempt WHERE id = ?", kAttemptColumns), kAction);
    const auto rows = read_all(impl_->main, select.arg(id), kAction, read_attempt);
    return rows.empty() ? std::nullopt : std::optional(rows.front());
}

std::vector<AttemptRow> Logbook::attempts() {
    constexpr std::string_view kAction = "list attempts";
    Statement select(impl_->main,
                     fmt::format("SELECT {} FROM attempt ORDER BY id", kAttemptColumns), kAction);
    return read_all(impl_->main, select, kAction, read_attempt);
}

std::optional<SessionRow> Logbook::session(std::int64_t id) {
    Statement select(impl_->main,
                     "SELECT build, machine, blas, dispatch, input_class, device_serials_hash "
                     "FROM session WHERE id = ?",
                     "read session");
    if (!select.arg(id).step())
        return std::nullopt;
    return SessionRow{select.text(0), select.text(1), select.text(2),
                      select.text(3), select.text(4), select.text(5)};
}

std::vector<std::vector<std::byte>> Logbook::chunks(std::int64_t attempt) {
    constexpr std::string_view kAction = "read trace";
    Statement select(impl_->main, "SELECT bytes FROM trace WHERE attempt = ? ORDER BY first_tick",
                     kAction);
    return read_all(impl_->main, select.arg(attempt), kAction,
                    [](const Statement& row) { return row.blob(0); });
}

std::vector<Event> Logbook::events(std::int64_t attempt) {
    constexpr std::string_view kAction = "read events";
    Statement select(impl_->main,
                     "SELECT tick, kind, tool, target, x_m, y_m, z_m, value FROM event "
                     "WHERE attempt = ? ORDER BY id",
                     kAction);
    return read_all(impl_->main, select.arg(attempt), kAction, [](const Statement& row) {
        const std::int64_t kind = row.integer(1);
        if (kind < 0 || kind > static_cast<std::int64_t>(kLastEventKind))
            throw std::invalid_argument(fmt::format("event kind {} is not known", kind));
        return Event{row.integer(0),
                     static_cast<EventKind>(kind),
                     static_cast<std::int8_t>(row.integer(2)),
                     static_cast<std::int8_t>(row.integer(3)),
                     {row.real(4), row.real(5), row.real(6)},
                     row.real(7)};
    });
}

std::vector<Metric> Logbook::metrics(std::int64_t attempt) {
    constexpr std::string_view kAction = "read metrics";
    Statement select(impl_->main,
                     "SELECT id, version, value, unit, lower_is_better, felt, first_tick, "
                     "last_tick FROM metric WHERE attempt = ? ORDER BY seq",
                     kAction);
    return read_all(impl_->main, select.arg(attempt), kAction, [](const Statement& row) {
        return Metric{row.text(0),         static_cast<int>(row.integer(1)),
                      row.real(2),         row.text(3),
                      row.integer(4) != 0, row.integer(5) != 0,
                      row.integer(6),      row.integer(7)};
    });
}

std::int64_t Logbook::add_note(std::int64_t attempt, std::int64_t tick, std::string_view text) {
    constexpr std::string_view kAction = "add note";
    Statement insert(
        impl_->main,
        "INSERT INTO note (attempt, tick, text) SELECT id, ?, ? FROM attempt WHERE id = ?",
        kAction);
    insert.arg(tick).arg(text).arg(attempt).run();
    if (impl_->main.changes() != 1)
        impl_->main.refuse(kAction, fmt::format("no attempt {}", attempt));
    return impl_->main.last_id();
}

std::vector<Logbook::Note> Logbook::notes(std::int64_t attempt) {
    constexpr std::string_view kAction = "read notes";
    Statement select(impl_->main,
                     "SELECT id, attempt, tick, text, written_utc FROM note WHERE attempt = ? "
                     "ORDER BY tick, id",
                     kAction);
    return read_all(impl_->main, select.arg(attempt), kAction, [](const Statement& row) {
        return Note{row.integer(0), row.integer(1), row.integer(2), row.text(3), row.text(4)};
    });
}

} // namespace tasks
