#include "haptics/rigid/contact_patch.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace haptics {
namespace {

using glm::dvec3;

struct Polygon {
    std::array<dvec3, 258> corner; // seen from the first corner of all
    std::size_t count = 0;
};

// Where depth is above 0.
Polygon deep_part(std::span<const dvec3> corner_m, double first_depth_m,
                  const dvec3& slope) noexcept {
    Polygon part;
    const std::size_t n = std::min<std::size_t>(corner_m.size(), 256);
    for (std::size_t i = 0; i < n; ++i) {
        const dvec3 from = corner_m[i] - corner_m[0];
        const dvec3 to = corner_m[i + 1 == n ? 0 : i + 1] - corner_m[0];
        const double p = first_depth_m + glm::dot(slope, from);
        const double q = first_depth_m + glm::dot(slope, to);
        if (p > 0.0)
            part.corner[part.count++] = from;
        if ((p > 0.0) != (q > 0.0) && part.count < part.corner.size())
            part.corner[part.count++] = from + (to - from) * (p / (p - q));
    }
    return part;
}

} // namespace

ContactPatch part_in_contact(std::span<const dvec3> corner_m, const dvec3& normal,
                             double first_depth_m, const dvec3& slope) noexcept {
    ContactPatch patch{.normal = normal, .slope = slope};
    if (corner_m.size() < 3)
        return patch;
    const Polygon part = deep_part(corner_m, first_depth_m, slope);
    const dvec3 a = part.corner[0];
    dvec3 sum{0.0}; // centroid times area
    glm::dmat3 second{0.0};
    for (std::size_t i = 2; i < part.count; ++i) {
        const dvec3 b = part.corner[i - 1] - a, c = part.corner[i] - a;
        const double area_m2 = 0.5 * glm::length(glm::cross(b, c));
        patch.area_m2 += area_m2;
        sum += area_m2 / 3.0 * (b + c);
        // integral of x x^T over a triangle with a corner at 0
        second +=
            area_m2 / 12.0 *
            (glm::outerProduct(b, b) + glm::outerProduct(c, c) + glm::outerProduct(b + c, b + c));
    }
    if (!(patch.area_m2 > 0.0)) {
        patch.area_m2 = 0.0;
        return patch;
    }
    const dvec3 centroid = sum / patch.area_m2;
    patch.middle_m = corner_m[0] + a + centroid;
    patch.depth_m = first_depth_m + glm::dot(slope, a + centroid);
    patch.spread_m4 = second - patch.area_m2 * glm::outerProduct(centroid, centroid);
    return patch;
}

} // namespace haptics
