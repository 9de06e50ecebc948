#include "tasks/score/ideal_path.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace tasks {
namespace {

constexpr double kConverged_m = 1e-7; // a tenth of a micrometre: below the recording's resolution
constexpr int kMaxSweeps = 200;
constexpr int kGoldenSteps = 48; // interval shrinks by 0.618^48 = 1e-10

glm::dvec3 nearest_on_segment(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& p) {
    const glm::dvec3 ab = b - a;
    const double length2 = glm::dot(ab, ab);
    if (length2 == 0.0)
        return a;
    return a + std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) * ab;
}

// The point of the ball with the least |a - x| + |x - b|. If the straight way meets the ball, its
// point nearest to the centre; else on the sphere, in the plane of a, b and the centre, between
// the directions to a and to b, where the sum has one minimum.
glm::dvec3 best_in_ball(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& centre,
                        double radius) {
    const glm::dvec3 nearest = nearest_on_segment(a, b, centre);
    if (glm::distance(nearest, centre) <= radius)
        return nearest;
    const glm::dvec3 e = glm::normalize(a - centre), to_b = glm::normalize(b - centre);
    const glm::dvec3 side = to_b - glm::dot(to_b, e) * e;
    if (glm::length(side) < 1e-12)
        return centre + radius * e;
    const glm::dvec3 f = glm::normalize(side);
    const auto at = [&](double angle) {
        return centre + radius * (std::cos(angle) * e + std::sin(angle) * f);
    };
    const auto sum = [&](double angle) {
        const glm::dvec3 x = at(angle);
        return glm::distance(a, x) + glm::distance(x, b);
    };
    double low = 0.0, high = std::acos(std::clamp(glm::dot(e, to_b), -1.0, 1.0));
    constexpr double kGolden = 0.6180339887498949;
    for (int i = 0; i < kGoldenSteps; ++i) {
        const double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
        (sum(left) < sum(right) ? high : low) = sum(left) < sum(right) ? right : left;
    }
    return at(0.5 * (low + high));
}

double length_m(const std::vector<glm::dvec3>& corner) {
    double length = 0.0;
    for (std::size_t i = 1; i < corner.size(); ++i)
        length += glm::distance(corner[i - 1], corner[i]);
    return length;
}

} // namespace

double shortest_tour_m(const glm::dvec3& start_m, std::span<const glm::dvec3> centre_m,
                       double radius_m) {
    std::vector<glm::dvec3> corner{start_m};
    corner.insert(corner.end(), centre_m.begin(), centre_m.end());
    double before = length_m(corner);
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
        for (std::size_t i = 1; i < corner.size(); ++i) {
            // The last corner has no way on: straight towards the one before it.
            const glm::dvec3& on = i + 1 < corner.size() ? corner[i + 1] : corner[i - 1];
            corner[i] = best_in_ball(corner[i - 1], on, centre_m[i - 1], radius_m);
        }
        const double after = length_m(corner);
        if (before - after < kConverged_m)
            return after;
        before = after;
    }
    return before;
}

double retraction_tour_m(const glm::dvec3& fulcrum_m, const glm::dvec3& start_m,
                         std::span<const glm::dvec3> place_m, double radius_m) {
    const auto angle_between = [](const glm::dvec3& a, const glm::dvec3& b) {
        return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    };
    const double clear_m = glm::distance(start_m, fulcrum_m);
    double length = 0.0, depth_m = clear_m;
    glm::dvec3 from = start_m - fulcrum_m;
    for (const glm::dvec3& place : place_m) {
        const glm::dvec3 to = place - fulcrum_m;
        const double next_m = std::max(0.0, glm::length(to) - radius_m);
        const double swing_m = std::min({clear_m, depth_m, next_m});
        length += (depth_m - swing_m) + swing_m * angle_between(from, to) + (next_m - swing_m);
        depth_m = next_m;
        from = to;
    }
    return length;
}

} // namespace tasks
