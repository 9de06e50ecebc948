// haptics/collision/triangle.h
// One triangle against a point, a segment, a moving sphere, a moving capsule. What every
// collision method ends in. No absolute tolerance anywhere: slivers, points and metres are not
// special. Real-time safe, deterministic to the bit.
#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace haptics {

using TriangleCorners = std::array<glm::dvec3, 3>;

struct TrianglePoint {
    glm::dvec3 weight{0.0}; // barycentric, sum 1, none negative
    glm::dvec3 place_m{0.0};
    double distance2_m2 = 0.0; // square, to what was asked about
};

/// The point of a triangle nearest to `place_m`: the foot of the perpendicular if that is inside,
/// else the nearest of its edges (Ericson, Real-Time Collision Detection, 5.1). Off by some
/// roundings of the coordinates and of the distance, also for slivers; without area, its edges;
/// with a corner that is not finite, infinitely far.
TrianglePoint nearest_on_triangle(const TriangleCorners& corner,
                                  const glm::dvec3& place_m) noexcept;

struct SegmentPair {
    TrianglePoint on_triangle; // distance: to the segment
    double along = 0.0;        // 0..1 on the segment
    glm::dvec3 place_m{0.0};   // there, on the segment
};

/// The nearest points of a triangle and a segment; if they cross, the crossing, at distance 0 (of
/// a segment that lies along a sliver, within a rounding of its plane: 1e-10 of its length).
SegmentPair nearest_to_segment(const TriangleCorners& corner, const glm::dvec3& from_m,
                               const glm::dvec3& to_m) noexcept;

/// Both ends of an interval in which all corners move on straight lines, at even speed.
struct MovingTriangle {
    TriangleCorners before, after;
    TriangleCorners at(double time) const noexcept;
};

struct MovingSegment {
    glm::dvec3 from_before_m, to_before_m, from_after_m, to_after_m;
};

struct TriangleSweep {
    double time = 2.0; // first touch, 0..1; 2: none
    TrianglePoint on_triangle;
    double along = 0.0; // on a moving segment
    bool hit() const noexcept { return time <= 1.0; }
};

/// First touch of a ball (a point: radius 0) moving from one place to another with a moving
/// triangle, by conservative advancement: time moves on by the gap over the largest closing speed
/// along the direction that separates them. Never later than the true touch; the gap that is left
/// then is below `kSweepGap` of the radius plus a rounding of the coordinates (a triangle that
/// swings about the place may leave 1/128 of its motion).
/// A ball in touch from the start, deep or not, is hit only if it gets deeper, by more than that
/// gap: it may rest, slide and leave. A point that is on the triangle is always hit. What is not
/// finite meets nothing.
TriangleSweep sweep_ball(const MovingTriangle& triangle, const glm::dvec3& from_m,
                         const glm::dvec3& to_m, double radius_m) noexcept;

/// The same for a triangle at rest of which it is known what is nearest to `from_m`: cheaper.
TriangleSweep sweep_ball(const TriangleCorners& corner, const TrianglePoint& nearest,
                         const glm::dvec3& from_m, const glm::dvec3& to_m,
                         double radius_m) noexcept;

/// The same for a capsule, whose segment's ends move on straight lines.
TriangleSweep sweep_capsule(const MovingTriangle& triangle, const MovingSegment& segment,
                            double radius_m) noexcept;

inline constexpr double kSweepGap = 1e-6;

} // namespace haptics
