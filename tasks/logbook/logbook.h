// tasks/logbook/logbook.h
// One SQLite file per station (WAL): sessions, attempts, events, metrics, notes, traces. Names of
// trainees live in a second file beside it; here they are pseudonymous ids. A killed process
// loses at most the last second of the running attempt. The only file of tasks/ that opens
// anything. Not for the 1 kHz thread. Throws LogbookError; nothing is half-written.
#pragma once

#include "tasks/exercise/progress.h"
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
    std::vector<std::string> faults; // not empty: the score is not valid (the caller's rule)
};

struct AttemptRow {
    std::int64_t id = 0;
    std::int64_t session = 0;
    std::string trainee; // uuid; empty: anonymous
    std::string exercise, exercise_text, scene_text, scene_hash, model, coupling, hands;
    std::string model_why; // of a model chosen by the program: in plain words; not hashed
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
    /// Opens or creates. Refuses a newer schema ("made by a newer Trocar") and databases of another
    /// kind, leaving them unchanged; migrates an older schema, whole or not at all.
    explicit Logbook(const std::string& path);
    ~Logbook();
    Logbook(Logbook&&) noexcept;

    std::int64_t add_session(const SessionRow& session);
    /// Ids are never used twice. Fields that only the end knows (ended, completed, valid,
    /// log_sha256, rig) are not looked at. `trainee` is an id of add_trainee() or empty.
    std::int64_t begin_attempt(const AttemptRow& attempt);
    /// One durable transaction per call: this is the "at most one second" promise.
    void append_chunk(std::int64_t attempt, std::int64_t first_tick,
                      std::span<const std::byte> bytes);
    void append_events(std::int64_t attempt, std::span<const Event> events);
    /// Takes completed, valid, log_sha256 and rig from `result`. After it the attempt is closed:
    /// another chunk, event or end throws. An attempt whose process died stays with ended = false.
    void end_attempt(std::int64_t attempt, const AttemptRow& result,
                     std::span<const Metric> metrics);

    std::optional<AttemptRow> attempt(std::int64_t id);
    std::vector<AttemptRow> attempts();
    std::optional<SessionRow> session(std::int64_t id);
    /// In the order of their first ticks; events and metrics in the order they were given. A value
    /// that was NaN is a quiet NaN again, and -0 is 0.
    std::vector<std::vector<std::byte>> chunks(std::int64_t attempt);
    std::vector<Event> events(std::int64_t attempt);
    std::vector<Metric> metrics(std::int64_t attempt);

    std::int64_t add_note(std::int64_t attempt, std::int64_t tick, std::string_view text);
    struct Note {
        std::int64_t id, attempt, tick;
        std::string text, written_utc;
    };
    std::vector<Note> notes(std::int64_t attempt);

    /// Returns the uuid. A name is one line, and two trainees cannot have the same one.
    std::string add_trainee(std::string_view name);
    struct Trainee {
        std::string id, name;
        int attempts = 0;
    };
    std::vector<Trainee> trainees(); // by name; a deleted trainee is not listed
    /// Removes the name for ever (overwritten in the file; copies elsewhere and what people wrote
    /// into notes are not ours to reach); attempts stay under the pseudonym unless
    /// `with_attempts`. False: nothing was there to remove.
    bool delete_trainee(std::string_view id_or_name, bool with_attempts);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// SHA-256 over the canonical inputs, schedule, events and metrics of an attempt, so that a replay
/// can show that it is the same attempt. Ids, dates, durations, names of hands and what follows
/// from the inputs (forces, places, validity) are not in it.
///
/// Layout, for other implementations. Fields stand without padding, integers little-endian, two's
/// complement: u8 i8 i32 i64 u64; flag: u8, 0 or 1; text: u64 length in bytes, then the bytes
/// (UTF-8); f64: u64 with the IEEE 754 bits, where -0 is written as +0 and every NaN as
/// 0x7ff8000000000000 (what a database keeps of them). Five streams, each its own SHA-256, so that
/// it does not matter how calls for different streams interleave:
///   setup    text exercise, exercise_text, scene_text, scene_hash, model, coupling; u64 seed;
///            i32 fem_hz; flag forces_on; u64 number of start_counts, then 3 i64 each
///   ticks    each: i64 tick, i64 adopted_step; for each of the 3 tools: 3 i32 counts,
///            i32 roll_counts, i32 jaw_counts, u8 flags & 6 (2 present, 4 faulted); if the
///            endoscope is present: 3 i32 counts, i32 camera_counts, i32 optic_counts, u8 flags
///   steps    each: i64 step, i64 sample_tick, u8 flags & 1 (warped tangent used)
///   events   each: i64 tick, u8 kind (EventKind), i8 tool, i8 target, 3 f64 place_m, f64 value
///   metrics  each: text id, i32 version, f64 value, text unit, flag lower_is_better, flag felt,
///            i64 first_tick, i64 last_tick
/// The hash is SHA-256 of: the 13 bytes "trocar log 1" and a newline, then the five digests (32
/// bytes each) in this order; an empty stream has the digest of no bytes.
class LogHash {
  public:
    LogHash();
    ~LogHash();
    void add_setup(const AttemptRow& attempt);
    void add(const TickTrace& tick);
    void add(const StepTrace& step);
    void add(const Event& event);
    void add(const Metric& metric);
    std::string finish(); // 64 lower-case hex digits, of what was added so far

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tasks
