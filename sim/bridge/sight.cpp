#include "sim/bridge/sight.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace sim {
namespace {

using glm::dvec3;

constexpr double kPortFree_m = 20e-3; // as much as sim/check/solid.h leaves free
constexpr double kRing = 0.8;         // of the marker's radius

// Rays end on the disc lifted off the skin by this much of its radius. A plane that touches a tube
// leaves it everywhere, but the skin is of flat triangles and the normal is mixed from their
// corners: lifted, the ring stays above a skin that is turned against it by up to
// asin(0.15 / 0.8) = 10.8 degrees, or hollow with a radius of 2.2 times the marker's or more,
// (0.8^2 + 0.15^2) / (2 x 0.15). What lies on the marker by more than that hides it.
constexpr double kLift = 0.15;

// Ends of the rays in the plane of the disc, in units of its radius.
constexpr double kHalf = 0.5 * kRing, kHigh = 0.8660254037844386 * kRing; // cos, sin of 60 degrees
constexpr std::array<std::array<double, 2>, kSightRays> kAim{{{0.0, 0.0},
                                                              {kRing, 0.0},
                                                              {kHalf, kHigh},
                                                              {-kHalf, kHigh},
                                                              {-kRing, 0.0},
                                                              {-kHalf, -kHigh},
                                                              {kHalf, -kHigh}}};

bool moves(const Body& body) noexcept {
    return body.soft && !body.soft->resting;
}

bool blocked(const Sight& sight, std::span<const Body> bodies, const dvec3& from_m,
             const dvec3& to_m) noexcept {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (haptics::segment_hits(sight.tree[b], bodies[b].skin_m, from_m, to_m))
            return true;
    }
    return false;
}

bool shaft_blocked(const Sight& sight, std::span<const Body> bodies, const dvec3& port_m,
                   const dvec3& eye_m) noexcept {
    const dvec3 way_m = eye_m - port_m;
    const double length_m = glm::length(way_m);
    return length_m > kPortFree_m &&
           blocked(sight, bodies, port_m + way_m * (kPortFree_m / length_m), eye_m);
}

// A unit vector across `normal`: the axis least along it, made upright.
dvec3 across(const dvec3& normal) noexcept {
    const dvec3 size = glm::abs(normal);
    const dvec3 axis = size.x <= size.y && size.x <= size.z ? dvec3{1.0, 0.0, 0.0}
                       : size.y <= size.z                   ? dvec3{0.0, 1.0, 0.0}
                                                            : dvec3{0.0, 0.0, 1.0};
    return glm::normalize(glm::cross(normal, axis));
}

} // namespace

Sight make_sight(std::span<const Body> bodies) {
    Sight sight;
    for (const Body& body : bodies) {
        sight.tree.push_back(haptics::make_box_tree(body.skin_m, body.organ->surface.triangles));
        sight.moved.push_back(moves(body));
    }
    return sight;
}

void refit(Sight& sight, std::span<const Body> bodies) noexcept {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const bool now = moves(bodies[b]);
        if (now || sight.moved[b])
            haptics::refit(sight.tree[b], bodies[b].skin_m);
        sight.moved[b] = now;
    }
}

int clear_rays(const Sight& sight, std::span<const Body> bodies, const dvec3& port_m,
               const dvec3& eye_m, const Marker& marker) noexcept {
    const dvec3 centre_m = marker.place_m + kLift * marker.radius_m * marker.normal;
    const double height_m = glm::dot(eye_m - centre_m, marker.normal);
    if (!(height_m > 0.0) || !std::isfinite(height_m + glm::dot(port_m, port_m)))
        return 0;
    if (shaft_blocked(sight, bodies, port_m, eye_m))
        return 0;
    const dvec3 u = across(marker.normal), v = glm::cross(marker.normal, u);
    int clear = 0;
    for (const auto& [x, y] : kAim) {
        const dvec3 aim_m = centre_m + marker.radius_m * (x * u + y * v);
        clear += !blocked(sight, bodies, eye_m, aim_m);
    }
    return clear;
}

} // namespace sim
