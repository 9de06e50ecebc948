#include "haptics/contact/vertex_normals.h"

#include "haptics/contact/proxy_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptics {

void angle_weighted_normals(const MeshView& mesh, std::span<glm::dvec3> normal) noexcept {
    std::fill(normal.begin(), normal.end(), glm::dvec3{0.0});
    for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t) {
        const TriangleCorners c = mesh.corners(t);
        const glm::dvec3 n = facing(c);
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 a = c[(k + 1) % 3] - c[k], b = c[(k + 2) % 3] - c[k];
            const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
            normal[mesh.triangle[t][k]] += angle * n;
        }
    }
    for (glm::dvec3& n : normal) {
        const double length = glm::length(n);
        n = length > 0.0 ? n / length : glm::dvec3{0.0};
    }
}

} // namespace haptics
