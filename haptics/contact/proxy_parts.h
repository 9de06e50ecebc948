// haptics/contact/proxy_parts.h
// What the contact methods for a ball on a mesh share: is the input finite, where does a triangle
// face, how far from a surface does a proxy rest, what does friction hold back. Real-time safe.
#pragma once

#include "haptics/collision/triangle.h"
#include "haptics/contact/plane_qp.h"
#include "haptics/contact/proxy_method.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

namespace haptics {

inline bool finite(const ProxyInput& in) noexcept {
    const glm::dvec3& d = in.device_m;
    return std::isfinite(d.x + d.y + d.z + in.radius_m + in.stiffness_npm + in.static_friction +
                         in.dynamic_friction);
}

/// Unit, by the winding; zero for a triangle without area.
inline glm::dvec3 facing(const TriangleCorners& c) noexcept {
    const glm::dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
    const double length = glm::length(n);
    return length > 0.0 ? n / length : glm::dvec3{0.0};
}

/// A proxy rests this far off a surface: more than the gap at which a sweep over `motion_m` reports
/// a touch, so that a motion along the surface, or off it, is not taken for one into it.
inline double hover_gap_m(const glm::dvec3& place_m, double motion_m) noexcept {
    const double size_m =
        std::max({std::abs(place_m.x), std::abs(place_m.y), std::abs(place_m.z)}) + motion_m;
    return 4.0 * kSweepGap * motion_m + 64.0 * std::numeric_limits<double>::epsilon() * size_m;
}

struct Friction {
    double at_rest, sliding; // Coulomb coefficients
    bool slid;               // in the last tick
};

/// Coulomb in a proxy's terms: the way along the surface is the tangential force, from the device
/// to the place without friction the normal one, both over k (Ruspini et al. 1997). Where the
/// proxy gets from `from_m`; sets `sliding` if it is not held. In a corner what is left of the way
/// may lead through one of the `planes`, by more than the tolerance; then it is a part of the
/// straight way.
inline glm::dvec3 held_back(const Friction& friction, std::span<const Plane> planes,
                            double tolerance_m, const glm::dvec3& device_m,
                            const glm::dvec3& from_m, const glm::dvec3& smooth_m,
                            bool& sliding) noexcept {
    const glm::dvec3 normal_m = smooth_m - device_m, way_m = smooth_m - from_m;
    const double push_m = glm::length(normal_m);
    if (!(push_m > 0.0) || !(friction.at_rest > 0.0 || friction.sliding > 0.0))
        return smooth_m;
    const glm::dvec3 n = normal_m / push_m;
    const glm::dvec3 out_m = glm::dot(way_m, n) * n, along_m = way_m - out_m;
    const double along = glm::length(along_m), left = friction.sliding * push_m;
    const double grip = friction.slid || sliding ? left : std::max(friction.at_rest * push_m, left);
    const double share = along <= grip ? 0.0 : 1.0 - left / along;
    sliding = sliding || along > grip;
    const glm::dvec3 held_m = from_m + out_m + share * along_m;
    const bool allowed = std::all_of(planes.begin(), planes.end(), [&](const Plane& p) {
        return glm::dot(p.normal, held_m) >= p.offset_m - tolerance_m;
    });
    return allowed ? held_m : from_m + share * way_m;
}

} // namespace haptics
