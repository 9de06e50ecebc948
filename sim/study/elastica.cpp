// With k^2 = (1 + sin angle)/2 and sin phi = 1/(k sqrt 2):
//   sqrt(alpha) = K(k) - F(phi, k)
//   deflection  = 1 - 2 (E(k) - E(phi, k))/sqrt(alpha)
//   1 - shortening = sqrt(2 sin(angle)/alpha)
#include "sim/study/elastica.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace sim {
namespace {

struct Shape {
    double k = 0.0, phi_rad = 0.0, root_alpha = 0.0;
};

Shape shape_of(double angle_rad) {
    const double k = std::sqrt(0.5 * (1.0 + std::sin(angle_rad)));
    const double phi = std::asin(std::fmin(1.0, 1.0 / (k * std::sqrt(2.0))));
    return {k, phi, std::comp_ellint_1(k) - std::ellint_1(k, phi)};
}

} // namespace

Elastica elastica(double alpha) {
    if (!(alpha >= 0.0 && alpha <= 1e3))
        throw std::invalid_argument(fmt::format("alpha {:g}: accepted: from 0 to 1000", alpha));
    if (alpha < 1e-3) // differences of integrals round; the small deflection is right to alpha^2
        return {alpha / 3.0, alpha * alpha / 15.0, alpha / 2.0};
    double low = 0.0, high = 0.5 * 3.14159265358979323846;
    for (int i = 0; i < 80; ++i) {
        const double middle = 0.5 * (low + high);
        (shape_of(middle).root_alpha * shape_of(middle).root_alpha < alpha ? low : high) = middle;
    }
    const double angle = 0.5 * (low + high);
    const Shape s = shape_of(angle);
    const double root = std::sqrt(alpha);
    return {1.0 - 2.0 * (std::comp_ellint_2(s.k) - std::ellint_2(s.k, s.phi_rad)) / root,
            1.0 - std::sqrt(2.0 * std::sin(angle) / alpha), angle};
}

} // namespace sim
