// tasks/exercise/progress.h
// What has happened in an attempt so far: events, and the counts from which the next ones follow.
// A fold over observations; live, headless, replay and re-score run the same one.
#pragma once

#include "tasks/exercise/exercise.h"

namespace tasks {

enum class EventKind : std::uint8_t { // numbers are part of the logbook: append only
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
    path_begun,
    path_left,
    order_broken,
    tube_found,
    tube_not_pointed, // in the picture as it should be, for long, and not pointed at
    tube_not_seen,    // pointed at, and not in the picture as it should be
};
inline constexpr EventKind kLastEventKind = EventKind::tube_not_seen;
std::string_view event_name(EventKind kind) noexcept;
bool is_error(EventKind kind) noexcept;

struct Event {
    std::int64_t tick = 0;
    EventKind kind{};
    std::int8_t tool = -1;
    std::int8_t target = -1;
    glm::dvec3 place_m{0.0};
    double value = 0.0; // newtons (contact_end: peak of the contact), seconds for out of view,
                        // metres for path_left and order_broken, seconds for tube_*
};

/// How well a path was followed, from its begin to its end; sums, so that the fold can stop
/// anywhere.
struct PathSums {
    std::int64_t begin_tick = -1;
    std::int64_t last_tick = -1;
    double done_m = 0.0, covered_m = 0.0; // followed in order; with the right force
    double length_m = 0.0;                // of the curve at rest
    std::int64_t ticks = 0, contact_ticks = 0, band_ticks = 0, inside_ticks = 0;
    double distance_m = 0.0, distance2_m2 = 0.0, farthest_m = 0.0; // over contact ticks
    int breaks = 0;
};

/// One tube of find-tubes.
struct TubeSearch {
    bool found = false;
    int good_ticks = 0, seen_ticks = 0; // seen and pointed at; seen only
    bool not_pointed = false;           // said, since it came into the picture
};

/// Running state of one attempt. observe() is the only thing that changes it.
struct Progress {
    int next = 0; // index of the target to touch now; of a path, of the point to pass now
    bool complete = false;
    std::int64_t first_move_tick = -1;
    std::int64_t complete_tick = -1;
    int held_ticks = 0;
    std::vector<Event> events;
    std::int64_t last_tick = -1; // a gap (pause) starts every count below anew
    // per tool: what an episode needs so that one mistake counts once
    struct Episode {
        bool touching = false, over = false, wrong = false, off = false, hidden = false;
        bool left = false, skipped = false; // of a path
        bool on_path = false;               // this contact has been on it
        bool started = false;               // first_tip_m is set
        bool was_seen = false;
        int free_ticks = 0; // since the last touch, while `touching` is still true
        int off_ticks = 0, wrong_ticks = 0, hidden_ticks = 0, left_ticks = 0, skipped_ticks = 0;
        int blind_ticks = 0, misused_ticks = 0; // at a tube: that is not seen; with another's tool
        bool blind = false, misused = false;
        double contact_peak_n = 0.0;
        glm::dvec3 hidden_from_m{0.0};
    };
    std::array<Episode, kTools> episode{};
    std::array<glm::dvec3, kTools> first_tip_m{};
    // follow-path
    PathSums path;
    double path_u = 0.0; // followed so far: number of the point, and the share of the way on
    bool following = false;
    int lost_ticks = 0;
    std::array<double, kMaxTargets> way_m{}; // along the curve to each point, as first seen
    // find-tubes; `next`: the first tube not found
    std::array<TubeSearch, kMaxTargets> tube{};
    int lifted_ticks = 0;                           // the lifting tool holds tissue
    double lifted_peak_n = 0.0, lifted_sum_n = 0.0; // with what force
};

/// Share of the exercise that is done, 0..1.
double share_done(const Progress& progress, const Exercise& exercise) noexcept;

/// Bit k: tube k is found.
std::uint32_t found_tubes(const Progress& progress) noexcept;

/// Share of what the next target needs, 0..1: of its holding time (of tubes: whichever is pointed
/// at), of the way to the next point.
double share_at_next(const Progress& progress, const Exercise& exercise) noexcept;

/// How far a touching tool is from a place: place against the line from tip centre to contact, m.
/// That line passes through the surface also where a coarse surface yields less than the tissue
/// under the tip does, so the distance is a distance along the surface.
double reach_m(const ToolObservation& tool, const glm::dvec3& place_m) noexcept;

/// One millisecond. Pure: progress after n calls depends on the n observations only, so a fold can
/// be stopped, copied and resumed anywhere. After completion nothing changes any more.
/// Allocates only when an event is appended; not for the 1 kHz thread.
void observe(Progress& progress, const Exercise& exercise, const Observation& seen);

/// The exercise's time is over without completion; the clock starts with the first movement.
bool timed_out(const Progress& progress, const Exercise& exercise) noexcept;

} // namespace tasks
