// tasks/exercise/touch_points.h
// Touch numbered points on the tissue in order, each with its role, gently and long enough.
// Touched: the named tool's tip is within `radius_m` of the target, contact force inside the band,
// without a break, for `hold_s`. The tip counts as the line from the centre of its sphere to where
// it touches: that line passes through the surface also where a coarse surface yields less than
// the tissue under the tip does, so the distance is a distance along the surface.
// Tool index = role index. Called by sim, live and headless, and by every re-score.
#pragma once

#include "tasks/exercise/observation.h"

#include <string>
#include <vector>

namespace tasks {

struct TouchTarget {
    std::string id;
    Role role = Role::right;
    glm::dvec3 at_m{0.0}; // rest place near the surface; the scene snaps it on
    std::string organ{};  // whose surface; empty: the nearest
};

struct TouchPoints { // from assets/exercises/*.toml
    std::string id = "touch-points";
    std::string title, card; // for people: name and instructions
    std::vector<TouchTarget> target;
    double radius_m = 3e-3;
    double force_min_n = 0.1;
    double force_max_n = 1.0;
    double hold_s = 0.3;
    double force_limit_n = 2.0;  // an error above
    double time_limit_s = 180.0; // the attempt ends incomplete
};

/// Bytes of an exercise file. Throws std::invalid_argument with file, line, key, value and what
/// would be accepted; unknown keys are errors. `file` is only for messages. Not real-time safe.
TouchPoints parse_touch_points(std::string_view text, std::string_view file);

enum class EventKind : std::uint8_t {
    target_touched,
    wrong_role,
    over_force,
    off_target,
    out_of_view,
    contact_begin,
    contact_end,
    paused,
    resumed,
    abandoned,
    completed,
    rig_fault,
};
std::string_view event_name(EventKind kind) noexcept;
bool is_error(EventKind kind) noexcept;

struct Event {
    std::int64_t tick = 0;
    EventKind kind{};
    std::int8_t tool = -1;
    std::int8_t target = -1;
    glm::dvec3 place_m{0.0};
    double value = 0.0; // newtons (contact_end: peak of the contact), seconds for out of view
};

/// Running state of one attempt. observe() is the only thing that changes it.
struct TouchProgress {
    int next = 0; // index of the target to touch now
    bool complete = false;
    std::int64_t first_move_tick = -1;
    std::int64_t complete_tick = -1;
    int held_ticks = 0;
    std::vector<Event> events;
    std::int64_t last_tick = -1; // a gap (pause) starts every count below anew
    // per tool: what an episode needs so that one mistake counts once
    struct Episode {
        bool touching = false, over = false, wrong = false, off = false, hidden = false;
        bool started = false; // first_tip_m is set
        bool was_seen = false;
        int free_ticks = 0; // since the last touch, while `touching` is still true
        int off_ticks = 0, wrong_ticks = 0, hidden_ticks = 0;
        double contact_peak_n = 0.0;
        glm::dvec3 hidden_from_m{0.0};
    };
    std::array<Episode, kTools> episode{};
    std::array<glm::dvec3, kTools> first_tip_m{};
};

/// How far a touching tool is from a place: place against the line from tip centre to contact, m.
double reach_m(const ToolObservation& tool, const glm::dvec3& place_m) noexcept;

/// One millisecond. Pure: progress after n calls depends on the n observations only, so a fold can
/// be stopped, copied and resumed anywhere. After completion nothing changes any more.
/// Allocates only when an event is appended; not for the 1 kHz thread.
void observe(TouchProgress& progress, const TouchPoints& exercise, const Observation& seen);

/// The exercise's time is over without completion; the clock starts with the first movement.
bool timed_out(const TouchProgress& progress, const TouchPoints& exercise) noexcept;

} // namespace tasks
