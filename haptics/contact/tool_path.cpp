#include "haptics/contact/tool_path.h"

#include "haptics/contact/proxy_parts.h"

namespace haptics {
namespace {

using glm::dvec3;

constexpr int kMostSteps = 6;    // straight ones in a tick
constexpr int kMostTouches = 12; // that turn one of them aside

struct Walk {
    const ToolInput& in;
    const Surroundings& around;
    const ToolYields& yields;
    double hover_m;
    double longest_m;
    bool slid; // in the last tick
    bool sliding = false;

    double rest_m(ToolPart part, const Obstacle& o) const noexcept {
        return radius_of(in.shape, part) + o.grown_m + hover_m;
    }
};

// Planes of what the tool touches where it is.
ToolPlanes touching(const Walk& walk, const dvec3& tip_m) noexcept {
    ToolPlanes out;
    const double gone_m = glm::length(tip_m - walk.around.tip_m);
    const ToolShape& shape = walk.in.shape;
    for (int i = 0; i < walk.around.count; ++i)
        for (const ToolPart part : kToolParts) {
            if (!has(shape, part) || walk.around.of(i, part).gap_m > 2.0 * walk.hover_m + gone_m)
                continue;
            const Obstacle& near = walk.around.near[i];
            const SegmentPair pair = part_to_triangle(shape, part, tip_m, near.corner);
            const double rest_m = walk.rest_m(part, near);
            if (pair.along > 0.0 &&
                std::sqrt(pair.on_triangle.distance2_m2) <= rest_m + walk.hover_m)
                out.add(shape, part, near, pair, rest_m, 0.1 * walk.hover_m);
        }
    return out;
}

// An obstacle that lies behind a plane, and the part in front of it on all of the path.
struct Fronts {
    int count = 0;
    std::array<dvec3, ToolPlanes::kRoom> normal;
    std::array<std::array<double, 2>, ToolPlanes::kRoom> front_m;

    Fronts(const ToolPlanes& planes, const ToolShape& shape, const dvec3& from_m,
           const dvec3& to_m) noexcept
        : count(planes.count) {
        for (int i = 0; i < count; ++i) {
            const dvec3& n = normal[i] = planes.plane[i].normal;
            const double tip_m = std::min(glm::dot(n, from_m), glm::dot(n, to_m));
            front_m[i] = {tip_m, std::min(tip_m, glm::dot(n, shape.pivot_m))};
        }
    }
    bool keep(ToolPart part, const TriangleCorners& c, double radius_m) const noexcept {
        for (int i = 0; i < count; ++i)
            if (std::max({glm::dot(normal[i], c[0]), glm::dot(normal[i], c[1]),
                          glm::dot(normal[i], c[2])}) +
                    radius_m <=
                front_m[i][static_cast<std::size_t>(part)])
                return true;
        return false;
    }
};

struct FirstTouch {
    int index = -1; // in the surroundings
    ToolPart part = ToolPart::tip;
    TriangleSweep sweep;
};

FirstTouch first_touch(const Walk& walk, const ToolPlanes& planes, const dvec3& from_m,
                       const dvec3& to_m) noexcept {
    FirstTouch first;
    const Surroundings& around = walk.around;
    const Fronts fronts(planes, walk.in.shape, from_m, to_m);
    const double off_m =
        std::max(glm::length(from_m - around.tip_m), glm::length(to_m - around.tip_m));
    for (int i = 0; i < around.count; ++i)
        for (const ToolPart part : kToolParts) {
            const Obstacle& near = around.near[i];
            const double touch_m = walk.rest_m(part, near) - 0.5 * walk.hover_m;
            const Between& then = around.of(i, part);
            if (then.gap_m > walk.hover_m + off_m || !(first.sweep.time > 0.0))
                continue;
            const double front_m =
                std::min({glm::dot(then.normal, from_m), glm::dot(then.normal, to_m),
                          part == ToolPart::shaft ? glm::dot(then.normal, walk.in.shape.pivot_m)
                                                  : HUGE_VAL});
            if (then.front_m - near.grown_m + touch_m <= front_m ||
                fronts.keep(part, near.corner, touch_m))
                continue;
            // no farther than the first so far
            const double share = std::min(first.sweep.time, 1.0);
            TriangleSweep sweep = sweep_part(walk.in.shape, part, {near.corner, near.corner},
                                             from_m, from_m + share * (to_m - from_m), touch_m);
            if (!sweep.hit())
                continue;
            sweep.time *= share;
            if (sweep.time < first.sweep.time)
                first = {i, part, sweep};
        }
    return first;
}

// In front of all planes, and of the yields if that can be.
PlaneSolution nearest_place(const Walk& walk, const ToolPlanes& planes) noexcept {
    std::array<Plane, ToolPlanes::kRoom + ToolYields::kRoom> all;
    std::copy_n(planes.plane.begin(), planes.count, all.begin());
    std::copy_n(walk.yields.plane.begin(), walk.yields.count, all.begin() + planes.count);
    const std::span<const Plane> every(all.data(),
                                       static_cast<std::size_t>(planes.count + walk.yields.count));
    const PlaneSolution out = nearest_in_planes(every, walk.in.device_m);
    if (out.feasible || walk.yields.count == 0)
        return out;
    return nearest_in_planes(every.first(static_cast<std::size_t>(planes.count)), walk.in.device_m);
}

enum class Step { arrived, shortened, blocked };

// One straight step, turned aside by what it would meet.
Step step(Walk& walk, ToolPlanes& planes, dvec3& tip_m) noexcept {
    for (int touch = 0; touch <= kMostTouches; ++touch) {
        const PlaneSolution nearest = nearest_place(walk, planes);
        if (!nearest.feasible)
            return Step::blocked; // held from all sides
        bool slides = walk.sliding;
        const Friction friction{walk.in.static_friction, walk.in.dynamic_friction, walk.slid};
        const dvec3 wanted_m =
            nearest.actives > 0
                ? held_back(friction, std::span<const Plane>(planes.plane).first(planes.count),
                            0.25 * walk.hover_m, walk.in.device_m, tip_m, nearest.place_m, slides)
                : nearest.place_m;
        const double way_m = glm::length(wanted_m - tip_m);
        const bool too_far = way_m > walk.longest_m;
        const dvec3 to_m = too_far ? tip_m + walk.longest_m / way_m * (wanted_m - tip_m) : wanted_m;
        const FirstTouch met = first_touch(walk, planes, tip_m, to_m);
        if (met.index < 0 || touch == kMostTouches) {
            tip_m = met.index < 0 ? to_m : tip_m + met.sweep.time * (to_m - tip_m);
            walk.sliding = slides;
            return too_far || met.index >= 0 ? Step::shortened : Step::arrived;
        }
        const dvec3 there_m = tip_m + met.sweep.time * (to_m - tip_m);
        const Obstacle& near = walk.around.near[met.index];
        const int before = planes.count;
        planes.add(walk.in.shape, met.part, near,
                   part_to_triangle(walk.in.shape, met.part, there_m, near.corner),
                   walk.rest_m(met.part, near), 0.1 * walk.hover_m);
        if (planes.count == before) { // nothing new to turn aside by: as far as it is free
            tip_m = there_m;
            return Step::shortened;
        }
    }
    return Step::blocked;
}

// Also the tool that is about to follow one that gave way.
void tell_contacts(const ToolPlanes& planes, const ToolYields& yields, const ToolInput& in,
                   double hover_m, ToolState& state) noexcept {
    state.contacts = 0;
    const auto tell = [&](const Plane& p, const ToolTouch& from) {
        if (state.contacts < kMostToolContacts &&
            glm::dot(p.normal, state.tip_m) - p.offset_m <= 2.0 * hover_m &&
            glm::dot(p.normal, in.device_m) < p.offset_m)
            state.contact[state.contacts++] = from;
    };
    for (int i = 0; i < planes.count; ++i)
        tell(planes.plane[i], planes.from[i]);
    for (int i = 0; i < yields.count; ++i) {
        const auto same = [&](const ToolTouch& t) { return t.tool == yields.from[i].tool; };
        if (std::none_of(state.contact.begin(), state.contact.begin() + state.contacts, same))
            tell(yields.plane[i], yields.from[i]);
    }
    state.touching = state.contacts > 0;
}

} // namespace

void approach(const CollisionIndex& index, const MeshView& mesh, const OtherTools& others,
              const ToolYields& yields, const ToolInput& in, double most_m,
              ToolState& state) noexcept {
    const dvec3 start_m = state.tip_m;
    // a yield leads on beyond the device
    double pull_m = glm::length(in.device_m - start_m);
    for (int i = 0; i < yields.count; ++i)
        pull_m = std::max(
            pull_m, 1.5 * (yields.plane[i].offset_m - glm::dot(yields.plane[i].normal, start_m)));
    // as far as it came last time, and half more; in the air, all the way
    const double guess_m = state.touching ? 1.5 * state.step_m + 0.02 * pull_m : pull_m;
    Surroundings around;
    Walk walk{.in = in,
              .around = around,
              .yields = yields,
              .hover_m = state.hover_m,
              .longest_m = std::min({guess_m, pull_m, most_m}),
              .slid = state.sliding};
    const double least_m = 3.0 * walk.hover_m;
    ToolPlanes planes;
    double known_m = -1.0, wanted_m = walk.longest_m; // how far from where it was looked
    for (int i = 0; i < kMostSteps && most_m > 0.0; ++i) {
        wanted_m = std::min(wanted_m, most_m);
        if (known_m < 0.0 || glm::length(state.tip_m - around.tip_m) + 0.5 * wanted_m > known_m) {
            const double beyond_m = std::min(least_m + 1.2 * wanted_m, 1.5 * state.room_m);
            look_around(index, mesh, others, in.shape, state.tip_m, beyond_m, least_m, around);
            state.room_m =
                std::max({around.beyond_m, least_m + 2.0 * walk.hover_m,
                          around.count < Surroundings::kRoom / 2 ? 2.0 * beyond_m : 0.0});
            known_m = around.beyond_m - least_m;
        }
        walk.longest_m = std::min(wanted_m, known_m - glm::length(state.tip_m - around.tip_m));
        planes = touching(walk, state.tip_m);
        const dvec3 from_m = state.tip_m;
        const Step done = step(walk, planes, state.tip_m);
        const double way_m = glm::length(state.tip_m - from_m);
        most_m -= way_m;
        if (done == Step::blocked || way_m <= walk.hover_m ||
            (done == Step::arrived && i > 0 && way_m < 1e-3 * pull_m))
            break;
        if (done == Step::shortened)
            wanted_m = std::min(2.0 * wanted_m, pull_m);
    }
    state.sliding = walk.sliding;
    state.step_m = glm::length(state.tip_m - start_m);
    tell_contacts(planes, yields, in, walk.hover_m, state);
}

} // namespace haptics
