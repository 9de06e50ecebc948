// haptics/contact/proxy_parts.h
// What the contact methods for a ball on a mesh share: is the input finite, where does a triangle
// face, how far from a surface does a proxy rest. Real-time safe.
#pragma once

#include "haptics/collision/triangle.h"
#include "haptics/contact/proxy_method.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

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

} // namespace haptics
