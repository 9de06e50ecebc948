// First touch of moving balls and capsules with a moving triangle: see triangle.h.
#include "haptics/collision/triangle.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace haptics {
namespace {

using glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostAdvances = 256; // each is exact against a plane; a handful is usual
constexpr int kPatience = 4;       // advances before a direction that turns is tried

double largest(const dvec3& v) noexcept {
    return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
}

/// What counts as a touch.
struct Touch {
    double radius_m = 0.0;
    double rounding_m = 0.0; // of the coordinates
    double enough_m = 0.0;   // a gap as good as none
    double motion_m = 0.0;   // bounds how far anything gets against anything else

    /// A ball that comes over an edge and slides on along the face closes at up to the root of
    /// twice the gap over its radius, and never touches. Only what is faster is sure to.
    /// (Of a ball so small that this would let it deeper than a fiftieth, all is.)
    double graze(double gap_m) const noexcept {
        return radius_m > 0.0
                   ? std::min(2.0 * motion_m * std::sqrt(std::max(gap_m, rounding_m) / radius_m),
                              0.02 * radius_m)
                   : 0.0;
    }
};

Touch touch_of(const MovingTriangle& triangle, double coordinate_m, double motion_m,
               double radius_m) noexcept {
    dvec3 far{coordinate_m}, moved{0.0};
    for (int k = 0; k < 3; ++k) {
        far = glm::max(far, glm::max(glm::abs(triangle.before[k]), glm::abs(triangle.after[k])));
        moved = glm::max(moved, glm::abs(triangle.after[k] - triangle.before[k]));
    }
    // offsets are up to 3.5 coordinates long, and so is the way; a few operations on both
    const double rounding_m = 64.0 * std::numeric_limits<double>::epsilon() * largest(far);
    return {.radius_m = radius_m,
            .rounding_m = rounding_m,
            .enough_m = rounding_m + kSweepGap * radius_m,
            .motion_m = 2.0 * (motion_m + largest(moved))};
}

/// Cheap, and true of most that boxes of a mesh let through: what is swept stays on one side.
bool far_apart(const MovingTriangle& t, const dvec3& low_m, const dvec3& high_m,
               double thick_m) noexcept {
    dvec3 low = t.before[0], high = low;
    for (const dvec3& c : {t.before[1], t.before[2], t.after[0], t.after[1], t.after[2]}) {
        low = glm::min(low, c);
        high = glm::max(high, c);
    }
    low -= high_m + thick_m;
    high -= low_m - thick_m;
    return low.x > 0.0 || low.y > 0.0 || low.z > 0.0 || high.x < 0.0 || high.y < 0.0 ||
           high.z < 0.0;
}

/// The unit direction from the body to the triangle. Near touch the offset between the nearest
/// points is all rounding; the features they lie on still know what they are square to.
dvec3 direction(const TriangleCorners& corner, const TrianglePoint& near, const dvec3& offset,
                const dvec3& segment, bool inside_segment) noexcept {
    dvec3 flat[3];
    int flats = 0;
    for (int k = 0; k < 3; ++k)
        if (near.weight[k] > 0.0 && near.weight[(k + 1) % 3] > 0.0)
            flat[flats++] = corner[(k + 1) % 3] - corner[k];
    if (inside_segment && flats < 2)
        flat[flats++] = segment;
    dvec3 out = offset;
    if (flats >= 2) {
        const dvec3 n = glm::cross(flat[0], flat[1]);
        out = glm::dot(n, offset) < 0.0 ? -n : n;
    } else if (flats == 1 && glm::dot(flat[0], flat[0]) > 0.0) {
        out -= flat[0] * (glm::dot(flat[0], offset) / glm::dot(flat[0], flat[0]));
    }
    out /= std::sqrt(glm::dot(out, out)); // a pair that is parallel or without area: the offset
    const double length = std::sqrt(glm::dot(offset, offset));
    return glm::dot(out, offset) > 0.5 * length ? out : offset / length;
}

/// From a place to a point of the triangle; exact to what the differences are rounded by.
dvec3 offset_to(const TriangleCorners& corner, const dvec3& weight, const dvec3& from) noexcept {
    return weight.x * (corner[0] - from) + weight.y * (corner[1] - from) +
           weight.z * (corner[2] - from);
}

/// How long the corners' gaps along one direction last.
struct Apart {
    const Touch& touch;
    double left; // of the interval
    double time = kInfinity;
    double closing = 0.0; // the fastest of those whose gap is used up
    bool lost = false;    // rounding: the direction does not separate them

    void add(double gap_m, double rate) noexcept {
        lost = lost || gap_m < -touch.enough_m;
        if (!(rate < 0.0))
            return;
        const bool deeper = -rate * left > touch.enough_m && -rate > touch.graze(0.0);
        if (gap_m <= touch.rounding_m && !deeper)
            return; // it rests or slides there
        if (gap_m + rate * left > touch.rounding_m)
            return; // it does not get there
        time = std::min({time, std::max(gap_m - 0.5 * touch.rounding_m, 0.0) / -rate, left});
        if (gap_m <= touch.enough_m)
            closing = std::max(closing, -rate);
    }
};

/// One body at one time: what is nearest, and the gaps along the direction between them.
struct Look {
    TriangleSweep found; // its time is not set
    double distance_m;
    Apart apart;
    dvec3 direction{0.0}; // unit, from the body to the triangle
    int ways = 0;
    std::array<dvec3, 6> way{}; // from the body's corners to the triangle's

    void add(const dvec3& way_m, const dvec3& rate) noexcept {
        apart.add(glm::dot(direction, way_m) - apart.touch.radius_m, glm::dot(direction, rate));
        way[ways++] = way_m;
    }
};

/// Whether a direction that turns evenly from one look's to another's keeps the two apart all the
/// while. Along such a direction each gap is a quadratic in time, above its Bernstein coefficients.
/// (A face that turns under a point hovering over it comes through any direction that is fixed.)
bool turns_apart(const Look& from, const Look& to) noexcept {
    const double radius_m = from.apart.touch.radius_m + from.apart.touch.rounding_m;
    for (int i = 0; i < from.ways; ++i) {
        const double start = glm::dot(from.direction, from.way[i]),
                     end = glm::dot(to.direction, to.way[i]);
        const double middle =
            0.5 * (glm::dot(from.direction, to.way[i]) + glm::dot(to.direction, from.way[i]));
        if (!(start > radius_m && middle > radius_m && end > radius_m)) // no direction: NaN
            return false;
    }
    return true;
}

/// The longest of the next 1, 1/2, 1/4 ... of what is left for which such a direction is found; 0:
/// none of them.
template <class LookAt>
double turning_advance(const Look& now, double time, LookAt&& look_at) noexcept {
    for (double step = 1.0 - time; step > 1e-3; step *= 0.5)
        if (turns_apart(now, look_at(time + step, 0.0)))
            return step;
    return 0.0;
}

/// `look_at(time, left)` gives a Look.
template <class LookAt> TriangleSweep advance(const Touch& touch, LookAt&& look_at) noexcept {
    if (!(touch.rounding_m < kInfinity))
        return {}; // of what is not finite
    double time = 0.0, least_gap_m = kInfinity;
    TriangleSweep nearest;
    for (int step = 0; step < kMostAdvances; ++step) {
        Look look = look_at(time, 1.0 - time);
        look.found.time = time;
        if (look.distance_m <= touch.rounding_m)
            return look.found; // no direction keeps them apart
        const double gap_m = look.distance_m - touch.radius_m;
        if (gap_m <= touch.enough_m && look.apart.closing > touch.graze(gap_m))
            return look.found;
        if (gap_m < least_gap_m) {
            least_gap_m = gap_m;
            nearest = look.found;
        }
        const double safe =
            look.apart.lost && gap_m > touch.enough_m ? gap_m / touch.motion_m : kInfinity;
        double ahead = std::min(look.apart.time, safe);
        if (step >= kPatience && ahead < (1.0 - time) / 16.0) {
            const double turned = turning_advance(look, time, look_at);
            if (turned > 0.0 && turned >= 1.0 - time)
                return {};
            ahead = std::max(ahead, turned);
        }
        if (!(time + ahead <= 1.0))
            return {};
        time += ahead;
    }
    return nearest;
}

} // namespace

TriangleSweep sweep_ball(const MovingTriangle& triangle, const dvec3& from_m, const dvec3& to_m,
                         double radius_m) noexcept {
    const dvec3 motion = to_m - from_m;
    const Touch touch =
        touch_of(triangle, std::max(largest(from_m), largest(to_m)), largest(motion), radius_m);
    if (far_apart(triangle, glm::min(from_m, to_m), glm::max(from_m, to_m),
                  radius_m + touch.enough_m))
        return {};
    return advance(touch, [&](double time, double left) {
        const TriangleCorners corner = triangle.at(time);
        const dvec3 centre = from_m + time * motion;
        const TrianglePoint near = nearest_on_triangle(corner, centre);
        Look look{{.on_triangle = near}, std::sqrt(near.distance2_m2), {touch, left}};
        look.direction =
            direction(corner, near, offset_to(corner, near.weight, centre), dvec3{0.0}, false);
        for (int k = 0; k < 3; ++k)
            look.add(corner[k] - centre, triangle.after[k] - triangle.before[k] - motion);
        return look;
    });
}

// The distance from a convex body is convex along a line: Newton's steps on it, from where it is
// more than the radius, come as near to the first touch as wanted and never past it. Where the
// direction between the nearest points is all rounding, the other one knows better.
TriangleSweep sweep_ball(const TriangleCorners& corner, const TrianglePoint& nearest,
                         const dvec3& from_m, const dvec3& to_m, double radius_m) noexcept {
    const dvec3 motion = to_m - from_m;
    const Touch touch = touch_of({corner, corner}, std::max(largest(from_m), largest(to_m)),
                                 largest(motion), radius_m);
    TriangleSweep at{.time = 0.0, .on_triangle = nearest};
    for (int step = 0; step < kMostAdvances; ++step) {
        const double distance_m = std::sqrt(at.on_triangle.distance2_m2);
        const double gap_m = distance_m - radius_m;
        const dvec3 offset = from_m + at.time * motion - at.on_triangle.place_m;
        const double rate_m = glm::dot(offset, motion) / distance_m;
        const double doubt_m = touch.motion_m * touch.rounding_m / distance_m;
        if (!(gap_m > touch.enough_m)) {
            // in touch from the start, or so slowly that it may slide: see there
            if (step > 0 && gap_m >= 0.0 && -rate_m > touch.graze(gap_m) + doubt_m)
                return at;
            break;
        }
        if (!(std::abs(rate_m) > doubt_m))
            break;
        if (rate_m > 0.0)
            return {};
        at.time += (gap_m - 0.5 * touch.enough_m) / (doubt_m - rate_m);
        if (!(at.time <= 1.0))
            return {};
        at.on_triangle = nearest_on_triangle(corner, from_m + at.time * motion);
    }
    return sweep_ball({corner, corner}, from_m, to_m, radius_m);
}

TriangleSweep sweep_capsule(const MovingTriangle& triangle, const MovingSegment& s,
                            double radius_m) noexcept {
    const dvec3 move_from = s.from_after_m - s.from_before_m,
                move_to = s.to_after_m - s.to_before_m;
    const double coordinate_m = std::max({largest(s.from_before_m), largest(s.to_before_m),
                                          largest(s.from_after_m), largest(s.to_after_m)});
    const Touch touch =
        touch_of(triangle, coordinate_m, std::max(largest(move_from), largest(move_to)), radius_m);
    if (far_apart(triangle,
                  glm::min(glm::min(s.from_before_m, s.to_before_m),
                           glm::min(s.from_after_m, s.to_after_m)),
                  glm::max(glm::max(s.from_before_m, s.to_before_m),
                           glm::max(s.from_after_m, s.to_after_m)),
                  radius_m + touch.enough_m))
        return {};
    return advance(touch, [&](double time, double left) {
        const TriangleCorners corner = triangle.at(time);
        const dvec3 from = s.from_before_m + time * move_from, to = s.to_before_m + time * move_to;
        const SegmentPair pair = nearest_to_segment(corner, from, to);
        Look look{{.on_triangle = pair.on_triangle, .along = pair.along},
                  std::sqrt(pair.on_triangle.distance2_m2),
                  {touch, left}};
        look.direction = direction(corner, pair.on_triangle,
                                   offset_to(corner, pair.on_triangle.weight, pair.place_m),
                                   to - from, pair.along > 0.0 && pair.along < 1.0);
        for (int k = 0; k < 3; ++k) {
            const dvec3 v = triangle.after[k] - triangle.before[k];
            look.add(corner[k] - from, v - move_from);
            look.add(corner[k] - to, v - move_to);
        }
        return look;
    });
}

} // namespace haptics
