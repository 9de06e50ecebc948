// sim/session/session.h
// All parts of one attempt, put together once and run in one of three ways: lockstep (counted
// time, as fast as the machine can), real time (threads and deadlines), replay (a recorded
// schedule). All three call the same haptic_tick and tissue_step.
#pragma once

#include "sim/loop/stopwatch.h"
#include "sim/session/attempt.h"
#include "sim/session/crew.h"

#include <functional>

namespace sim {

struct RunOptions {
    std::string exercise = "touch-points"; // name or path of an exercise file
    std::string scene;                     // name, directory or path; empty: the exercise's own
    std::string hands = "expert";          // skill name or path of a script
    Coupling coupling = Coupling::anchored;
    std::string model{tissue::name_of(kUsualTier)}; // see sim/session/model_choice.h
    std::string model_why;                          // of --model auto, for the logbook
    int fem_hz = 100;
    std::uint64_t seed = 1;
    double max_seconds = 0.0; // 0: the exercise's own limit
    std::string trainee;      // id; empty: nobody
    bool noise = true;        // false: the hand makes no errors
    bool forces_on = true;
};

struct Session {
    RunOptions options;
    LoadedScene scene;
    tasks::Exercise exercise;
    std::string exercise_text;
    std::vector<tasks::Target> rest_targets;
    TargetPlaces rest_target_um{};
    bool recorded = false;       // into a logbook: the window says so
    bool keep_recording = false; // in the outcome: the window shows moments of it again
    TissueRig tissue;
    HapticRig haptics;
    Crew crew;
    std::unique_ptr<Exchange> exchange = std::make_unique<Exchange>();
    TickDurations tick_time{0.5};
    StepDurations step_time{20.0};
    std::int64_t max_ticks = 0;
    tasks::RigReport report;
    // what the tissue did worst, for the report
    double worst_linear_residual = 0.0;
    int warped_steps = 0, inverted_steps = 0;
    std::vector<ToolsNow>* poses = nullptr; // if set: what each FEM step saw is added
};

/// Loads and builds everything, and checks that every target can be done by its role. Throws with
/// file, line, key, value. `with_hands` false: no crew.
std::unique_ptr<Session> make_session(const RunOptions& options, bool with_hands = true);

/// A person at mouse and keyboard, in a session without hands: he has all three tools, in
/// find-tubes one of them and a scripted expert the others; a second expert has the endoscope if
/// the exercise wants an assistant there, else it stays where it was left.
void give_to_person(Session& session);
/// The tool that mouse and keys move at first.
inline constexpr int kFirstTool = static_cast<int>(tasks::Role::right);

/// The session that a recorded attempt was made in: same scene, exercise, rate and coupling, from
/// the texts in its row. `place`: the scene's directory; empty: the shipped one of that id. Throws
/// if the organs are not the ones it was made with. What could be done once is not checked again.
std::unique_ptr<Session> session_of(const tasks::AttemptRow& recorded,
                                    const std::string& place = {});

/// This build and machine. `input_class`: haptic, force-free, mouse or scripted.
tasks::SessionRow session_row(const std::string& input_class);

/// The attempt row that belongs to a session, and a fold over it.
tasks::AttemptRow attempt_row(const Session& session, bool realtime);

/// What the person at the tools sees after a tick.
tasks::HandSight sight_of(const Session& session, const tasks::TickTrace& trace, int next_target,
                          std::uint32_t found, bool done);

/// How far the fold is, for hands and screen.
ProgressNow progress_now(const Attempt& attempt, const tasks::Exercise& exercise);

/// One FEM step with bookkeeping and timing.
tasks::StepTrace run_step(Session& session, const ToolsNow& tools, TissueAnswer& answer);

/// Fills everything of session.report that follows from counters.
void fill_report(Session& session, std::int64_t ticks, bool realtime);

/// Runs to completion or the time limit on this thread, FEM steps on one beside it; bits are those
/// of one. `should_stop` is asked once a simulated second. Throws if there is no thread to be had.
Attempt::Outcome run_lockstep(Session& session, tasks::Logbook* logbook, std::int64_t attempt_id,
                              bool (*should_stop)() = nullptr);

/// Threads, deadlines, recorder. `seconds` 0: until the exercise ends. The caller's thread waits
/// in `while_running`, called about 60 times a second (draws, or sleeps), until it returns false.
Attempt::Outcome run_realtime(Session& session, tasks::Logbook* logbook, std::int64_t attempt_id,
                              double seconds, const std::function<bool(Exchange&)>& while_running);

/// Replays recorded ticks and schedule through the same functions; see sim/session/replay.cpp.
struct ReplayResult {
    Attempt::Outcome outcome;
    double worst_force_difference_n = 0.0;
    std::int64_t first_difference_tick = -1;
};
ReplayResult run_replay(Session& session, const tasks::AttemptRow& recorded,
                        const std::vector<tasks::Chunk>& chunks,
                        const std::vector<tasks::Event>& events);

} // namespace sim
