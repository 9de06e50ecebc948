#include "haptics/contact/safe_proxy.h"

#include "haptics/contact/path_planes.h"
#include "haptics/contact/proxy_parts.h"
#include "haptics/contact/ride_along.h"

namespace haptics {
namespace {

using glm::dvec3;

constexpr int kMostSteps = 3;   // straight ones in a tick
constexpr int kMostTouches = 6; // that turn one of them aside

struct Walk {
    const ProxyInput& in;
    double hover_m;    // this far off it rests,
    double touch_m;    // radius and half the hover: what a path has to keep
    double longest_m;  // step that the neighbourhood is good for
    double rounding_m; // of coordinates and their differences
    bool slid;         // in the last tick
};

// Planes of what the ball touches where it is, and of the nearest triangle, which will most likely
// hold it where it goes.
HoldingPlanes touching(const Neighbourhood& around, const Walk& walk,
                       const dvec3& centre_m) noexcept {
    HoldingPlanes out;
    if (around.count == 0)
        return out;
    const double rest_m = walk.in.radius_m + walk.hover_m, touching_m = rest_m + walk.hover_m;
    const auto end = around.near.begin() + around.count;
    const auto first = std::min_element(
        around.near.begin(), end,
        [](const NearTriangle& a, const NearTriangle& b) { return a.least_m < b.least_m; });
    int nearest = static_cast<int>(first - around.near.begin());
    TrianglePoint nearest_at = nearest_on_triangle(around.corner(nearest), centre_m);
    double nearest_m = std::sqrt(nearest_at.distance2_m2);
    if (nearest_m <= touching_m)
        out.add(first->triangle, around.corner(nearest), nearest_at, centre_m, rest_m);
    const int known = nearest;
    for (int i = 0; i < around.count; ++i) {
        if (around.near[i].least_m > std::max(nearest_m, touching_m) || i == known)
            continue;
        const TrianglePoint at = nearest_on_triangle(around.corner(i), centre_m);
        const double distance = std::sqrt(at.distance2_m2);
        if (distance <= touching_m)
            out.add(around.near[i].triangle, around.corner(i), at, centre_m, rest_m);
        if (distance < nearest_m) {
            nearest = i;
            nearest_at = at;
            nearest_m = distance;
        }
    }
    if (out.count == 0 && nearest_m <= rest_m + walk.longest_m)
        out.add(around.near[nearest].triangle, around.corner(nearest), nearest_at, centre_m,
                rest_m);
    return out;
}

// A triangle all of which lies behind a plane that both ends of the path keep cannot be met.
bool behind_a_plane(const HoldingPlanes& planes, const TriangleCorners& corner,
                    double touch_m) noexcept {
    for (int i = 0; i < planes.count; ++i) {
        const Plane& p = planes.plane[i];
        if (std::max({glm::dot(p.normal, corner[0]), glm::dot(p.normal, corner[1]),
                      glm::dot(p.normal, corner[2])}) <= p.offset_m - touch_m)
            return true;
    }
    return false;
}

// What a straight path of the centre meets.
struct Met {
    int index = -1; // in the neighbourhood; -1: nothing
    double time = 2.0;
    TrianglePoint at; // nearest to `centre_m`, from which a plane may be made
    dvec3 centre_m{0.0};
};

// Two ends in front of a plane that touches the triangle: nothing in between meets it. The plane's
// direction is off by the rounding of coordinates over the distance, which tells at the far end.
bool parts(const TrianglePoint& nearest, const dvec3& centre_m, const dvec3& other_m,
           const Walk& walk) noexcept {
    if (!(nearest.distance2_m2 >= walk.touch_m * walk.touch_m))
        return false;
    const dvec3 far = other_m - nearest.place_m;
    return glm::dot(centre_m - nearest.place_m, far) >=
           walk.touch_m * std::sqrt(nearest.distance2_m2) + walk.rounding_m * glm::length(far);
}

// If some triangles are in the way only at its end, and from the start a plane can be seen between,
// the one that is deepest there; else the first to be touched by the moving ball.
Met meets(const Neighbourhood& around, const Walk& walk, const HoldingPlanes& planes,
          const dvec3& looked_m, const dvec3& from_m, const dvec3& to_m) noexcept {
    Met first, deepest;
    const double off_m = std::max(glm::length(from_m - looked_m), glm::length(to_m - looked_m));
    double deepest2_m2 = walk.touch_m * walk.touch_m;
    for (int i = 0; i < around.count; ++i) {
        if (around.near[i].least_m > walk.touch_m + off_m)
            continue;
        const TriangleCorners corner = around.corner(i);
        if (behind_a_plane(planes, corner, walk.touch_m))
            continue;
        const TrianglePoint end = nearest_on_triangle(corner, to_m);
        if (parts(end, to_m, from_m, walk))
            continue;
        const TrianglePoint start = nearest_on_triangle(corner, from_m);
        if (parts(start, from_m, to_m, walk))
            continue;
        const dvec3 offset = to_m - end.place_m;
        if (end.distance2_m2 < walk.touch_m * walk.touch_m && end.distance2_m2 > 0.0 &&
            glm::dot(offset, from_m - end.place_m) >=
                (walk.touch_m + walk.hover_m) * std::sqrt(end.distance2_m2)) {
            if (end.distance2_m2 < deepest2_m2) {
                deepest2_m2 = end.distance2_m2;
                deepest = {i, 1.0, end, to_m};
            }
            continue;
        }
        const TriangleSweep sweep = sweep_ball({corner, corner}, from_m, to_m, walk.touch_m);
        if (sweep.time <= 1.0 && sweep.time < first.time)
            first = {i, sweep.time, sweep.on_triangle, from_m + sweep.time * (to_m - from_m)};
    }
    return first.index >= 0 ? first : deepest;
}

// How far along a path nothing is met.
double free_part(const Neighbourhood& around, const Walk& walk, const HoldingPlanes& planes,
                 const dvec3& from_m, const dvec3& to_m) noexcept {
    double time = 1.0;
    for (int i = 0; i < around.count; ++i)
        if (!behind_a_plane(planes, around.corner(i), walk.touch_m))
            time = std::min(
                time,
                sweep_ball({around.corner(i), around.corner(i)}, from_m, to_m, walk.touch_m).time);
    return time;
}

enum class Step { arrived, turned, shortened, blocked };

// One straight step of the centre, turned aside by what it would meet.
Step step(const Neighbourhood& around, const Walk& walk, const dvec3& looked_m,
          HoldingPlanes& planes, dvec3& centre_m, bool& sliding) noexcept {
    for (int touch = 0; touch <= kMostTouches; ++touch) {
        const PlaneSolution nearest = nearest_in_planes(
            std::span<const Plane>(planes.plane).first(planes.count), walk.in.device_m);
        if (!nearest.feasible)
            return Step::blocked; // held from all sides
        bool slides = sliding;
        const Friction friction{walk.in.static_friction, walk.in.dynamic_friction, walk.slid};
        const dvec3 wanted_m =
            nearest.actives > 0
                ? held_back(friction, std::span<const Plane>(planes.plane).first(planes.count),
                            0.25 * walk.hover_m, walk.in.device_m, centre_m, nearest.place_m,
                            slides)
                : nearest.place_m;
        const double way_m = glm::length(wanted_m - centre_m);
        const bool too_far = way_m > walk.longest_m;
        const dvec3 to_m =
            too_far ? centre_m + walk.longest_m / way_m * (wanted_m - centre_m) : wanted_m;
        const Met met = meets(around, walk, planes, looked_m, centre_m, to_m);
        if (met.index < 0) {
            centre_m = to_m;
            sliding = slides;
            return too_far ? Step::shortened : touch > 0 ? Step::turned : Step::arrived;
        }
        const int before = planes.count;
        planes.add(around.near[met.index].triangle, around.corner(met.index), met.at, met.centre_m,
                   walk.in.radius_m + walk.hover_m);
        if (planes.count == before || touch == kMostTouches) { // as far as it is free
            centre_m += free_part(around, walk, planes, centre_m, to_m) * (to_m - centre_m);
            sliding = slides;
            return Step::shortened;
        }
    }
    return Step::blocked;
}

void tell_contacts(const HoldingPlanes& planes, const ProxyInput& in, double hover_m,
                   ProxyState& state) noexcept {
    state.contacts = 0;
    for (int i = 0; i < planes.count && state.contacts < kMostProxyContacts; ++i) {
        const Plane& p = planes.plane[i];
        if (glm::dot(p.normal, state.proxy_m) - p.offset_m <= 2.0 * hover_m &&
            glm::dot(p.normal, in.device_m) < p.offset_m)
            state.contact[state.contacts++] = {planes.from[i].triangle, planes.from[i].weight,
                                               p.normal};
    }
    state.touching = state.contacts > 0;
    if (state.touching)
        state.witness = state.contact[0].triangle;
}

bool holds_back(const HoldingPlanes& planes, const dvec3& device_m) noexcept {
    for (int i = 0; i < planes.count; ++i)
        if (glm::dot(planes.plane[i].normal, device_m) < planes.plane[i].offset_m)
            return true;
    return false;
}

// To where the device pulls, as far as a tick allows.
// `most_m`: no farther in this tick, unless the straight way to the device is free: off a surface
// there is no force left.
void approach(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& in,
              double most_m, ProxyState& state) noexcept {
    const dvec3 start_m = state.proxy_m;
    const double pull_m = glm::length(in.device_m - start_m);
    // as far as the device, and a little for what has piled up; in the air all the way
    const double guess_m = state.touching ? 1.25 * glm::length(in.device_m - state.device_m) +
                                                0.25 * state.step_m + 0.002 * pull_m
                                          : pull_m;
    Walk walk{.in = in,
              .hover_m = state.hover_m,
              .touch_m = 0.0,
              .longest_m = std::min({guess_m, pull_m, most_m}),
              .rounding_m =
                  16.0 * std::numeric_limits<double>::epsilon() *
                  (std::abs(start_m.x) + std::abs(start_m.y) + std::abs(start_m.z) + pull_m),
              .slid = state.sliding};
    walk.touch_m = in.radius_m + 0.5 * walk.hover_m;
    const double least_m = in.radius_m + 3.0 * walk.hover_m;

    Neighbourhood around;
    HoldingPlanes planes;
    dvec3 looked_m = start_m;
    bool sliding = false, looked_far = false;
    double known_m = -1.0; // how far from `looked_m` the centre may be
    for (int i = 0; i < kMostSteps && most_m > 0.0; ++i) {
        walk.longest_m = std::min(walk.longest_m, most_m);
        const double gone_m = glm::length(state.proxy_m - looked_m);
        if (gone_m + 0.1 * walk.longest_m > known_m) {
            looked_m = state.proxy_m;
            look_around(index, mesh, looked_m, least_m + 1.1 * walk.longest_m, least_m, state.ring,
                        around);
            known_m = around.reach_m - least_m;
        }
        Walk now = walk;
        now.longest_m = std::min(walk.longest_m, known_m - glm::length(state.proxy_m - looked_m));
        planes = touching(around, now, state.proxy_m);
        if (!holds_back(planes, in.device_m) && !looked_far && walk.longest_m < pull_m) {
            looked_far = true;
            looked_m = state.proxy_m;
            const double way_m = glm::length(in.device_m - looked_m);
            look_around(index, mesh, looked_m, least_m + way_m, least_m, state.ring, around);
            known_m = around.reach_m - least_m;
            if (way_m <= known_m &&
                meets(around, walk, planes, looked_m, looked_m, in.device_m).index < 0) {
                state.proxy_m = in.device_m;
                break;
            }
        }
        const dvec3 from_m = state.proxy_m;
        const Step done = step(around, now, looked_m, planes, state.proxy_m, sliding);
        const double way_m = glm::length(state.proxy_m - from_m);
        most_m -= way_m;
        if (done == Step::blocked || done == Step::arrived || way_m <= walk.hover_m)
            break; // what turns with the surface on the way is left to the next tick
        if (done == Step::shortened)
            walk.longest_m = std::min(2.0 * walk.longest_m, pull_m);
    }
    state.sliding = sliding;
    state.step_m = glm::length(state.proxy_m - start_m);
    tell_contacts(planes, in, walk.hover_m, state);
}

} // namespace

void step_safe_proxy(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& in,
                     ProxyState& state) noexcept {
    state.force_n = dvec3{0.0};
    if (!finite(in) || !(in.radius_m >= 0.0))
        return;
    if (!state.started) {
        state = {};
        state.started = true;
        state.proxy_m = state.device_m = in.device_m;
        state.hover_m = hover_of(mesh, in);
    }
    const dvec3 start_m = state.proxy_m;
    if (!mesh.before_m.empty())
        ride_along(index, mesh, in, state);
    const double catch_up_m = in.stiffness_npm > 0.0 ? kCatchUp_n / in.stiffness_npm : 0.0;
    const double ridden_m = glm::length(state.proxy_m - start_m);
    approach(index, mesh, in,
             glm::length(in.device_m - state.device_m) +
                 std::max(catch_up_m - ridden_m, 0.2 * catch_up_m),
             state);
    state.device_m = in.device_m;
    state.sliding = state.sliding && state.touching;
    // also in the air, until it has caught up
    state.force_n = in.stiffness_npm * (state.proxy_m - in.device_m);
}

} // namespace haptics
