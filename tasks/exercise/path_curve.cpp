#include "tasks/exercise/path_curve.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tasks {
namespace {

using glm::dvec3;

// Centripetal knots: the root of the chord. Coincident points keep a knot apart.
double knot_step(const dvec3& a, const dvec3& b) noexcept {
    return std::max(std::sqrt(glm::distance(a, b)), 1e-6);
}

// Barry & Goldman's pyramid on p1..p2 at share s.
dvec3 between(const dvec3& p0, const dvec3& p1, const dvec3& p2, const dvec3& p3,
              double s) noexcept {
    const double t1 = knot_step(p0, p1), t2 = t1 + knot_step(p1, p2), t3 = t2 + knot_step(p2, p3);
    const double t = t1 + s * (t2 - t1);
    const dvec3 a1 = (t1 - t) / t1 * p0 + t / t1 * p1;
    const dvec3 a2 = ((t2 - t) * p1 + (t - t1) * p2) / (t2 - t1);
    const dvec3 a3 = ((t3 - t) * p2 + (t - t2) * p3) / (t3 - t2);
    const dvec3 b1 = (t2 - t) / t2 * a1 + t / t2 * a2;
    const dvec3 b2 = ((t3 - t) * a2 + (t - t1) * a3) / (t3 - t1);
    return ((t2 - t) * b1 + (t - t1) * b2) / (t2 - t1);
}

double end_of(std::span<const dvec3> point_m) noexcept {
    return point_m.empty() ? 0.0 : static_cast<double>(point_m.size() - 1);
}

// Nearest places of two segments (Ericson 2005, 5.1.9): share of p-q, squared distance.
struct Near {
    double share = 0.0, distance2_m2 = 0.0;
};
Near nearest_of_segments(const dvec3& p, const dvec3& q, const dvec3& a, const dvec3& b) noexcept {
    const dvec3 d1 = q - p, d2 = b - a, r = p - a;
    const double e1 = glm::dot(d1, d1), e2 = glm::dot(d2, d2), f = glm::dot(d2, r);
    const double c = glm::dot(d1, r), m = glm::dot(d1, d2);
    double s = 0.0, t = 0.0;
    if (e1 > 0.0) {
        const double det = e1 * e2 - m * m;
        s = det > 1e-12 * e1 * e2 ? std::clamp((m * f - c * e2) / det, 0.0, 1.0) : 0.0;
    }
    t = e2 > 0.0 ? std::clamp((m * s + f) / e2, 0.0, 1.0) : 0.0;
    if (e1 > 0.0)
        s = std::clamp((m * t - c) / e1, 0.0, 1.0);
    const dvec3 apart = r + s * d1 - t * d2;
    return {s, glm::dot(apart, apart)};
}

} // namespace

dvec3 curve_at(std::span<const dvec3> point_m, double u) noexcept {
    if (point_m.size() < 2)
        return point_m.empty() ? dvec3{0.0} : point_m[0];
    const double at = std::clamp(u, 0.0, end_of(point_m));
    const auto i = std::min(static_cast<std::size_t>(at), point_m.size() - 2);
    const dvec3 &p1 = point_m[i], &p2 = point_m[i + 1];
    const dvec3 p0 = i > 0 ? point_m[i - 1] : 2.0 * p1 - p2;
    const dvec3 p3 = i + 2 < point_m.size() ? point_m[i + 2] : 2.0 * p2 - p1;
    return between(p0, p1, p2, p3, at - static_cast<double>(i));
}

double curve_length_m(std::span<const dvec3> point_m, double u) noexcept {
    const double end = std::clamp(u, 0.0, end_of(point_m));
    const int whole = static_cast<int>(end * kPiecesPerPoint);
    double sum_m = 0.0;
    dvec3 before = curve_at(point_m, 0.0);
    for (int k = 1; k <= whole; ++k) {
        const dvec3 now = curve_at(point_m, static_cast<double>(k) / kPiecesPerPoint);
        sum_m += glm::distance(before, now);
        before = now;
    }
    return sum_m + glm::distance(before, curve_at(point_m, end));
}

double curve_step(std::span<const dvec3> point_m, double from_u, double way_m) noexcept {
    const double end = end_of(point_m);
    const double sign = way_m < 0.0 ? -1.0 : 1.0;
    double left_m = std::abs(way_m), u = std::clamp(from_u, 0.0, end);
    const double step = sign / kPiecesPerPoint;
    while (left_m > 0.0) {
        const double next = std::clamp(u + step, 0.0, end);
        const double piece_m = glm::distance(curve_at(point_m, u), curve_at(point_m, next));
        if (next == u)
            return u;
        if (piece_m >= left_m)
            return u + (next - u) * left_m / piece_m;
        left_m -= piece_m;
        u = next;
    }
    return u;
}

NearCurve nearest_on_curve(std::span<const dvec3> point_m, const dvec3& a, const dvec3& b,
                           double first, double last) noexcept {
    const double low = std::clamp(first, 0.0, end_of(point_m));
    const double high = std::clamp(last, low, end_of(point_m));
    const auto pieces = std::max(1, static_cast<int>(std::ceil((high - low) * kPiecesPerPoint)));
    NearCurve best;
    double least2_m2 = -1.0;
    dvec3 before = curve_at(point_m, low);
    for (int k = 0; k < pieces; ++k) {
        const double u0 = low + (high - low) * k / pieces;
        const double u1 = low + (high - low) * (k + 1) / pieces;
        const dvec3 now = curve_at(point_m, u1);
        const Near near = nearest_of_segments(before, now, a, b);
        if (least2_m2 < 0.0 || near.distance2_m2 < least2_m2) {
            least2_m2 = near.distance2_m2;
            best.u = u0 + near.share * (u1 - u0);
        }
        before = now;
    }
    best.distance_m = std::sqrt(std::max(least2_m2, 0.0));
    return best;
}

} // namespace tasks
