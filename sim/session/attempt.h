// sim/session/attempt.h
// One attempt at an exercise as a fold over its recorded ticks: progress, score, hash, logbook.
// The recorder thread feeds it in a live session, lockstep and replay feed it directly, re-score
// feeds it from the logbook: the same function every time. Not for the 1 kHz thread.
#pragma once

#include "sim/session/scene.h"
#include "tasks/logbook/logbook.h"
#include "tasks/score/moments.h"
#include "tasks/score/profile.h"

#include <deque>
#include <optional>

namespace sim {

class Attempt {
  public:
    /// `row`: the attempt's setup, as it is hashed and logged. `logbook` may be null; then nothing
    /// is kept. `row.id` must be set if there is one.
    Attempt(const Scene& scene, const tasks::Exercise& exercise,
            std::vector<tasks::Target> rest_targets, tasks::AttemptRow row,
            tasks::Logbook* logbook);

    /// What was recorded goes into the outcome too, compressed: 0.8 MB a minute.
    void keep_recording() { keep_ = true; }

    /// FEM steps arrive before the ticks that adopt them.
    void add(const tasks::StepTrace& step);
    void add(const tasks::TickTrace& tick);
    /// Pause, abandon, faults: events that do not follow from the ticks.
    void add_event(const tasks::Event& event);

    const tasks::Progress& progress() const { return progress_; }
    const tasks::Observation& seen() const { return seen_; }

    struct Outcome {
        tasks::AttemptRow row;
        std::vector<tasks::Metric> metrics;
        std::vector<tasks::Event> events;
        std::vector<tasks::ProfileRow> profile;     // against the exercise's levels
        std::vector<tasks::Moment> moments;         // the worst three
        std::vector<std::vector<std::byte>> chunks; // of keep_recording(), as in the logbook
    };
    /// Ends the attempt: score, hash, last chunk. `rig` decides with the progress if it is valid.
    Outcome finish(const tasks::RigReport& rig);

  private:
    void flush_chunk();
    void take_ideal_path(const tasks::StepTrace& first);

    tasks::Exercise exercise_;
    std::vector<tasks::Target> rest_targets_;
    HapticRig geometry_;
    tasks::AttemptRow row_;
    tasks::Logbook* logbook_;
    tasks::Progress progress_;
    tasks::ScoreState score_;
    tasks::ScoreContext context_;
    tasks::LogHash hash_;
    tasks::Observation seen_;
    TissueSeen tissue_;
    bool placed_ = false, keep_ = false;
    std::vector<std::vector<std::byte>> kept_;
    std::deque<tasks::StepTrace> waiting_; // steps that no tick has adopted yet
    std::vector<tasks::TickTrace> ticks_;  // of the running chunk
    std::vector<tasks::StepTrace> steps_;
    std::size_t events_logged_ = 0;
    double worst_step_mn_ = 0.0;
    std::vector<std::uint32_t> step_histogram_; // force steps per tick, 1 mN bins
    std::array<std::array<std::int32_t, 3>, kTools> last_force_mn_{};
};

} // namespace sim
