// haptics/contact/path_planes.h
// What a ball's path meets among a few triangles, and the planes that keep it off. A part of
// safe_proxy.h. Real-time safe.
#pragma once

#include "haptics/collision/near_leaves.h"
#include "haptics/contact/plane_qp.h"
#include "haptics/contact/proxy_method.h"

namespace haptics {

/// What comes within `reach_m` of `centre_m`; if there is more than there is room for, with a
/// shorter reach, but never shorter than `least_m`; if even there is too much, any of it.
void look_around(const CollisionIndex& index, const MeshView& mesh, const glm::dvec3& centre_m,
                 double reach_m, double least_m, WideRing& ring, NearLeaves& out) noexcept;

/// Planes that hold the ball now, with the surface points they come from.
struct HoldingPlanes {
    static constexpr int kRoom = 16;
    int count = 0;
    struct Source {
        std::uint32_t triangle;
        glm::dvec3 weight;
    };
    std::array<Plane, kRoom> plane;
    std::array<Source, kRoom> from;

    /// The plane that touches the triangle, grown by `radius_m`, at the point nearest to
    /// `centre_m`; the triangle's own if the ball is beside its edge by next to nothing, so that
    /// triangles in one plane are one plane also across their seams. Nothing if there is no
    /// direction, no room, or the same plane already.
    void add(std::uint32_t triangle, const TriangleCorners& corner, const TrianglePoint& nearest,
             const glm::dvec3& centre_m, double radius_m) noexcept;
};

/// How far off a surface a proxy rests, for as long as it lives; half of it is a touch. A share of
/// the ball (for a point: of the mesh's first edges), and the rounding of coordinates: far more
/// than what a sweep takes for contact, far less than anybody feels.
double hover_of(const MeshView& mesh, const ProxyInput& in) noexcept;

} // namespace haptics
