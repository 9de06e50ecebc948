#include "haptics/collision/triangle.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

namespace haptics {
namespace {

using glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostAdvances = 64; // each is exact against a plane; a handful is usual
constexpr int kPatience = 4;      // advances before a turning plane is tried

double square(const dvec3& v) noexcept {
    return glm::dot(v, v);
}

double largest(const dvec3& v) noexcept {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// 0..1 along a segment, of what is nearest to the place.
double along_segment(const dvec3& a, const dvec3& ab, const dvec3& place) noexcept {
    const double length2 = square(ab);
    return length2 > 0.0 ? std::clamp(glm::dot(place - a, ab) / length2, 0.0, 1.0) : 0.0;
}

TrianglePoint on_edge(const TriangleCorners& corner, int from, const dvec3& place) noexcept {
    const int to = (from + 1) % 3;
    const dvec3 edge = corner[to] - corner[from];
    const double s = along_segment(corner[from], edge, place);
    TrianglePoint out{.place_m = corner[from] + s * edge};
    out.weight[from] = 1.0 - s;
    out.weight[to] = s;
    out.distance2_m2 = square(place - out.place_m);
    return out;
}

// Rounding may put the foot of the perpendicular anywhere in a triangle this thin (sine of an angle
// squared): the nearest of the foot and the edges is taken by its distance.
constexpr double kSliver = 1e-6;

TrianglePoint on_sliver(const TriangleCorners& corner, const dvec3& place) noexcept {
    TrianglePoint best = on_edge(corner, 0, place);
    const auto keep = [&](const TrianglePoint& other) {
        if (other.distance2_m2 < best.distance2_m2)
            best = other;
    };
    keep(on_edge(corner, 1, place));
    keep(on_edge(corner, 2, place));
    const dvec3 n = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const dvec3 a = corner[0] - place, b = corner[1] - place, c = corner[2] - place;
    const double u = glm::dot(n, glm::cross(b, c)), v = glm::dot(n, glm::cross(c, a)),
                 w = glm::dot(n, glm::cross(a, b));
    const double sum = u + v + w;
    if (u >= 0.0 && v >= 0.0 && w >= 0.0 && sum > 0.0) {
        TrianglePoint foot{.weight = dvec3{u, v, w} / sum};
        foot.place_m =
            foot.weight.x * corner[0] + foot.weight.y * corner[1] + foot.weight.z * corner[2];
        foot.distance2_m2 = square(place - foot.place_m);
        keep(foot);
    }
    return best;
}

/// The nearest points of two segments, as places along them (Ericson 5.1.9).
std::array<double, 2> nearest_of_segments(const dvec3& p, const dvec3& d, const dvec3& q,
                                          const dvec3& e) noexcept {
    const dvec3 r = p - q;
    const double dd = square(d), ee = square(e), de = glm::dot(d, e);
    const double dr = glm::dot(d, r), er = glm::dot(e, r);
    if (!(dd > 0.0))
        return {0.0, ee > 0.0 ? std::clamp(er / ee, 0.0, 1.0) : 0.0};
    if (!(ee > 0.0))
        return {std::clamp(-dr / dd, 0.0, 1.0), 0.0};
    const double cross2 = dd * ee - de * de;
    double s = cross2 > 0.0 ? std::clamp((de * er - dr * ee) / cross2, 0.0, 1.0) : 0.0;
    double t = (de * s + er) / ee;
    if (t < 0.0 || t > 1.0) {
        t = std::clamp(t, 0.0, 1.0);
        s = std::clamp((de * t - dr) / dd, 0.0, 1.0);
    }
    return {s, t};
}

void keep_nearer(SegmentPair& best, const SegmentPair& other) noexcept {
    if (other.on_triangle.distance2_m2 < best.on_triangle.distance2_m2)
        best = other;
}

/// How long two convex things stay apart if their corners' gaps along one direction change evenly.
struct Apart {
    double time = kInfinity;
    bool closing = false; // a gap that is used up gets smaller still

    /// Goes on to half of what is enough only: a point that rounding puts on the other side of a
    /// triangle would seem to leave it.
    void add(double gap, double rate, double enough) noexcept {
        if (!(rate < 0.0))
            return;
        time = std::min(time, std::max(gap - 0.5 * enough, 0.0) / -rate);
        closing = closing || gap <= enough;
    }
};

/// Whether the directions turned evenly from `n` to `n_end` keep two things farther apart than
/// `radius` all the while, where `from` and `to` are the ways between their corners, two by two, at
/// both ends. Along a direction that turns, each gap is a quadratic in time: it stays above its
/// Bernstein coefficients. A fixed direction would have a face that turns under a point which
/// hovers over it come through.
bool turn_apart(const dvec3& n, const dvec3& n_end, std::span<const dvec3> from,
                std::span<const dvec3> to, double radius) noexcept {
    for (std::size_t i = 0; i < from.size(); ++i) {
        const double middle = 0.5 * (glm::dot(n, to[i]) + glm::dot(n_end, from[i]));
        if (!(std::min({glm::dot(n, from[i]), middle, glm::dot(n_end, to[i])}) > radius))
            return false;
    }
    return true;
}

/// The gap at which things count as touching: a rounding of their coordinates, or a share of what
/// the question is about.
double enough_gap(const MovingTriangle& triangle, double coordinate_m, double motion_m,
                  double radius_m) noexcept {
    for (int k = 0; k < 3; ++k) {
        coordinate_m =
            std::max({coordinate_m, largest(triangle.before[k]), largest(triangle.after[k])});
        motion_m = std::max(motion_m, largest(triangle.after[k] - triangle.before[k]));
    }
    return 16.0 * std::numeric_limits<double>::epsilon() * coordinate_m +
           kSweepGap * std::min(motion_m, radius_m > 0.0 ? radius_m : motion_m);
}

/// Unit, from a place to the nearest point of the triangle. Straight across the face or the edge
/// that the point is on: the difference of two places that nearly meet has lost its direction in
/// the rounding of their coordinates, and a long triangle's far corners would seem to be in the way
/// or already passed.
dvec3 direction_to(const TrianglePoint& near, const TriangleCorners& corner, const dvec3& place,
                   double distance) noexcept {
    const dvec3 n = (near.place_m - place) / distance;
    const dvec3& w = near.weight;
    const int zeros = (w.x == 0.0) + (w.y == 0.0) + (w.z == 0.0);
    dvec3 across = n;
    if (zeros == 0) {
        const dvec3 face = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        across = glm::dot(face, corner[0] - place) < 0.0 ? -face : face;
    } else if (zeros == 1) {
        const int opposite = w.x == 0.0 ? 0 : w.y == 0.0 ? 1 : 2;
        const dvec3 edge = corner[(opposite + 2) % 3] - corner[(opposite + 1) % 3];
        across = n - glm::dot(n, edge) / square(edge) * edge;
    }
    const double length = glm::length(across);
    return length > 0.0 && std::isfinite(length) ? across / length : n;
}

/// The longest of the next 1, 1/2, 1/4 ... of the remaining time in which a turning direction keeps
/// a moving ball off the triangle; 0: none of them. `n`: the direction now.
double turning_advance(const MovingTriangle& triangle, const dvec3& from_m, const dvec3& motion,
                       double radius_m, double time, const dvec3& n) noexcept {
    const TriangleCorners now = triangle.at(time);
    const dvec3 centre = from_m + time * motion;
    for (double step = 1.0 - time; step > 1e-3; step *= 0.5) {
        const TriangleCorners end = triangle.at(time + step);
        const dvec3 centre_end = from_m + (time + step) * motion;
        const TrianglePoint near = nearest_on_triangle(end, centre_end);
        const double distance = std::sqrt(near.distance2_m2);
        if (!(distance > radius_m))
            continue;
        const std::array<dvec3, 3> from{now[0] - centre, now[1] - centre, now[2] - centre};
        const std::array<dvec3, 3> to{end[0] - centre_end, end[1] - centre_end,
                                      end[2] - centre_end};
        if (turn_apart(n, direction_to(near, end, centre_end, distance), from, to, radius_m))
            return step;
    }
    return 0.0;
}

} // namespace

TriangleCorners MovingTriangle::at(double time) const noexcept {
    TriangleCorners out;
    for (int k = 0; k < 3; ++k)
        out[k] = before[k] + time * (after[k] - before[k]);
    return out;
}

TrianglePoint nearest_on_triangle(const TriangleCorners& corner, const dvec3& place_m) noexcept {
    const dvec3 ab = corner[1] - corner[0], ac = corner[2] - corner[0];
    const dvec3 a = place_m - corner[0], b = place_m - corner[1], c = place_m - corner[2];
    const double a_ab = glm::dot(a, ab), a_ac = glm::dot(a, ac);
    if (a_ab <= 0.0 && a_ac <= 0.0)
        return {{1.0, 0.0, 0.0}, corner[0], square(a)};
    const double b_ab = glm::dot(b, ab), b_ac = glm::dot(b, ac);
    if (b_ab >= 0.0 && b_ac <= b_ab)
        return {{0.0, 1.0, 0.0}, corner[1], square(b)};
    const double c_ab = glm::dot(c, ab), c_ac = glm::dot(c, ac);
    if (c_ac >= 0.0 && c_ab <= c_ac)
        return {{0.0, 0.0, 1.0}, corner[2], square(c)};

    const double ab2 = square(ab), ac2 = square(ac), ab_ac = glm::dot(ab, ac);
    const double area2 = ab2 * ac2 - ab_ac * ab_ac;
    if (!(area2 > kSliver * ab2 * ac2))
        return on_sliver(corner, place_m);
    const double w_c = a_ab * b_ac - b_ab * a_ac;
    const double w_b = c_ab * a_ac - a_ab * c_ac;
    const double w_a = b_ab * c_ac - c_ab * b_ac;
    if (w_a > 0.0 && w_b > 0.0 && w_c > 0.0) {
        TrianglePoint out;
        const double scale = 1.0 / (w_a + w_b + w_c);
        out.weight = {w_a * scale, w_b * scale, w_c * scale};
        out.place_m = corner[0] + out.weight.y * ab + out.weight.z * ac;
        out.distance2_m2 = square(place_m - out.place_m);
        return out;
    }
    // beside one edge, or two at an obtuse corner: the nearer
    TrianglePoint best{.distance2_m2 = kInfinity};
    for (int edge = 0; edge < 3; ++edge) {
        const double beside = edge == 0 ? w_c : edge == 1 ? w_a : w_b;
        if (beside > 0.0)
            continue;
        if (const TrianglePoint other = on_edge(corner, edge, place_m);
            other.distance2_m2 < best.distance2_m2)
            best = other;
    }
    return best;
}

SegmentPair nearest_to_segment(const TriangleCorners& corner, const dvec3& from_m,
                               const dvec3& to_m) noexcept {
    const dvec3 d = to_m - from_m;
    const auto at = [&](double s) {
        const dvec3 place = from_m + s * d;
        return SegmentPair{nearest_on_triangle(corner, place), s, place};
    };
    SegmentPair best = at(0.0);
    keep_nearer(best, at(1.0));
    const dvec3 n = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double above = glm::dot(n, from_m - corner[0]), below = glm::dot(n, to_m - corner[0]);
    if ((above > 0.0 && below < 0.0) || (above < 0.0 && below > 0.0))
        keep_nearer(best, at(std::clamp(above / (above - below), 0.0, 1.0)));
    for (int k = 0; k < 3; ++k) {
        const dvec3 edge = corner[(k + 1) % 3] - corner[k];
        keep_nearer(best, at(nearest_of_segments(from_m, d, corner[k], edge)[0]));
    }
    return best;
}

TriangleSweep sweep_ball(const MovingTriangle& triangle, const dvec3& from_m, const dvec3& to_m,
                         double radius_m) noexcept {
    const dvec3 motion = to_m - from_m;
    const double enough =
        enough_gap(triangle, std::max(largest(from_m), largest(to_m)), largest(motion), radius_m);
    double time = 0.0;
    TriangleSweep out;
    for (int advance = 0; advance < kMostAdvances; ++advance) {
        const TriangleCorners corner = triangle.at(time);
        const dvec3 centre = from_m + time * motion;
        out.on_triangle = nearest_on_triangle(corner, centre);
        const double distance = std::sqrt(out.on_triangle.distance2_m2);
        if (!(distance > 0.0)) { // a point on the triangle: no direction keeps them apart
            out.time = time;
            return out;
        }
        const dvec3 n = direction_to(out.on_triangle, corner, centre, distance);
        Apart apart;
        for (int k = 0; k < 3; ++k)
            apart.add(glm::dot(n, corner[k] - centre) - radius_m,
                      glm::dot(n, triangle.after[k] - triangle.before[k] - motion), enough);
        if (distance - radius_m <= enough && apart.closing) {
            out.time = time;
            return out;
        }
        const double turned = advance < kPatience || apart.time > (1.0 - time) / 16.0
                                  ? 0.0
                                  : turning_advance(triangle, from_m, motion, radius_m, time, n);
        time += std::max(apart.time, turned);
        if (!(time < 1.0))
            return out;
    }
    out.time = time;
    return out;
}

TriangleSweep sweep_capsule(const MovingTriangle& triangle, const MovingSegment& s,
                            double radius_m) noexcept {
    const dvec3 move_from = s.from_after_m - s.from_before_m,
                move_to = s.to_after_m - s.to_before_m;
    const double coordinate = std::max({largest(s.from_before_m), largest(s.to_before_m),
                                        largest(s.from_after_m), largest(s.to_after_m)});
    const double enough =
        enough_gap(triangle, coordinate, std::max(largest(move_from), largest(move_to)), radius_m);
    double time = 0.0;
    TriangleSweep out;
    for (int advance = 0; advance < kMostAdvances; ++advance) {
        const TriangleCorners corner = triangle.at(time);
        const dvec3 from = s.from_before_m + time * move_from, to = s.to_before_m + time * move_to;
        const SegmentPair pair = nearest_to_segment(corner, from, to);
        out.on_triangle = pair.on_triangle;
        out.along = pair.along;
        const double distance = std::sqrt(pair.on_triangle.distance2_m2);
        if (!(distance > 0.0)) {
            out.time = time;
            return out;
        }
        const dvec3 n = (pair.on_triangle.place_m - pair.place_m) / distance;
        Apart apart;
        for (int k = 0; k < 3; ++k) {
            const dvec3 v = triangle.after[k] - triangle.before[k];
            apart.add(glm::dot(n, corner[k] - from) - radius_m, glm::dot(n, v - move_from), enough);
            apart.add(glm::dot(n, corner[k] - to) - radius_m, glm::dot(n, v - move_to), enough);
        }
        if (distance - radius_m <= enough && apart.closing) {
            out.time = time;
            return out;
        }
        time += apart.time;
        if (!(time <= 1.0))
            return out;
    }
    out.time = time;
    return out;
}

} // namespace haptics
