#include "tasks/exercise/follow_path.h"

#include "tasks/exercise/episodes.h"
#include "tasks/exercise/path_curve.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tasks {
namespace {

constexpr double kDimple_m = 15e-3;  // no press that counts is deeper
constexpr double kBack_m = 20e-3;    // behind what was followed: going back is no skipping
constexpr double kSkipped_m = 10e-3; // ahead of it: another part of the path
constexpr int kLost_ticks = 100;     // a shorter gap is no break
constexpr int kSkipped_ticks = 200;  // deliberate
constexpr double kDoneShare = 0.5;   // of the radius, before the last point

using Points = std::array<glm::dvec3, kMaxTargets>;

struct Curve {
    Points at;
    int count = 0;
    std::span<const glm::dvec3> points() const noexcept {
        return {at.data(), static_cast<std::size_t>(count)};
    }
    double end_u() const noexcept { return count - 1.0; }
};

Curve curve_of(const Observation& seen) {
    Curve curve;
    curve.count = seen.targets;
    for (std::size_t k = 0; k < static_cast<std::size_t>(seen.targets); ++k)
        curve.at[k] = seen.target[k].position_m;
    return curve;
}

// Ways along the curve are those of the first observation: the tissue at rest.
void measure_once(Progress& progress, const Curve& curve) {
    if (progress.path.length_m > 0.0)
        return;
    for (int k = 0; k < curve.count; ++k)
        progress.way_m[static_cast<std::size_t>(k)] = curve_length_m(curve.points(), k);
    progress.path.length_m = progress.way_m[static_cast<std::size_t>(curve.count - 1)];
}

double way_to_m(const Progress& progress, const Curve& curve, double u) {
    const int k = std::clamp(static_cast<int>(u), 0, curve.count - 2);
    const double from_m = progress.way_m[static_cast<std::size_t>(k)];
    const double to_m = progress.way_m[static_cast<std::size_t>(k) + 1];
    return from_m + (u - k) * (to_m - from_m);
}

// Out of the surface at the contact: where the force points, but for friction, which points along
// the path. All of it is recorded, so that a re-score needs no organ.
glm::dvec3 outward(const ToolObservation& tool) {
    constexpr double kClear_n = 20e-3; // recorded in millinewtons
    const glm::dvec3 lever = tool.tip_m - tool.contact_m;
    const glm::dvec3 way = glm::length(tool.force_n) > kClear_n ? tool.force_n : lever;
    const double length = glm::length(way);
    return length > 0.0 ? way / length : glm::dvec3{0.0};
}

// Distance along the surface: of the curve from the line through the contact, out of the surface. A
// tip lies in a dimple that the curve, drawn through points some millimetres apart, passes over.
NearCurve nearest(const Curve& curve, const ToolObservation& tool, double first, double last) {
    const glm::dvec3 up = kDimple_m * outward(tool);
    return nearest_on_curve(curve.points(), tool.contact_m - up, tool.contact_m + up, first, last);
}

bool in_band(const Exercise& exercise, const ToolObservation& tool) {
    const double force_n = glm::length(tool.force_n);
    return force_n >= exercise.force_min_n && force_n <= exercise.force_max_n;
}

// Tools whose turn it is not, and contacts that were never on the curve.
void note_strangers(Progress& progress, const Exercise& exercise, const Observation& seen,
                    const Curve& curve, int named) {
    for (int t = 0; t < kTools; ++t) {
        const ToolObservation& tool = seen.tool[t];
        if (!tool.present || !tool.touching)
            continue;
        Progress::Episode& episode = progress.episode[t];
        const double distance_m = nearest(curve, tool, 0.0, curve.end_u()).distance_m;
        const double force_n = glm::length(tool.force_n);
        note_while_touching(progress, seen, t, t != named && distance_m <= exercise.radius_m,
                            kWrongRole_ticks, episode.wrong_ticks, episode.wrong,
                            EventKind::wrong_role, force_n);
        note_while_touching(
            progress, seen, t, !episode.on_path && distance_m > exercise.radius_m + kOffTarget_m,
            kOffTarget_ticks, episode.off_ticks, episode.off, EventKind::off_target, force_n);
    }
}

// On the curve where its turn has come, or nothing.
struct Follow {
    bool inside = false; // touching, within the radius, in order
    double u = 0.0;
};

Follow follow_now(const Progress& progress, const Exercise& exercise, const Curve& curve,
                  const ToolObservation& tool) {
    if (!tool.touching)
        return {};
    const bool begun = progress.path.begin_tick >= 0;
    const double first = begun ? curve_step(curve.points(), progress.path_u, -kBack_m) : 0.0;
    const double last =
        curve_step(curve.points(), progress.path_u, begun ? kAhead_m : exercise.radius_m);
    const NearCurve near = nearest(curve, tool, first, last);
    return {near.distance_m <= exercise.radius_m, near.u};
}

// Leaving, and taking up the curve somewhere else.
void note_order(Progress& progress, const Exercise& exercise, const Observation& seen,
                const Curve& curve, int t, const Follow& follow) {
    const ToolObservation& tool = seen.tool[t];
    if (!tool.touching)
        return;
    Progress::Episode& episode = progress.episode[t];
    episode.on_path = episode.on_path || follow.inside;
    const NearCurve near = nearest(curve, tool, 0.0, curve.end_u());
    note_while_touching(progress, seen, t, episode.on_path && near.distance_m > exercise.radius_m,
                        kLost_ticks, episode.left_ticks, episode.left, EventKind::path_left,
                        near.distance_m);
    if (near.distance_m <= exercise.radius_m)
        episode.left = false; // back on it: leaving again is another mistake
    const double ahead_m =
        way_to_m(progress, curve, near.u) - way_to_m(progress, curve, progress.path_u);
    const bool skipped =
        !follow.inside && near.distance_m <= exercise.radius_m && ahead_m > kSkipped_m;
    if (skipped)
        episode.on_path = true; // it is on the path, only not where it should be
    note_while_touching(progress, seen, t, skipped, kSkipped_ticks, episode.skipped_ticks,
                        episode.skipped, EventKind::order_broken, ahead_m);
}

void note_break(Progress& progress, bool following) {
    if (following) {
        progress.lost_ticks = 0;
        progress.following = true;
    } else if (progress.following && ++progress.lost_ticks >= kLost_ticks) {
        progress.following = false;
        ++progress.path.breaks;
    }
}

void add_sums(Progress& progress, const Exercise& exercise, const Curve& curve,
              const Observation& seen, int t, const Follow& follow) {
    PathSums& sums = progress.path;
    const ToolObservation& tool = seen.tool[t];
    ++sums.ticks;
    sums.last_tick = seen.tick;
    if (!tool.touching)
        return;
    const double distance_m = nearest(curve, tool, 0.0, curve.end_u()).distance_m;
    ++sums.contact_ticks;
    sums.distance_m += distance_m;
    sums.distance2_m2 += distance_m * distance_m;
    sums.farthest_m = std::max(sums.farthest_m, distance_m);
    const bool band = in_band(exercise, tool);
    sums.band_ticks += band;
    sums.inside_ticks += band && follow.inside;
}

// On along the curve; what was passed with the right force is covered.
void follow_on(Progress& progress, const Curve& curve, double u, bool band) {
    if (u <= progress.path_u)
        return;
    PathSums& sums = progress.path;
    progress.path_u = u;
    const double done_m = way_to_m(progress, curve, u);
    sums.covered_m += band ? done_m - sums.done_m : 0.0;
    sums.done_m = done_m;
}

void complete(Progress& progress, const Observation& seen, int t) {
    progress.next = seen.targets;
    progress.complete = true;
    progress.complete_tick = seen.tick;
    append(progress, EventKind::completed, seen.tick, t, seen.tool[t].contact_m, 0.0);
    progress.events.back().target = -1;
}

// One tick of the tool that the path is for.
void advance_path(Progress& progress, const Exercise& exercise, const Curve& curve,
                  const Observation& seen, int t) {
    const ToolObservation& tool = seen.tool[t];
    const Follow follow = follow_now(progress, exercise, curve, tool);
    note_order(progress, exercise, seen, curve, t, follow);
    const bool band = in_band(exercise, tool);
    if (follow.inside && band && progress.path.begin_tick < 0) {
        progress.path.begin_tick = seen.tick;
        append(progress, EventKind::path_begun, seen.tick, t, tool.contact_m,
               glm::length(tool.force_n));
    }
    if (progress.path.begin_tick < 0)
        return;
    if (follow.inside)
        follow_on(progress, curve, follow.u, band);
    progress.next = std::min(static_cast<int>(progress.path_u) + 1, curve.count - 1);
    note_break(progress, follow.inside);
    add_sums(progress, exercise, curve, seen, t, follow);
    const double left_m = progress.path.length_m - progress.path.done_m;
    if (left_m <= kDoneShare * exercise.radius_m && band) {
        progress.path.done_m = progress.path.length_m;
        progress.path.covered_m += left_m;
        complete(progress, seen, t);
    }
}

} // namespace

void observe_path(Progress& progress, const Exercise& exercise, const Observation& seen) {
    note_tools(progress, exercise, seen);
    if (seen.targets < 2)
        return;
    const Curve curve = curve_of(seen);
    measure_once(progress, curve);
    const int t = static_cast<int>(exercise.target.front().role);
    if (seen.tool[t].present)
        advance_path(progress, exercise, curve, seen, t);
    if (!progress.complete)
        note_strangers(progress, exercise, seen, curve, t);
}

} // namespace tasks
