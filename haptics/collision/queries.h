// haptics/collision/queries.h
// The questions that contact asks of a mesh, the same for every collision method: see reach.h for
// what a method is. `mesh` is what the method was made from or last refitted to. Ties go to the
// smaller number of a triangle, so that all methods give the same answer. Real-time safe.
#pragma once

#include "haptics/collision/mesh_view.h"
#include "haptics/collision/reach.h"
#include "haptics/collision/triangle.h"

#include <cmath>
#include <cstddef>

namespace haptics {

struct SurfaceHit {
    std::uint32_t triangle = kNoSurface; // kNoSurface: nothing there, the rest means nothing
    glm::dvec3 weight{0.0};
    glm::dvec3 place_m{0.0};
    double distance_m = 0.0; // closest point: to it; cast: from the segment's start
    bool hit() const noexcept { return triangle != kNoSurface; }
};

struct SweepHit {
    std::uint32_t triangle = kNoSurface;
    double time = 2.0; // 0..1, the first touch
    glm::dvec3 weight{0.0};
    glm::dvec3 place_m{0.0}; // on the surface, at that time
    double along = 0.0;      // on the capsule's segment
    bool hit() const noexcept { return triangle != kNoSurface; }
};

/// The search for the nearest point, and what it knows so far.
struct ClosestSearch {
    const MeshView& mesh;
    Reach reach;
    double best2_m2;
    SurfaceHit best{};

    ClosestSearch(const MeshView& of, const glm::dvec3& place_m, double radius_m) noexcept
        : mesh(of), reach{place_m, place_m, radius_m}, best2_m2(radius_m * radius_m) {}

    void operator()(std::uint32_t t) noexcept {
        const TrianglePoint near = nearest_on_triangle(mesh.corners(t), reach.from_m);
        if (!(near.distance2_m2 < best2_m2 ||
              (near.distance2_m2 == best2_m2 && t < best.triangle)) ||
            !std::isfinite(near.distance2_m2))
            return;
        best2_m2 = near.distance2_m2;
        best = {.triangle = t,
                .weight = near.weight,
                .place_m = near.place_m,
                .distance_m = std::sqrt(best2_m2)};
        reach.radius_m = best.distance_m;
    }
};

/// The nearest point of the mesh as it is now, if one is within `radius_m`.
template <class Method>
SurfaceHit closest_within(const Method& method, const MeshView& mesh, const glm::dvec3& place_m,
                          double radius_m) noexcept {
    ClosestSearch search(mesh, place_m, radius_m);
    visit(method, search.reach, search);
    return search.best;
}

/// The search for the first triangle along a segment.
struct CastSearch {
    const MeshView& mesh;
    glm::dvec3 to_m;
    Reach reach; // its end is the first meeting so far
    double along = 2.0;
    SurfaceHit best{};

    CastSearch(const MeshView& of, const glm::dvec3& from_m, const glm::dvec3& to) noexcept
        : mesh(of), to_m(to), reach{from_m, to, 0.0} {}

    void operator()(std::uint32_t t) noexcept {
        const TriangleCorners corner = mesh.corners(t);
        const TriangleSweep sweep = sweep_ball({corner, corner}, reach.from_m, to_m, 0.0);
        if (!sweep.hit() || !(sweep.time < along || (sweep.time == along && t < best.triangle)))
            return;
        along = sweep.time;
        best = {.triangle = t,
                .weight = sweep.on_triangle.weight,
                .place_m = sweep.on_triangle.place_m};
        reach.to_m = reach.from_m + along * (to_m - reach.from_m);
    }

    SurfaceHit answer() const noexcept {
        SurfaceHit hit = best;
        const glm::dvec3 d = hit.place_m - reach.from_m;
        hit.distance_m = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        return hit;
    }
};

/// Where a segment first meets the mesh as it is now.
template <class Method>
SurfaceHit cast_segment(const Method& method, const MeshView& mesh, const glm::dvec3& from_m,
                        const glm::dvec3& to_m) noexcept {
    CastSearch search(mesh, from_m, to_m);
    visit(method, search.reach, search);
    return search.answer();
}

/// First touch of a ball that moves from one place to another while the mesh moves from
/// `before_m` to `vertex_m`.
template <class Method>
SweepHit sweep_sphere(const Method& method, const MeshView& mesh, const glm::dvec3& from_m,
                      const glm::dvec3& to_m, double radius_m) noexcept {
    SweepHit best;
    Reach reach{from_m, to_m, (1.0 + kSweepGap) * radius_m}; // all gaps that count as touch
    visit(method, reach, [&](std::uint32_t t) {
        const TriangleSweep s =
            sweep_ball({mesh.corners_before(t), mesh.corners(t)}, from_m, to_m, radius_m);
        if (!s.hit() || !(s.time < best.time || (s.time == best.time && t < best.triangle)))
            return;
        best = {.triangle = t,
                .time = s.time,
                .weight = s.on_triangle.weight,
                .place_m = s.on_triangle.place_m};
        // the place, not the time, bounds what is still to be seen: the mesh moves too
        reach.to_m = from_m + best.time * (to_m - from_m);
    });
    return best;
}

/// The same for a capsule: a shaft.
template <class Method>
SweepHit sweep_shaft(const Method& method, const MeshView& mesh, const MovingSegment& segment,
                     double radius_m) noexcept {
    SweepHit best;
    // every place of the moving segment is within half its ends' motion of the middle one
    const glm::dvec3 from_m = 0.5 * (segment.from_before_m + segment.from_after_m);
    const glm::dvec3 to_m = 0.5 * (segment.to_before_m + segment.to_after_m);
    const glm::dvec3 a = segment.from_after_m - from_m, b = segment.to_after_m - to_m;
    const double half2 =
        std::fmax(a.x * a.x + a.y * a.y + a.z * a.z, b.x * b.x + b.y * b.y + b.z * b.z);
    Reach reach{from_m, to_m, (1.0 + kSweepGap) * radius_m + std::sqrt(half2)};
    visit(method, reach, [&](std::uint32_t t) {
        const TriangleSweep s =
            sweep_capsule({mesh.corners_before(t), mesh.corners(t)}, segment, radius_m);
        if (!s.hit() || !(s.time < best.time || (s.time == best.time && t < best.triangle)))
            return;
        best = {.triangle = t,
                .time = s.time,
                .weight = s.on_triangle.weight,
                .place_m = s.on_triangle.place_m,
                .along = s.along};
    });
    return best;
}

/// Calls found(SurfaceHit) for every triangle that comes within `margin_m` of a place, each once
/// if the method visits each once.
template <class Method, class Found>
void contacts_within(const Method& method, const MeshView& mesh, const glm::dvec3& place_m,
                     double margin_m, Found&& found) noexcept {
    Reach reach{place_m, place_m, margin_m};
    visit(method, reach, [&](std::uint32_t t) {
        const TrianglePoint near = nearest_on_triangle(mesh.corners(t), place_m);
        if (near.distance2_m2 <= margin_m * margin_m)
            found(SurfaceHit{t, near.weight, near.place_m, std::sqrt(near.distance2_m2)});
    });
}

} // namespace haptics
