// tasks/logbook/logbook.h
// One SQLite file per station (WAL): sessions, attempts, events, metrics, notes, traces. Names of
// trainees live in a second file beside it; here they are pseudonymous ids. A killed process
// loses at most the last second of the running attempt. The only file of tasks/ that opens
// anything. Not for the 1 kHz thread. Throws LogbookError; nothing is half-written.
#pragma once

#include "tasks/exercise/touch_points.h"
#include "tasks/logbook/trace.h"
#include "tasks/score/metrics.h"

#include <memory>
#include <optional>
#include <stdexcept>

namespace tasks {

struct LogbookError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct SessionRow { // the machine and build an attempt was made with
    std::string build, machine, blas, dispatch,
        input_class; // haptic | force-free | mouse | scripted
    std::string device_serials_hash;
};

struct RigReport {
    double tick_us_p50 = 0, tick_us_p99 = 0, tick_us_p9999 = 0, tick_us_max = 0;
    double fem_ms_p50 = 0, fem_ms_p99 = 0, fem_ms_max = 0;
    std::int64_t missed = 0, dropped = 0;
    double force_step_mn_p999 = 0, force_step_mn_max = 0, energy_min_j = 0;
    std::vector<std::string> faults; // not empty: the score is not valid
};

struct AttemptRow {
    std::int64_t id = 0;
    std::int64_t session = 0;
    std::string trainee; // uuid; empty: anonymous
    std::string exercise, exercise_text, scene_text, scene_hash, model, coupling, hands;
    std::uint64_t seed = 0;
    int fem_hz = 0;
    bool realtime = false, completed = false, valid = false, ended = false, forces_on = true;
    std::string started_utc;
    std::string log_sha256;
    std::vector<std::array<std::int64_t, 3>> start_counts; // per tool
    RigReport rig;
};

class Logbook {
  public:
    /// Opens or creates. Refuses a newer schema ("made by a newer Trocar"), migrates an older one.
    explicit Logbook(const std::string& path);
    ~Logbook();
    Logbook(Logbook&&) noexcept;

    std::int64_t add_session(const SessionRow& session);
    std::int64_t begin_attempt(const AttemptRow& attempt);
    /// One durable transaction per call: this is the "at most one second" promise.
    void append_chunk(std::int64_t attempt, std::int64_t first_tick,
                      std::span<const std::byte> bytes);
    void append_events(std::int64_t attempt, std::span<const Event> events);
    void end_attempt(std::int64_t attempt, const AttemptRow& result,
                     std::span<const Metric> metrics);

    std::optional<AttemptRow> attempt(std::int64_t id);
    std::vector<AttemptRow> attempts();
    std::optional<SessionRow> session(std::int64_t id);
    std::vector<std::vector<std::byte>> chunks(std::int64_t attempt);
    std::vector<Event> events(std::int64_t attempt);
    std::vector<Metric> metrics(std::int64_t attempt);

    std::int64_t add_note(std::int64_t attempt, std::int64_t tick, std::string_view text);
    struct Note {
        std::int64_t id, attempt, tick;
        std::string text, written_utc;
    };
    std::vector<Note> notes(std::int64_t attempt);

    std::string add_trainee(std::string_view name); // returns the uuid
    struct Trainee {
        std::string id, name;
        int attempts = 0;
    };
    std::vector<Trainee> trainees();
    /// Removes the name for ever; attempts stay under the pseudonym unless `with_attempts`.
    bool delete_trainee(std::string_view id_or_name, bool with_attempts);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// SHA-256, lower-case hex, over canonical inputs (exercise, scene, seed, rates, coupling, start),
/// ticks (counts, faults), schedule, events and metrics. Ids, dates and durations are not in it.
class LogHash {
  public:
    LogHash();
    ~LogHash();
    void add_setup(const AttemptRow& attempt);
    void add(const TickTrace& tick);
    void add(const StepTrace& step);
    void add(const Event& event);
    void add(const Metric& metric);
    std::string finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tasks
