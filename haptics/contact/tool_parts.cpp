#include "haptics/contact/tool_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptics {
namespace {

using glm::dvec3;

double farthest(const dvec3& n, const TriangleCorners& c) noexcept {
    return std::max({glm::dot(n, c[0]), glm::dot(n, c[1]), glm::dot(n, c[2])});
}

// By the direction from the triangle's middle: nearer than this they are not, and cheap.
Between at_a_glance(const ToolShape& shape, ToolPart part, const dvec3& tip_m,
                    const Obstacle& obstacle) noexcept {
    const TriangleCorners& c = obstacle.corner;
    const dvec3 middle_m = (c[0] + c[1] + c[2]) / 3.0;
    const dvec3 axis = part == ToolPart::shaft ? shape.pivot_m - tip_m : dvec3{0.0};
    const double length2 = glm::dot(axis, axis);
    const double along =
        length2 > 0.0 ? std::clamp(glm::dot(middle_m - tip_m, axis) / length2, 0.0, 1.0) : 0.0;
    const dvec3 away = tip_m + along * axis - middle_m;
    const double length = glm::length(away);
    if (!(length > 0.0))
        return {-HUGE_VAL, dvec3{0.0, 0.0, 1.0}, HUGE_VAL};
    const dvec3 n = away / length;
    const double front_m = farthest(n, c) + obstacle.grown_m;
    const double tip = glm::dot(n, tip_m);
    return {std::min(tip, tip + glm::dot(n, axis)) - radius_of(shape, part) - front_m, n, front_m};
}

// Exact if they are near for a way of `beyond_m`.
Between between(const ToolShape& shape, ToolPart part, const dvec3& tip_m, const Obstacle& obstacle,
                double beyond_m) noexcept {
    if (!has(shape, part))
        return {HUGE_VAL, dvec3{0.0}, HUGE_VAL};
    const Between guess = at_a_glance(shape, part, tip_m, obstacle);
    if (guess.gap_m > 0.25 * beyond_m)
        return guess;
    const SegmentPair pair = part_to_triangle(shape, part, tip_m, obstacle.corner);
    const double distance = std::sqrt(pair.on_triangle.distance2_m2);
    const dvec3 n = distance > 0.0 ? (pair.place_m - pair.on_triangle.place_m) / distance
                                   : dvec3{0.0, 0.0, 1.0};
    return {distance - radius_of(shape, part) - obstacle.grown_m, n,
            farthest(n, obstacle.corner) + obstacle.grown_m};
}

// Adds an obstacle if it comes near enough. False: there is no room.
bool take(const ToolShape& shape, const dvec3& tip_m, const Obstacle& obstacle, double beyond_m,
          Surroundings& out) noexcept {
    const std::array now{between(shape, ToolPart::tip, tip_m, obstacle, beyond_m),
                         between(shape, ToolPart::shaft, tip_m, obstacle, beyond_m)};
    if (!(std::min(now[0].gap_m, now[1].gap_m) <= beyond_m))
        return true;
    if (out.count == Surroundings::kRoom)
        return false;
    out.near[out.count] = obstacle;
    out.between[out.count++] = now;
    return true;
}

bool gather(const CollisionIndex& index, const MeshView& mesh, const OtherTools& others,
            const ToolShape& shape, const dvec3& tip_m, double beyond_m,
            Surroundings& out) noexcept {
    out.count = 0;
    bool room = true;
    for (int i = 0; i < others.count; ++i)
        room = take(shape, tip_m, others.part[i], beyond_m, out) && room;
    const double reach_m = thickest(shape) + beyond_m;
    Reach reach{shape.shaft_radius_m > 0.0 ? shape.pivot_m : tip_m, tip_m, reach_m};
    std::visit(
        [&](const auto& method) {
            visit(method, reach, [&](std::uint32_t t) {
                const TriangleCorners corner = mesh.corners(t);
                if (room && !surely_far(shape, tip_m, corner, reach_m))
                    room = take(shape, tip_m, {corner, 0.0, t, -1}, beyond_m, out);
                if (!room)
                    reach.radius_m = 0.0; // no more of this
            });
        },
        index);
    return room;
}

} // namespace

OtherTools others_of(int tool, const ToolsState& state) noexcept {
    OtherTools out;
    for (int other = 0; other < kMostTools; ++other) {
        const ToolState& s = state.tool[other];
        if (other == tool || !s.started)
            continue;
        for (const ToolPart part : kToolParts)
            if (has(s.shape, part))
                out.part[out.count++] = {
                    {part == ToolPart::shaft ? s.shape.pivot_m : s.tip_m, s.tip_m, s.tip_m},
                    radius_of(s.shape, part),
                    kNoSurface,
                    other};
    }
    return out;
}

SegmentPair part_to_triangle(const ToolShape& shape, ToolPart part, const dvec3& tip_m,
                             const TriangleCorners& corner) noexcept {
    if (part == ToolPart::shaft)
        return nearest_to_segment(corner, shape.pivot_m, tip_m);
    return {nearest_on_triangle(corner, tip_m), 1.0, tip_m};
}

TriangleSweep sweep_part(const ToolShape& shape, ToolPart part, const MovingTriangle& triangle,
                         const dvec3& from_m, const dvec3& to_m, double radius_m) noexcept {
    if (part == ToolPart::shaft)
        return sweep_capsule(triangle, {shape.pivot_m, from_m, shape.pivot_m, to_m}, radius_m);
    TriangleSweep out = sweep_ball(triangle, from_m, to_m, radius_m);
    out.along = 1.0;
    return out;
}

bool surely_far(const ToolShape& shape, const dvec3& tip_m, const TriangleCorners& corner,
                double reach_m) noexcept {
    const dvec3 axis = shape.shaft_radius_m > 0.0 ? shape.pivot_m - tip_m : dvec3{0.0};
    const dvec3 seen = corner[0] - tip_m;
    const double length2 = glm::dot(axis, axis);
    const double along = length2 > 0.0 ? std::clamp(glm::dot(seen, axis) / length2, 0.0, 1.0) : 0.0;
    const dvec3 away = seen - along * axis, b = corner[1] - corner[0], c = corner[2] - corner[0];
    const double wide_m =
        reach_m + std::sqrt(std::max(glm::dot(b, b), glm::dot(c, c))) * (1.0 + 1e-9);
    return glm::dot(away, away) > wide_m * wide_m;
}

void look_around(const CollisionIndex& index, const MeshView& mesh, const OtherTools& others,
                 const ToolShape& shape, const dvec3& tip_m, double beyond_m, double least_m,
                 Surroundings& out) noexcept {
    for (int attempt = 0; attempt < 12; ++attempt) {
        if (gather(index, mesh, others, shape, tip_m, beyond_m, out) || beyond_m <= least_m)
            break;
        beyond_m = std::max(least_m, attempt < 10 ? 0.6 * beyond_m : least_m);
    }
    out.tip_m = tip_m;
    out.beyond_m = beyond_m;
}

void ToolPlanes::add(const ToolShape& shape, ToolPart part, const Obstacle& obstacle,
                     const SegmentPair& nearest, double rest_m, double slack_m) noexcept {
    constexpr double kBeside = 1e-5; // of the distance: see HoldingPlanes
    const double distance = std::sqrt(nearest.on_triangle.distance2_m2);
    if (!(distance > 0.0))
        return;
    dvec3 n = (nearest.place_m - nearest.on_triangle.place_m) / distance;
    const TriangleCorners& c = obstacle.corner;
    const dvec3 face = glm::cross(c[1] - c[0], c[2] - c[0]);
    const double height = glm::dot(face, n), area = glm::length(face);
    if (nearest.along >= 1.0 && area > 0.0 && std::abs(height) > (1.0 - kBeside) * area)
        n = (height < 0.0 ? -1.0 : 1.0) / area * face;
    for (int i = 0; i < count; ++i) {
        const Plane& p = plane[i];
        const bool same =
            from[i].part == part &&
            (part == ToolPart::tip || glm::dot(p.normal, shape.pivot_m) >= p.offset_m - slack_m);
        if (same && farthest(p.normal, c) + rest_m <= p.offset_m + slack_m &&
            (from[i].tool == obstacle.tool))
            return;
    }
    push({n, glm::dot(n, nearest.on_triangle.place_m) + rest_m},
         {part, nearest.along, obstacle.tool, obstacle.triangle, nearest.on_triangle.weight, n});
}

void ToolPlanes::push(const Plane& made, const ToolTouch& contact) noexcept {
    if (count == kRoom)
        return;
    plane[count] = made;
    from[count++] = contact;
}

} // namespace haptics
