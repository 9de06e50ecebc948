#include "haptics/contact/coulomb_disc.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace haptics {
namespace {

double square(double v) noexcept {
    return v * v;
}

} // namespace

DiscPoint disc_minimum(const glm::dmat2& A, const glm::dvec2& b, double radius) noexcept {
    if (!(radius > 0.0))
        return {glm::dvec2{0.0}, std::numeric_limits<double>::infinity()};

    // eigenvalues and the first eigenvector (c, s)
    const double mean = 0.5 * (A[0][0] + A[1][1]);
    const double half = 0.5 * (A[0][0] - A[1][1]);
    const double spread = std::hypot(half, A[1][0]);
    const double angle = 0.5 * std::atan2(A[1][0], half);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double l1 = std::max(mean + spread, 1e-15);
    const double l2 = std::max(mean - spread, 1e-15);
    const double b1 = c * b.x + s * b.y;
    const double b2 = c * b.y - s * b.x;

    double multiplier = 0.0;
    if (std::hypot(b1 / l1, b2 / l2) > radius) {
        multiplier = std::max(0.0, std::hypot(b1, b2) / radius - l1);
        for (int i = 0; i < 50; ++i) {
            const double f1 = b1 / (l1 + multiplier);
            const double f2 = b2 / (l2 + multiplier);
            const double length = std::hypot(f1, f2);
            const double change = (length - radius) / radius * square(length) /
                                  (square(f1) / (l1 + multiplier) + square(f2) / (l2 + multiplier));
            multiplier += change;
            if (!(change > 1e-15 * multiplier))
                break;
        }
    }
    glm::dvec2 f{b1 / (l1 + multiplier), b2 / (l2 + multiplier)};
    if (multiplier > 0.0)
        f *= radius / std::max(glm::length(f), 1e-300);
    return {{c * f.x - s * f.y, s * f.x + c * f.y}, multiplier};
}

} // namespace haptics
