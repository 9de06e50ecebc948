#include "haptics/contact/tool_ride.h"

#include "haptics/contact/proxy_parts.h"

namespace haptics {
namespace {

using glm::dvec3;

constexpr int kMostTouches = 12;
constexpr double kShortestPart = 1.0 / 64.0; // of the interval
constexpr double kLeastLever = 0.1; // nearer to the pivot tissue cannot turn a shaft out of its way

// What moves, as a tool that rides along sees it.
struct Passing {
    static constexpr int kRoom = 512;
    int count = 0;
    double fastest_m = 0.0; // way of any corner
    std::array<MovingTriangle, kRoom> path;
    std::array<double, kRoom> grown_m;
    std::array<std::array<double, 2>, kRoom> clear_m; // the tip may go before each part is met

    bool take(const ToolState& state, const MovingTriangle& moving, double grown,
              double beyond_m) noexcept {
        double way_m = 0.0;
        for (int k = 0; k < 3; ++k)
            way_m = std::max(way_m, glm::length(moving.after[k] - moving.before[k]));
        if (surely_far(state.shape, state.tip_m, moving.before,
                       thickest(state.shape) + grown + beyond_m + way_m))
            return true;
        std::array<double, 2> clear{HUGE_VAL, HUGE_VAL};
        for (const ToolPart part : kToolParts)
            if (has(state.shape, part))
                clear[static_cast<std::size_t>(part)] =
                    std::sqrt(part_to_triangle(state.shape, part, state.tip_m, moving.before)
                                  .on_triangle.distance2_m2) -
                    radius_of(state.shape, part) - grown - way_m;
        if (!(std::min(clear[0], clear[1]) <= beyond_m))
            return true;
        fastest_m = std::max(fastest_m, way_m);
        if (count == kRoom)
            return false;
        path[count] = moving;
        grown_m[count] = grown;
        clear_m[count++] = clear;
        return true;
    }
};

dvec3 point(const dvec3& weight, const TriangleCorners& c) noexcept {
    return weight.x * c[0] + weight.y * c[1] + weight.z * c[2];
}

// Where the tip would be at a time of the interval if the tool kept its place on what it leans on.
// A surface point at a lever that moves across the shaft turns it; along it, it takes it along.
struct Ride {
    const ToolState& state;
    int contacts = 0;
    std::array<MovingTriangle, kMostToolContacts> path;
    std::array<int, kMostToolContacts> from;

    Ride(const MeshView& mesh, const ToolState& of) noexcept : state(of) {
        for (int i = 0; i < of.contacts; ++i)
            if (of.contact[i].tool < 0) {
                const std::uint32_t t = of.contact[i].triangle;
                path[contacts] = {mesh.corners_before(t), mesh.corners(t)};
                from[contacts++] = i;
            }
    }
    dvec3 way(int i, double time) const noexcept {
        const ToolTouch& c = state.contact[from[i]];
        const TriangleCorners now = path[i].at(time);
        const dvec3 before_m = point(c.weight, path[i].before);
        const dvec3 way_m = point(c.weight, now) - before_m;
        if (c.part == ToolPart::tip) { // what it is off the surface turns with the face
            const dvec3 n = facing(path[i].before);
            return way_m + glm::dot(state.tip_m - before_m, n) * (facing(now) - n);
        }
        const dvec3 axis = state.tip_m - state.shape.pivot_m;
        const dvec3 along_m = glm::dot(way_m, axis) / glm::dot(axis, axis) * axis;
        return along_m + (way_m - along_m) / std::max(c.lever, kLeastLever);
    }
    dvec3 at(double time) const noexcept {
        dvec3 sum_m{0.0};
        for (int i = 0; i < contacts; ++i)
            sum_m += way(i, time);
        return contacts > 0 ? state.tip_m + sum_m / static_cast<double>(contacts) : state.tip_m;
    }
};

bool find(const CollisionIndex& index, const MeshView& mesh, const OtherTools& others,
          const ToolState& state, double beyond_m, Passing& out) noexcept {
    out.count = 0;
    out.fastest_m = 0.0;
    bool room = true;
    for (int i = 0; i < others.count; ++i) {
        const Obstacle& o = others.part[i];
        room = out.take(state, {o.corner, o.corner}, o.grown_m, beyond_m) && room;
    }
    Reach reach{state.shape.shaft_radius_m > 0.0 ? state.shape.pivot_m : state.tip_m, state.tip_m,
                thickest(state.shape) + beyond_m};
    std::visit(
        [&](const auto& method) {
            visit(method, reach, [&](std::uint32_t t) {
                room = out.take(state, {mesh.corners_before(t), mesh.corners(t)}, 0.0, beyond_m) &&
                       room;
            });
        },
        index);
    return room;
}

// The triangles that may come at a tool whose tip strays at most so far. What pushes it away may
// do so near the pivot. Returns how far it may stray.
double find_passing(const CollisionIndex& index, const MeshView& mesh, const OtherTools& others,
                    const ToolState& state, double way_m, Passing& out) noexcept {
    double beyond_m = way_m + 4.0 * state.hover_m;
    bool shrunk = false;
    for (int attempt = 0; attempt < 12; ++attempt) {
        const bool room = find(index, mesh, others, state, beyond_m, out);
        const double enough_m = way_m + 4.0 * (out.fastest_m + state.hover_m);
        if (room && (shrunk || enough_m <= beyond_m))
            break;
        shrunk = shrunk || !room;
        beyond_m = room ? enough_m : 0.5 * beyond_m;
    }
    return beyond_m;
}

struct Interval {
    double from, to; // within 0..1
};

struct Meeting {
    int index = -1;
    ToolPart part = ToolPart::tip;
    TriangleSweep sweep;
};

struct Passage {
    dvec3 end_m{0.0};
    bool free = false; // nothing met the tool on the way there
};

struct Crossing {
    const Passing& passing;
    const ToolShape& shape;
    dvec3 start_m; // from where the passing were found
    double hover_m;

    Meeting first_meeting(const Interval& time, const dvec3& from_m, const dvec3& to_m,
                          double off_surface_m) const noexcept {
        Meeting first;
        const double off_m =
            std::max(glm::length(from_m - start_m), glm::length(to_m - start_m)) + hover_m;
        for (int i = 0; i < passing.count; ++i)
            for (const ToolPart part : kToolParts) {
                if (passing.clear_m[i][static_cast<std::size_t>(part)] > off_m)
                    continue;
                const MovingTriangle path{passing.path[i].at(time.from),
                                          passing.path[i].at(time.to)};
                const TriangleSweep sweep =
                    sweep_part(shape, part, path, from_m, to_m,
                               radius_of(shape, part) + passing.grown_m[i] + off_surface_m);
                if (sweep.hit() && sweep.time < first.sweep.time)
                    first = {i, part, sweep};
            }
        return first;
    }

    // The tip's place from which a part, that met a triangle, is off it at the end: at the tip,
    // of all of the triangle; on the shaft, of the point met, by the lever's law.
    bool end_plane(const Meeting& met, const Interval& time, const dvec3& met_tip_m,
                   Plane& out) const noexcept {
        const double along = met.sweep.along;
        const dvec3 axis_m = shape.pivot_m + along * (met_tip_m - shape.pivot_m);
        const dvec3 off_m =
            (met.part == ToolPart::tip ? met_tip_m : axis_m) - met.sweep.on_triangle.place_m;
        const double length = glm::length(off_m);
        if (!(length > 0.0))
            return false;
        const dvec3 n = off_m / length;
        const TriangleCorners end = passing.path[met.index].at(time.to);
        const double rest_m = radius_of(shape, met.part) + passing.grown_m[met.index] + hover_m;
        if (met.part == ToolPart::tip || along >= 1.0) {
            out = {n, std::max({glm::dot(n, end[0]), glm::dot(n, end[1]), glm::dot(n, end[2])}) +
                          rest_m};
            return true;
        }
        const double pivot_m = glm::dot(n, shape.pivot_m);
        const double there_m = glm::dot(n, point(met.sweep.on_triangle.weight, end)) + rest_m;
        out = {n, pivot_m + (there_m - pivot_m) / std::max(along, kLeastLever)};
        return true;
    }

    // A sweep lets what closes slowly graze: the deepest in at the end.
    Meeting deepest(double time, const dvec3& tip_m) const noexcept {
        Meeting out;
        double least_m = 0.0;
        const double off_m = glm::length(tip_m - start_m) + hover_m;
        for (int i = 0; i < passing.count; ++i)
            for (const ToolPart part : kToolParts) {
                if (passing.clear_m[i][static_cast<std::size_t>(part)] > off_m)
                    continue;
                const SegmentPair pair =
                    part_to_triangle(shape, part, tip_m, passing.path[i].at(time));
                const double left_m = std::sqrt(pair.on_triangle.distance2_m2) -
                                      radius_of(shape, part) - passing.grown_m[i] - 0.05 * hover_m;
                if (left_m < least_m && pair.along > 0.0) {
                    least_m = left_m;
                    out = {i, part, {1.0, pair.on_triangle, pair.along}};
                }
            }
        return out;
    }

    // Through a part of the interval, out of the way of what is met. A shaft that is pushed turns
    // about its pivot, and the sweep, which separates along one direction where they touch, sees
    // the triangle close in on the pivot. Seen from a little farther off it turns as they do: so
    // after each touch a bit more of the hover is left.
    Passage pass(Interval time, dvec3 from_m, const dvec3& goal_m) const noexcept {
        std::array<Plane, kMostTouches> plane;
        std::size_t planes = 0;
        Passage out{goal_m, false};
        for (int touch = 0; touch < kMostTouches; ++touch) {
            const double off_m = (touch < 4 ? 0.5 - 0.1 * touch : 0.1) * hover_m;
            Meeting met = first_meeting(time, from_m, out.end_m, off_m);
            const bool graze = met.index < 0;
            if (graze)
                met = deepest(time.to, out.end_m);
            if (met.index < 0) {
                out.free = true;
                return out;
            }
            if (!graze) {
                from_m += met.sweep.time * (out.end_m - from_m);
                time.from += met.sweep.time * (time.to - time.from);
            }
            planes += end_plane(met, time, graze ? out.end_m : from_m, plane[planes]);
            out.end_m =
                nearest_in_planes(std::span<const Plane>(plane).first(planes), goal_m).place_m;
        }
        return out;
    }
};

} // namespace

void ride_along(const CollisionIndex& index, const MeshView& mesh, const OtherTools& others,
                ToolState& state) noexcept {
    const ToolState before = state;
    const Ride ride(mesh, before);
    Passing passing;
    const double stray_m = find_passing(index, mesh, others, before,
                                        glm::length(ride.at(1.0) - before.tip_m), passing);
    const Crossing crossing{passing, before.shape, before.tip_m, before.hover_m};
    double part = 1.0;
    for (Interval time{0.0, 1.0}; time.from < 1.0;
         time = {time.to, std::min(1.0, time.to + part)}) {
        Passage passage = crossing.pass(time, state.tip_m, ride.at(time.to));
        while (part > kShortestPart &&
               !(passage.free && glm::length(passage.end_m - before.tip_m) <= stray_m)) {
            part *= 0.5;
            time.to = std::min(1.0, time.from + part);
            passage = crossing.pass(time, state.tip_m, ride.at(time.to));
        }
        // if it is squeezed even so: where that is least, but not where nothing is known
        const dvec3 way_m = passage.end_m - before.tip_m;
        const double far_m = glm::length(way_m);
        state.tip_m = far_m > stray_m ? before.tip_m + stray_m / far_m * way_m : passage.end_m;
    }
}

} // namespace haptics
