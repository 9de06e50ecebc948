#include "haptics/rigid/triangle_nearest.h"

#include <glm/geometric.hpp>

namespace haptics {

glm::dvec3 nearest_on_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                               const glm::dvec3& place) noexcept {
    const glm::dvec3 ab = b - a, ac = c - a;
    // along the two edges from a, as seen from each corner
    const double ab_a = glm::dot(ab, place - a), ac_a = glm::dot(ac, place - a);
    if (ab_a <= 0.0 && ac_a <= 0.0)
        return a;
    const double ab_b = glm::dot(ab, place - b), ac_b = glm::dot(ac, place - b);
    if (ab_b >= 0.0 && ac_b <= ab_b)
        return b;
    const double at_c = ab_a * ac_b - ab_b * ac_a; // weights of the corners, times twice the area
    if (at_c <= 0.0 && ab_a >= 0.0 && ab_b <= 0.0)
        return a + ab * (ab_a / (ab_a - ab_b));
    const double ab_c = glm::dot(ab, place - c), ac_c = glm::dot(ac, place - c);
    if (ac_c >= 0.0 && ab_c <= ac_c)
        return c;
    const double at_b = ab_c * ac_a - ab_a * ac_c;
    if (at_b <= 0.0 && ac_a >= 0.0 && ac_c <= 0.0)
        return a + ac * (ac_a / (ac_a - ac_c));
    const double at_a = ab_b * ac_c - ab_c * ac_b;
    const double to_c = ac_b - ab_b, to_b = ab_c - ac_c;
    if (at_a <= 0.0 && to_c >= 0.0 && to_b >= 0.0)
        return b + (c - b) * (to_c / (to_c + to_b));
    return a + (ab * at_b + ac * at_c) / (at_a + at_b + at_c);
}

} // namespace haptics
