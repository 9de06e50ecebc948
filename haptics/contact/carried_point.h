// haptics/contact/carried_point.h
// Where a contact point goes when its tip wants it to slip. The slip is measured in one tangent
// plane; on a surface that is curved as strongly as the tip is round, a whole step of that length
// goes too far, to where it has to come back just as far, and on a thin vessel or the edge of a
// flap the point ends on the far side. So the step is shortened to where its end no longer wants to
// go back: one secant step after another on the offset along the way.
// Called by both loops; real-time safe.
#pragma once

#include "haptics/contact/surface_walk.h"

namespace haptics {

struct SurfacePlace {
    glm::dvec3 place_m{0.0};
    glm::dvec3 normal{0.0, 0.0, 1.0}; // unit
};

/// Walks `from` by `slip_m`, or by as much of it as brings the tip's offset from the point, along
/// the way, to what it was to be after the slip. `read(SurfacePoint)` gives a SurfacePlace.
template <class Surface, class Read>
WalkResult carry(const Surface& surface, const Read& read, const SurfacePoint& from,
                 const glm::dvec3& slip_m, const glm::dvec3& tip_m) noexcept {
    constexpr int kMostSteps = 4;
    constexpr double kNearly = 0.1; // of the slip: no need to go on
    const double wanted_m = glm::length(slip_m);
    if (!(wanted_m > 0.0))
        return {from, false};
    const SurfacePlace start = read(from);
    const glm::dvec3 way = slip_m / wanted_m;
    const double behind_m = glm::dot(tip_m - start.place_m, way) - wanted_m; // friction keeps it
    const auto left_at = [&](const SurfacePoint& at) {
        const SurfacePlace end = read(at);
        const glm::dvec3 along = way - glm::dot(way, end.normal) * end.normal;
        const double length = glm::length(along);
        // past a quarter turn the way leads into the surface
        return length > 1e-3 && glm::dot(end.normal, start.normal) > 0.0
                   ? glm::dot(tip_m - end.place_m, along / length) - behind_m
                   : -wanted_m;
    };

    WalkResult walked = walk(surface, from, slip_m);
    double left_m = left_at(walked.point);
    double near = 0.0, near_m = wanted_m, far = 1.0, far_m = left_m; // shares, and what is left
    for (int i = 0; i < kMostSteps && std::abs(left_m) > kNearly * wanted_m; ++i) {
        if (far_m > 0.0)
            break; // the whole slip was not too far
        const double share = near + (far - near) * near_m / (near_m - far_m);
        walked = walk(surface, from, share * slip_m);
        left_m = left_at(walked.point);
        (left_m > 0.0 ? near : far) = share;
        (left_m > 0.0 ? near_m : far_m) = left_m;
    }
    return walked;
}

} // namespace haptics
