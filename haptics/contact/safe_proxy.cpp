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

// The nearest triangle of all, beyond touch.
int nearest_of(const NearLeaves& around, const dvec3& centre_m, TrianglePoint& at) noexcept {
    int nearest = nearest_place(around);
    if (nearest < 0)
        return nearest;
    const double off_m = glm::length(centre_m - around.centre_m);
    at = nearest_on_triangle(around.corner(nearest), centre_m);
    for (int i = 0; i < around.count; ++i) {
        const float bound = around.bound(std::sqrt(at.distance2_m2) + off_m);
        for (int lane = 0; lane < NearLeaves::kWidth && around.least_of_leaf[i] <= bound; ++lane) {
            const int place = i * NearLeaves::kWidth + lane;
            if (!(around.least(place) <= bound) || place == nearest)
                continue;
            const TrianglePoint other = nearest_on_triangle(around.corner(place), centre_m);
            if (!(other.distance2_m2 < at.distance2_m2))
                continue;
            nearest = place;
            at = other;
        }
    }
    return nearest;
}

// Planes of what the ball touches where it is; or of the nearest triangle, which will most likely
// hold it where it goes.
void touching(const NearLeaves& around, const Walk& walk, const dvec3& centre_m,
              HoldingPlanes& out) noexcept {
    out.count = 0;
    const double rest_m = walk.in.radius_m + walk.hover_m, touching_m = rest_m + walk.hover_m;
    Places place;
    const int count = centre_m == around.centre_m
                          ? may_touch(around, touching_m, place)
                          : may_meet(around, centre_m, centre_m, touching_m, place);
    for (int i = 0; i < count; ++i) {
        const TriangleCorners corner = around.corner(place[i]);
        if (behind_a_plane(out, corner, rest_m - 0.25 * walk.hover_m))
            continue; // around a corner or along an edge they share one
        const TrianglePoint at = nearest_on_triangle(corner, centre_m);
        if (at.distance2_m2 <= touching_m * touching_m)
            out.add(around.triangle(place[i]), corner, at, centre_m, rest_m);
    }
    if (out.count > 0)
        return;
    TrianglePoint at;
    const int nearest = nearest_of(around, centre_m, at);
    const double most_m = rest_m + walk.longest_m;
    if (nearest >= 0 && at.distance2_m2 <= most_m * most_m)
        out.add(around.triangle(nearest), around.corner(nearest), at, centre_m, rest_m);
}

// What a straight path of the centre meets.
struct Met {
    int place = -1; // among those near; -1: nothing
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
Met meets(const NearLeaves& around, const Walk& walk, const HoldingPlanes& planes,
          const dvec3& from_m, const dvec3& to_m) noexcept {
    Met first, deepest;
    double deepest2_m2 = walk.touch_m * walk.touch_m;
    Places place;
    const int count = may_meet(around, from_m, to_m, walk.touch_m, place);
    for (int i = 0; i < count; ++i) {
        const int at = static_cast<int>(place[i]);
        const TriangleCorners corner = around.corner(at);
        if (behind_a_plane(planes, corner, walk.touch_m))
            continue;
        TrianglePoint start;
        if (first.place >= 0) { // is it before that one?
            start = nearest_on_triangle(corner, from_m);
            if (parts(start, from_m, first.centre_m, walk))
                continue;
        }
        const TrianglePoint end = nearest_on_triangle(corner, to_m);
        if (parts(end, to_m, from_m, walk))
            continue;
        const dvec3 offset = to_m - end.place_m;
        if (end.distance2_m2 < walk.touch_m * walk.touch_m && end.distance2_m2 > 0.0 &&
            glm::dot(offset, from_m - end.place_m) >=
                (walk.touch_m + walk.hover_m) * std::sqrt(end.distance2_m2)) {
            if (end.distance2_m2 < deepest2_m2) {
                deepest2_m2 = end.distance2_m2;
                deepest = {at, 1.0, end, to_m};
            }
            continue;
        }
        if (first.place < 0)
            start = nearest_on_triangle(corner, from_m);
        const TriangleSweep sweep = sweep_ball(corner, start, from_m, to_m, walk.touch_m);
        if (sweep.time <= 1.0 && sweep.time < first.time)
            first = {at, sweep.time, sweep.on_triangle, from_m + sweep.time * (to_m - from_m)};
    }
    return first.place >= 0 ? first : deepest;
}

// How far along a path nothing is met.
double free_part(const NearLeaves& around, const Walk& walk, const HoldingPlanes& planes,
                 const dvec3& from_m, const dvec3& to_m) noexcept {
    double time = 1.0;
    Places place;
    const int count = may_meet(around, from_m, to_m, walk.touch_m, place);
    for (int i = 0; i < count; ++i) {
        const TriangleCorners corner = around.corner(place[i]);
        if (!behind_a_plane(planes, corner, walk.touch_m))
            time = std::min(time, sweep_ball({corner, corner}, from_m, to_m, walk.touch_m).time);
    }
    return time;
}

enum class Step { arrived, turned, shortened, blocked };

// One straight step of the centre, turned aside by what it would meet.
Step step(const NearLeaves& around, const Walk& walk, HoldingPlanes& planes, dvec3& centre_m,
          bool& sliding) noexcept {
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
        const Met met = meets(around, walk, planes, centre_m, to_m);
        if (met.place < 0) {
            centre_m = to_m;
            sliding = slides;
            return too_far ? Step::shortened : touch > 0 ? Step::turned : Step::arrived;
        }
        const int before = planes.count;
        planes.add(around.triangle(met.place), around.corner(met.place), met.at, met.centre_m,
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

// What is known around the ball, and where it may go on that knowledge.
struct Around {
    const CollisionIndex& index;
    const MeshView& mesh;
    double least_m; // radius, and what is to be seen beyond it wherever the ball is
    NearLeaves near;
    double known_m = -1.0; // the ball's centre may be as far as this from the look's

    // by hand: an aggregate would be filled with zeros first, all 27 kB of it
    Around(const CollisionIndex& i, const MeshView& m, double least) noexcept
        : index(i), mesh(m), least_m(least) {}
    void look(const dvec3& centre_m, double way_m, WideRing& ring) noexcept {
        look_around(index, mesh, centre_m, least_m + way_m, least_m, ring, near);
        known_m = near.reach_m - least_m;
    }
};

// The straight way to the device is free: first as far as is known, then, if need be, all of it.
bool free_to_device(Around& around, const Walk& walk, const HoldingPlanes& planes,
                    const dvec3& centre_m, WideRing& ring) noexcept {
    const dvec3& device_m = walk.in.device_m;
    const double way_m = glm::length(device_m - centre_m);
    const double seen = std::min(1.0, walk.longest_m / way_m);
    if (meets(around.near, walk, planes, centre_m, centre_m + seen * (device_m - centre_m)).place >=
        0)
        return false;
    around.look(centre_m, way_m, ring);
    return way_m <= around.known_m &&
           meets(around.near, walk, planes, centre_m, device_m).place < 0;
}

// To where the device pulls, as far as a tick allows.
// `most_m`: no farther in this tick, unless the straight way to the device is free: off a surface
// there is no force left.
void approach(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& in,
              double most_m, double device_way_m, ProxyState& state) noexcept {
    const dvec3 start_m = state.proxy_m;
    const double pull_m = glm::length(in.device_m - start_m);
    // as far as the device, and a little for what has piled up; in the air all the way
    const double guess_m =
        state.touching ? 1.25 * device_way_m + 0.25 * state.step_m + 0.002 * pull_m : pull_m;
    Walk walk{.in = in,
              .hover_m = state.hover_m,
              .touch_m = in.radius_m + 0.5 * state.hover_m,
              .longest_m = std::min({guess_m, pull_m, most_m}),
              .rounding_m =
                  16.0 * std::numeric_limits<double>::epsilon() *
                  (std::abs(start_m.x) + std::abs(start_m.y) + std::abs(start_m.z) + pull_m),
              .slid = state.sliding};
    Around around{index, mesh, in.radius_m + 3.0 * walk.hover_m};
    HoldingPlanes planes;
    bool sliding = false, looked_far = false;
    state.step_m = 0.0;
    for (int i = 0; i < kMostSteps && most_m > 0.0; ++i) {
        const double longest_m = std::min(walk.longest_m, most_m);
        double gone_m = i == 0 ? 0.0 : glm::length(state.proxy_m - around.near.centre_m);
        if (gone_m + 0.1 * longest_m > around.known_m) {
            around.look(state.proxy_m, 1.1 * longest_m, state.ring);
            gone_m = 0.0;
        }
        walk.longest_m = std::min(longest_m, around.known_m - gone_m);
        touching(around.near, walk, state.proxy_m, planes);
        if (!holds_back(planes, in.device_m) && !looked_far && longest_m < pull_m) {
            looked_far = true;
            if (free_to_device(around, walk, planes, state.proxy_m, state.ring)) {
                state.step_m += glm::length(in.device_m - state.proxy_m);
                state.proxy_m = in.device_m;
                break;
            }
        }
        const dvec3 from_m = state.proxy_m;
        const Step done = step(around.near, walk, planes, state.proxy_m, sliding);
        const double way_m = glm::length(state.proxy_m - from_m);
        state.step_m += way_m;
        most_m -= way_m;
        if (done != Step::shortened || way_m <= walk.hover_m || state.step_m >= device_way_m)
            break; // what turns with the surface on the way is left to the next tick
        walk.longest_m = std::min(2.0 * longest_m, pull_m);
    }
    state.sliding = sliding;
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
    double ridden_m = 0.0;
    if (!mesh.before_m.empty()) {
        const dvec3 start_m = state.proxy_m;
        ride_along(index, mesh, in, state);
        ridden_m = glm::length(state.proxy_m - start_m);
    }
    const double catch_up_m = in.stiffness_npm > 0.0 ? kCatchUp_n / in.stiffness_npm : 0.0;
    const double device_way_m = glm::length(in.device_m - state.device_m);
    approach(index, mesh, in, device_way_m + std::max(catch_up_m - ridden_m, 0.2 * catch_up_m),
             device_way_m, state);
    state.device_m = in.device_m;
    state.sliding = state.sliding && state.touching;
    // also in the air, until it has caught up
    state.force_n = in.stiffness_npm * (state.proxy_m - in.device_m);
}

} // namespace haptics
