#include "haptics/collision/principal_axes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace haptics {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr int kSweeps = 12; // converges quadratically: six are plenty

/// Makes the element in row p, column q of a symmetric matrix zero by a turn, kept in `axes`
/// (Jacobi's method; Golub, Van Loan, Matrix Computations).
void turn(dmat3& m, dmat3& axes, int p, int q) {
    if (m[q][p] == 0.0)
        return;
    const double theta = (m[q][q] - m[p][p]) / (2.0 * m[q][p]);
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
    const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
    dmat3 turned{1.0};
    turned[p][p] = turned[q][q] = c;
    turned[q][p] = s;
    turned[p][q] = -s;
    m = glm::transpose(turned) * m * turned;
    axes = axes * turned;
}

dmat3 eigenvectors(dmat3 m) {
    dmat3 axes{1.0};
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (const auto& [p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}})
            turn(m, axes, p, q);
    std::array<int, 3> order{0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return m[a][a] > m[b][b]; });
    const dvec3 x = glm::normalize(axes[order[0]]);
    dvec3 y = axes[order[1]];
    y = glm::normalize(y - x * glm::dot(x, y));
    return {x, y, glm::cross(x, y)};
}

} // namespace

SurfaceSpread surface_spread(const MeshView& mesh, std::span<const std::uint32_t> triangle) {
    const dvec3 origin = mesh.corners(triangle[0])[0]; // far from 0, 0, 0 no digits are lost
    double area = 0.0, size2 = 0.0;
    for (const std::uint32_t t : triangle)
        for (const dvec3& c : mesh.corners(t))
            size2 = std::max(size2, glm::dot(c - origin, c - origin));
    dvec3 mean{0.0};
    dmat3 square{0.0};
    for (const std::uint32_t t : triangle) {
        const auto corner = mesh.corners(t);
        const dvec3 a = corner[0] - origin, b = corner[1] - origin, c = corner[2] - origin;
        // a little for what has no area
        const double weight = 0.5 * glm::length(glm::cross(b - a, c - a)) + 1e-9 * size2;
        area += weight;
        mean += weight * (a + b + c) / 3.0;
        const dvec3 sum = a + b + c; // the second moment of a triangle
        square += weight / 12.0 *
                  (glm::outerProduct(sum, sum) + glm::outerProduct(a, a) + glm::outerProduct(b, b) +
                   glm::outerProduct(c, c));
    }
    SurfaceSpread out{.axes = dmat3{1.0}, .mean_m = origin};
    if (!(area > 0.0))
        return out; // all corners in one place
    mean /= area;
    const dmat3 covariance = square / area - glm::outerProduct(mean, mean);
    const double largest = std::max({covariance[0][0], covariance[1][1], covariance[2][2]});
    out.mean_m = origin + mean;
    if (largest > 0.0)
        out.axes = eigenvectors(covariance / largest);
    return out;
}

} // namespace haptics
