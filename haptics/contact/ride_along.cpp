#include "haptics/contact/ride_along.h"

#include "haptics/contact/path_planes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptics {
namespace {

using glm::dvec3;

constexpr int kMostTouches = 12;
constexpr double kShortestPart = 1.0 / 64.0; // of the interval

// Triangles that move, as a ball that rides along sees them.
struct Passing {
    static constexpr int kRoom = 256;
    int count = 0;
    std::array<std::uint32_t, kRoom> triangle;
    std::array<MovingTriangle, kRoom> path;
    std::array<double, kRoom> least_m; // they may come as near as this to the ball
    double fastest_m = 0.0;            // what any of them comes nearer by
    double known_m = 0.0;              // what is not among them stays farther
};

// Where the ball would be at a time of the interval if it kept its place on what it leans on: the
// surface points go with their triangles, what it is off them turns with their normals.
struct Ride {
    dvec3 start_m{0.0};
    int contacts = 0;
    std::array<MovingTriangle, kMostProxyContacts> path;
    std::array<dvec3, kMostProxyContacts> weight;
    double longest_m = 0.0; // way of any of them

    static dvec3 normal(const TriangleCorners& c) noexcept {
        const dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
        const double length = glm::length(n);
        return length > 0.0 ? n / length : dvec3{0.0};
    }
    dvec3 point(int i, const TriangleCorners& c) const noexcept {
        return weight[i].x * c[0] + weight[i].y * c[1] + weight[i].z * c[2];
    }
    dvec3 at(double time) const noexcept {
        dvec3 way_m{0.0};
        for (int i = 0; i < contacts; ++i) {
            const TriangleCorners now = path[i].at(time);
            const dvec3 before_m = point(i, path[i].before), n = normal(path[i].before);
            way_m += point(i, now) - before_m + glm::dot(start_m - before_m, n) * (normal(now) - n);
        }
        return contacts > 0 ? start_m + way_m / static_cast<double>(contacts) : start_m;
    }
};

Ride ride_of(const MeshView& mesh, const ProxyState& state) noexcept {
    Ride ride{.start_m = state.proxy_m, .contacts = state.contacts, .path = {}, .weight = {}};
    for (int i = 0; i < state.contacts; ++i) {
        const std::uint32_t t = state.contact[i].triangle;
        ride.path[i] = {mesh.corners_before(t), mesh.corners(t)};
        ride.weight[i] = state.contact[i].weight;
        ride.longest_m = std::max(ride.longest_m, glm::length(ride.point(i, ride.path[i].after) -
                                                              ride.point(i, ride.path[i].before)));
    }
    return ride;
}

// How much nearer a triangle can come to a ball that rides along.
double nears_m(const MovingTriangle& t, const dvec3& way_m) noexcept {
    double out = 0.0;
    for (int k = 0; k < 3; ++k)
        out = std::max(out, glm::length(t.after[k] - t.before[k] - way_m));
    return out;
}

// Those that can come within `reach_m` of a ball that rides along. If there are more than there is
// room for, the ones that can come nearest.
void find_passing(const CollisionIndex& index, const MeshView& mesh, const dvec3& centre_m,
                  const dvec3& way_m, double reach_m, Passing& out) noexcept {
    Reach reach{centre_m, centre_m + way_m, reach_m};
    out.count = 0;
    out.fastest_m = 0.0;
    out.known_m = reach_m;
    const auto put = [&](int at, std::uint32_t t, const MovingTriangle& path, double least_m) {
        out.triangle[at] = t;
        out.path[at] = path;
        out.least_m[at] = least_m;
    };
    std::visit(
        [&](const auto& method) {
            visit(method, reach, [&](std::uint32_t t) {
                const MovingTriangle path{mesh.corners_before(t), mesh.corners(t)};
                const double nears = nears_m(path, way_m);
                const double least_m =
                    std::sqrt(nearest_on_triangle(path.before, centre_m).distance2_m2) - nears;
                if (!(least_m <= out.known_m))
                    return;
                for (int i = 0; i < out.count; ++i)
                    if (out.triangle[i] == t)
                        return;
                out.fastest_m = std::max(out.fastest_m, nears);
                if (out.count < Passing::kRoom) {
                    put(out.count++, t, path, least_m);
                    return;
                }
                const auto last = std::max_element(out.least_m.begin(), out.least_m.end());
                out.known_m = std::max(least_m, *last); // of the one that is left out
                if (least_m < *last) {
                    out.known_m = *last;
                    put(static_cast<int>(last - out.least_m.begin()), t, path, least_m);
                }
            });
        },
        index);
}

// Through this plane a triangle with a given normal does not push until `time`: its farthest corner
// comes no farther than evenly from where it is now.
Plane end_plane(const MovingTriangle& path, double time, const dvec3& normal,
                double radius_m) noexcept {
    const TriangleCorners end = path.at(time);
    return {normal, std::max({glm::dot(normal, end[0]), glm::dot(normal, end[1]),
                              glm::dot(normal, end[2])}) +
                        radius_m};
}

struct Meeting {
    int index = -1;
    double along = 2.0; // of the path, 0..1
    dvec3 normal{0.0};
};

struct Interval {
    double from, to; // within 0..1
};

// The first of the passing triangles to touch a ball that goes evenly between two places.
Meeting first_meeting(const Passing& passing, const Interval& time, const dvec3& from_m,
                      const dvec3& to_m, double radius_m) noexcept {
    Meeting first;
    for (int i = 0; i < passing.count; ++i) {
        const MovingTriangle part{passing.path[i].at(time.from), passing.path[i].at(time.to)};
        const TriangleSweep sweep = sweep_ball(part, from_m, to_m, radius_m);
        if (!(sweep.time <= 1.0) || !(sweep.time < first.along))
            continue;
        const dvec3 n = from_m + sweep.time * (to_m - from_m) - sweep.on_triangle.place_m;
        const double length = glm::length(n);
        if (length > 0.0)
            first = {i, sweep.time, n / length};
    }
    return first;
}

struct Passage {
    dvec3 end_m{0.0};
    bool free = false; // nothing met the ball on the way there
};

// The planes of faces that the ball is close in front of: it is to be in front of them at the end
// as well. A path that keeps both ends is nearly sure to be free, and is looked at anyway.
int face_planes(const Passing& passing, const Interval& time, const dvec3& from_m, double rest_m,
                double hover_m, std::span<Plane> out) noexcept {
    int planes = 0;
    for (int i = 0; i < passing.count && planes < static_cast<int>(out.size()); ++i) {
        const TriangleCorners start = passing.path[i].at(time.from);
        const double near_m = rest_m + 3.0 * hover_m;
        if (!(nearest_on_triangle(start, from_m).distance2_m2 <= near_m * near_m))
            continue;
        const dvec3 n = Ride::normal(start);
        const double height_m = glm::dot(n, from_m - start[0]);
        if (std::abs(height_m) < rest_m - 0.9 * hover_m)
            continue; // beside an edge
        const dvec3 out_n =
            (height_m > 0.0 ? 1.0 : -1.0) * Ride::normal(passing.path[i].at(time.to));
        if (out_n != dvec3{0.0})
            out[planes++] = end_plane(passing.path[i], time.to, out_n, rest_m);
    }
    return planes;
}

// Through a part of the interval, out of the way of what is met. Planes with normals of their first
// touch give way to a triangle that turns by more than it needs: for short parts only.
Passage pass(const Passing& passing, const Ride& ride, Interval time, dvec3 from_m, double rest_m,
             double hover_m) noexcept {
    const dvec3 goal_m = ride.at(time.to);
    const double touch_m = rest_m - 0.5 * hover_m;
    std::array<Plane, 2 * kMostTouches> plane;
    int planes = face_planes(passing, time, from_m, rest_m, hover_m,
                             std::span<Plane>(plane).first(kMostTouches));
    const auto nearest = [&] {
        return nearest_in_planes(std::span<const Plane>(plane).first(planes), goal_m).place_m;
    };
    Passage out{nearest(), false};
    for (int touch = 0; touch < kMostTouches; ++touch) {
        const Meeting met = first_meeting(passing, time, from_m, out.end_m, touch_m);
        if (met.index < 0) {
            out.free = true;
            return out;
        }
        from_m += met.along * (out.end_m - from_m);
        time.from += met.along * (time.to - time.from);
        plane[planes++] = end_plane(passing.path[met.index], time.to, met.normal, rest_m);
        out.end_m = nearest();
    }
    return out;
}

} // namespace

void ride_along(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& in,
                ProxyState& state) noexcept {
    const Ride ride = ride_of(mesh, state);
    const double hover = state.hover_m;
    const double rest_m = in.radius_m + hover;
    const dvec3 way_m = ride.at(1.0) - ride.start_m;
    // a ball pushed aside strays from the way: by as much as it is pushed, and somewhat more
    Passing passing;
    find_passing(index, mesh, state.proxy_m, way_m, rest_m + ride.longest_m + 4.0 * hover, passing);
    const double stray_m = ride.longest_m + passing.fastest_m + 4.0 * hover;
    find_passing(index, mesh, state.proxy_m, way_m, rest_m + stray_m, passing);
    const double most_m =
        std::min(0.5 * stray_m + 0.5 * passing.fastest_m, std::max(passing.known_m - rest_m, 0.0));

    double part = 1.0;
    for (Interval time{0.0, 1.0}; time.from < 1.0;
         time = {time.to, std::min(1.0, time.to + part)}) {
        Passage passage = pass(passing, ride, time, state.proxy_m, rest_m, hover);
        while (part > kShortestPart &&
               !(passage.free && glm::length(passage.end_m - ride.at(time.to)) <= most_m)) {
            part *= 0.5;
            time.to = std::min(1.0, time.from + part);
            passage = pass(passing, ride, time, state.proxy_m, rest_m, hover);
        }
        state.proxy_m = passage.end_m; // if it is squeezed even so: where that is least
    }
}

} // namespace haptics
