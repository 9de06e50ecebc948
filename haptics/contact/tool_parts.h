// haptics/contact/tool_parts.h
// What a tool may meet, triangles and other tools, and the planes that keep its tip and its shaft
// off. A part of safe_tools.h. Real-time safe.
#pragma once

#include "haptics/contact/plane_qp.h"
#include "haptics/contact/safe_tools.h"

namespace haptics {

/// A triangle; of another tool, its shaft or tip as a triangle without area, thicker by a radius.
struct Obstacle {
    TriangleCorners corner;
    double grown_m;
    std::uint32_t triangle; // kNoSurface: a tool
    int tool;               // -1: a triangle
};

/// The other tools as they are.
struct OtherTools {
    int count = 0;
    std::array<Obstacle, 2 * (kMostTools - 1)> part;
};
OtherTools others_of(int tool, const ToolsState& state) noexcept;

/// A ball at the end of a shaft that is as thick is no part of its own.
inline bool has(const ToolShape& shape, ToolPart part) noexcept {
    return part == ToolPart::shaft
               ? shape.shaft_radius_m > 0.0
               : !(shape.shaft_radius_m > 0.0) || shape.tip_radius_m > shape.shaft_radius_m;
}
inline double radius_of(const ToolShape& shape, ToolPart part) noexcept {
    return part == ToolPart::shaft ? shape.shaft_radius_m : shape.tip_radius_m;
}
inline double thickest(const ToolShape& shape) noexcept {
    return std::fmax(shape.tip_radius_m, shape.shaft_radius_m);
}
inline constexpr std::array kToolParts{ToolPart::tip, ToolPart::shaft};

/// The nearest points of a part's axis and a triangle; `along` is the lever.
SegmentPair part_to_triangle(const ToolShape& shape, ToolPart part, const glm::dvec3& tip_m,
                             const TriangleCorners& corner) noexcept;

/// The first touch of a part whose tip goes evenly between two places.
TriangleSweep sweep_part(const ToolShape& shape, ToolPart part, const MovingTriangle& triangle,
                         const glm::dvec3& from_m, const glm::dvec3& to_m,
                         double radius_m) noexcept;

/// Whether all of a triangle is farther than `reach_m` from a shaft, seen at a glance.
bool surely_far(const ToolShape& shape, const glm::dvec3& tip_m, const TriangleCorners& corner,
                double reach_m) noexcept;

/// A direction that keeps a part and an obstacle apart, where it was looked.
struct Between {
    double gap_m; // of their surfaces, at least
    glm::dvec3 normal;
    double front_m; // the obstacle's surface along it
};

/// What a tool may meet while its tip is within some way of where it is.
struct Surroundings {
    static constexpr int kRoom = 384;
    int count = 0;
    glm::dvec3 tip_m; // where it was looked from
    double beyond_m;  // known this far from each part's surface
    std::array<Obstacle, kRoom> near;
    std::array<std::array<Between, 2>, kRoom> between; // it and each part

    const Between& of(int i, ToolPart part) const noexcept {
        return between[i][static_cast<std::size_t>(part)];
    }
};

/// Those within `beyond_m`; if there are more than there is room for, fewer and a shorter way, but
/// not below `least_m` unless even there are too many.
void look_around(const CollisionIndex& index, const MeshView& mesh, const OtherTools& others,
                 const ToolShape& shape, const glm::dvec3& tip_m, double beyond_m, double least_m,
                 Surroundings& out) noexcept;

/// Planes for the tip's centre, and what they come from.
struct ToolPlanes {
    static constexpr int kRoom = 24;
    int count = 0;
    std::array<Plane, kRoom> plane;
    std::array<ToolTouch, kRoom> from;

    /// The plane that keeps a part `rest_m` off an obstacle, square to the way between their
    /// nearest points. Nothing if there is no direction, no room, or a plane that does it already,
    /// but for `slack_m`.
    void add(const ToolShape& shape, ToolPart part, const Obstacle& obstacle,
             const SegmentPair& nearest, double rest_m, double slack_m) noexcept;
    void push(const Plane& made, const ToolTouch& contact) noexcept;
};

} // namespace haptics
