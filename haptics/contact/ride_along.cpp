#include "haptics/contact/ride_along.h"

#include "haptics/contact/path_planes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptics {
namespace {

using glm::dvec3;

constexpr int kMostTouches = 12;

// Triangles that move, as a ball that rides along sees them.
struct Passing {
    static constexpr int kRoom = 256;
    int count = 0;
    std::array<std::uint32_t, kRoom> triangle;
    std::array<MovingTriangle, kRoom> path;
};

struct Ride {
    dvec3 way_m{0.0};       // of the surface that the ball leans on
    double longest_m = 0.0; // of any of its points
};

Ride ride_of(const MeshView& mesh, const ProxyState& state) noexcept {
    Ride ride;
    for (int i = 0; i < state.contacts; ++i) {
        const ProxyContact& contact = state.contact[i];
        const TriangleCorners now = mesh.corners(contact.triangle),
                              before = mesh.corners_before(contact.triangle);
        dvec3 way_m{0.0};
        for (int k = 0; k < 3; ++k)
            way_m += contact.weight[k] * (now[k] - before[k]);
        ride.way_m += way_m / static_cast<double>(state.contacts);
        ride.longest_m = std::max(ride.longest_m, glm::length(way_m));
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

void find_passing(const CollisionIndex& index, const MeshView& mesh, const dvec3& centre_m,
                  const dvec3& way_m, double reach_m, Passing& out) noexcept {
    Reach reach{centre_m, centre_m + way_m, reach_m};
    out.count = 0;
    std::visit(
        [&](const auto& method) {
            visit(method, reach, [&](std::uint32_t t) {
                const MovingTriangle path{mesh.corners_before(t), mesh.corners(t)};
                const double distance =
                    std::sqrt(nearest_on_triangle(path.before, centre_m).distance2_m2);
                if (!(distance <= reach_m + nears_m(path, way_m)) || out.count == Passing::kRoom)
                    return;
                for (int i = 0; i < out.count; ++i)
                    if (out.triangle[i] == t)
                        return;
                out.triangle[out.count] = t;
                out.path[out.count++] = path;
            });
        },
        index);
}

// The plane through which a triangle with this normal may not push at the end of the interval.
Plane end_plane(const MovingTriangle& path, const dvec3& normal, double radius_m) noexcept {
    double farthest = glm::dot(normal, path.after[0]);
    for (int k = 1; k < 3; ++k)
        farthest = std::max(farthest, glm::dot(normal, path.after[k]));
    return {normal, farthest + radius_m};
}

struct Meeting {
    int index = -1;
    double time = 2.0;
    dvec3 normal{0.0};
};

// The first of the passing triangles to touch a ball that goes from `from_m`, at `start`, evenly to
// `to_m`, at 1.
Meeting first_meeting(const Passing& passing, double start, const dvec3& from_m, const dvec3& to_m,
                      double radius_m) noexcept {
    Meeting first;
    for (int i = 0; i < passing.count; ++i) {
        const MovingTriangle rest{passing.path[i].at(start), passing.path[i].after};
        const TriangleSweep sweep = sweep_ball(rest, from_m, to_m, radius_m);
        if (!(sweep.time <= 1.0) || !(sweep.time < first.time))
            continue;
        const dvec3 n = from_m + sweep.time * (to_m - from_m) - sweep.on_triangle.place_m;
        const double length = glm::length(n);
        if (length > 0.0)
            first = {i, sweep.time, n / length};
    }
    return first;
}

} // namespace

void ride_along(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& in,
                ProxyState& state) noexcept {
    const Ride ride = ride_of(mesh, state);
    const double hover =
        hover_m(state.proxy_m, in.radius_m,
                std::max(ride.longest_m, glm::length(in.device_m - state.proxy_m)));
    const double rest_m = in.radius_m + hover, touch_m = in.radius_m + 0.5 * hover;
    Passing passing;
    find_passing(index, mesh, state.proxy_m, ride.way_m,
                 in.radius_m + 2.0 * (ride.longest_m + hover), passing);

    const dvec3 goal_m = state.proxy_m + ride.way_m;
    std::array<Plane, 2 * kMostTouches> plane;
    int planes = 0;
    dvec3 from_m = state.proxy_m, to_m = goal_m;
    double start = 0.0;
    for (int touch = 0; touch < kMostTouches; ++touch) {
        const Meeting met = first_meeting(passing, start, from_m, to_m, touch_m);
        if (met.index < 0)
            break;
        from_m += met.time * (to_m - from_m);
        start += met.time * (1.0 - start);
        plane[planes++] = end_plane(passing.path[met.index], met.normal, rest_m);
        const PlaneSolution nearest =
            nearest_in_planes(std::span<const Plane>(plane).first(planes), goal_m);
        to_m = nearest.place_m; // if it is squeezed, where that is least
    }
    state.proxy_m = to_m;
}

} // namespace haptics
