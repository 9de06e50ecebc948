#include "assets/bake/centreline.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace bake {
namespace {

using glm::dvec3;

constexpr int kPieces = 64; // per point, straight
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Catmull-Rom with knots at the roots of the chords, which has no loops and no cusps between the
// points (Yuksel et al. 2011), by Barry & Goldman's pyramid; u counts points.
dvec3 curve_mm(std::span<const dvec3> point, double u) {
    const auto i = std::min(static_cast<std::size_t>(u), point.size() - 2);
    const dvec3 &p1 = point[i], &p2 = point[i + 1];
    const dvec3 p0 = i > 0 ? point[i - 1] : 2.0 * p1 - p2; // the ends go on straight
    const dvec3 p3 = i + 2 < point.size() ? point[i + 2] : 2.0 * p2 - p1;
    const double t1 = std::sqrt(glm::distance(p0, p1)), t2 = t1 + std::sqrt(glm::distance(p1, p2)),
                 t3 = t2 + std::sqrt(glm::distance(p2, p3));
    const double t = t1 + (u - static_cast<double>(i)) * (t2 - t1);
    const dvec3 a1 = (t1 - t) / t1 * p0 + t / t1 * p1;
    const dvec3 a2 = ((t2 - t) * p1 + (t - t1) * p2) / (t2 - t1);
    const dvec3 a3 = ((t3 - t) * p2 + (t - t2) * p3) / (t3 - t2);
    const dvec3 b1 = (t2 - t) / t2 * a1 + t / t2 * a2;
    const dvec3 b2 = ((t3 - t) * a2 + (t - t1) * a3) / (t3 - t1);
    return ((t2 - t) * b1 + (t - t1) * b2) / (t2 - t1);
}

// The line as short straight pieces, and the way along it at each joint.
struct Pieces {
    std::vector<dvec3> place_mm;
    std::vector<double> way_mm;
};
Pieces pieces(std::span<const dvec3> point_mm) {
    Pieces line;
    const int count = kPieces * (static_cast<int>(point_mm.size()) - 1);
    for (int k = 0; k <= count; ++k) {
        line.place_mm.push_back(curve_mm(point_mm, static_cast<double>(k) / kPieces));
        line.way_mm.push_back(k == 0 ? 0.0
                                     : line.way_mm.back() +
                                           glm::distance(line.place_mm[k - 1], line.place_mm[k]));
    }
    return line;
}

dvec3 at_right_angles(const dvec3& along) {
    const dvec3 size = glm::abs(along);
    const dvec3 axis = size.x <= size.y && size.x <= size.z ? dvec3{1, 0, 0}
                       : size.y <= size.z                   ? dvec3{0, 1, 0}
                                                            : dvec3{0, 0, 1};
    return glm::normalize(axis - glm::dot(axis, along) * along);
}

// The frame of `a` carried to `b` by two reflections (Wang et al. 2008, double reflection).
dvec3 carried_side(const Station& a, const Station& b) {
    const auto mirror = [](const dvec3& v, const dvec3& n) {
        return v - 2.0 * glm::dot(n, v) / glm::dot(n, n) * n;
    };
    const dvec3 chord = b.place_mm - a.place_mm;
    const dvec3 side = mirror(a.side, chord), along = mirror(a.along, chord);
    const dvec3 rest = b.along - along;
    return glm::dot(rest, rest) > 0.0 ? mirror(side, rest) : side;
}

} // namespace

std::vector<Station> stations(std::span<const dvec3> point_mm, int count) {
    const Pieces line = pieces(point_mm);
    std::vector<Station> list;
    std::size_t piece = 0;
    for (int k = 0; k < count; ++k) {
        Station s;
        s.share = static_cast<double>(k) / (count - 1);
        const double way = s.share * line.way_mm.back();
        while (piece + 2 < line.way_mm.size() && line.way_mm[piece + 1] < way) {
            ++piece;
        }
        const double step = line.way_mm[piece + 1] - line.way_mm[piece];
        const double part = std::clamp((way - line.way_mm[piece]) / step, 0.0, 1.0);
        const double u = (static_cast<double>(piece) + part) / kPieces;
        const double last = static_cast<double>(point_mm.size() - 1), by = 0.5 / kPieces;
        s.place_mm = curve_mm(point_mm, std::min(u, last));
        s.along = glm::normalize(curve_mm(point_mm, std::min(u + by, last)) -
                                 curve_mm(point_mm, std::max(u - by, 0.0)));
        s.side = list.empty() ? at_right_angles(s.along) : carried_side(list.back(), s);
        s.side = glm::normalize(s.side - glm::dot(s.side, s.along) * s.along); // rounding
        s.up = glm::cross(s.along, s.side);
        list.push_back(s);
    }
    return list;
}

double line_length_mm(std::span<const dvec3> point_mm) {
    return pieces(point_mm).way_mm.back();
}

double tightest_bend_mm(std::span<const dvec3> point_mm) {
    const auto& p = pieces(point_mm).place_mm;
    double least = kInfinite;
    for (std::size_t k = 2; k < p.size(); ++k) { // circle through three points
        const dvec3 a = p[k - 1] - p[k - 2], b = p[k] - p[k - 1], c = p[k] - p[k - 2];
        const double twice_area = glm::length(glm::cross(a, b));
        const double product = glm::length(a) * glm::length(b) * glm::length(c);
        least = twice_area > 0.0 ? std::min(least, product / (2.0 * twice_area)) : least;
    }
    return least;
}

double nearest_return_mm(std::span<const dvec3> point_mm, double apart_mm) {
    const Pieces line = pieces(point_mm);
    double least = kInfinite;
    for (std::size_t i = 0; i < line.way_mm.size(); ++i) {
        for (std::size_t k = i + 1; k < line.way_mm.size(); ++k) {
            if (line.way_mm[k] - line.way_mm[i] > apart_mm) {
                least = std::min(least, glm::distance(line.place_mm[i], line.place_mm[k]));
            }
        }
    }
    return least;
}

} // namespace bake
