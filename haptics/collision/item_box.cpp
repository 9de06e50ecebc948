#include "haptics/collision/item_box.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace haptics {

using glm::dvec3;

ItemBox box_of(const MeshView& mesh, std::uint32_t triangle) noexcept {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const ItemBox empty{dvec3{kInfinity}, dvec3{-kInfinity}};
    ItemBox box = empty;
    dvec3 sum{0.0}; // not finite if a corner is not
    const auto add = [&](const std::array<dvec3, 3>& corner) {
        for (const dvec3& c : corner) {
            box.low_m = glm::min(box.low_m, c);
            box.high_m = glm::max(box.high_m, c);
            sum += c;
        }
    };
    add(mesh.corners(triangle));
    if (!mesh.before_m.empty())
        add(mesh.corners_before(triangle));
    return std::isfinite(sum.x + sum.y + sum.z) ? box : empty;
}

double average_edge_m(const MeshView& mesh) noexcept {
    double sum_m = 0.0;
    for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t) {
        const auto [a, b, c] = mesh.corners(t);
        sum_m += glm::length(b - a) + glm::length(c - b) + glm::length(a - c);
    }
    return mesh.triangle.empty() ? 0.0 : sum_m / (3.0 * static_cast<double>(mesh.triangle.size()));
}

} // namespace haptics
