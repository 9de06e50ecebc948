#include "sim/study/mesh_sides.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace sim {
namespace {

using glm::dvec3;

constexpr double kAtCorner = 1e-9; // a weight below this is none

/// Unit normal by the winding; 0 without area.
dvec3 unit_normal(const haptics::TriangleCorners& c) noexcept {
    const dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
    const double length = glm::length(n);
    return length > 0.0 ? n / length : dvec3{0.0};
}

double angle_rad(const haptics::TriangleCorners& c, int k) noexcept {
    const dvec3 a = c[(k + 1) % 3] - c[k], b = c[(k + 2) % 3] - c[k];
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

} // namespace

MeshSides::MeshSides(std::span<const haptics::Corners> triangle, std::size_t vertices)
    : begin_(vertices + 1, 0), triangle_(3 * triangle.size()) {
    for (const auto& t : triangle)
        for (const std::uint32_t v : t)
            ++begin_[v + 1];
    for (std::size_t v = 0; v < vertices; ++v)
        begin_[v + 1] += begin_[v];
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t t = 0; t < triangle.size(); ++t)
        for (const std::uint32_t v : triangle[t])
            triangle_[next[v]++] = t;
}

std::span<const std::uint32_t> MeshSides::around(std::uint32_t vertex) const noexcept {
    return std::span(triangle_).subspan(begin_[vertex], begin_[vertex + 1] - begin_[vertex]);
}

int MeshSides::side_of(const haptics::MeshView& mesh, const haptics::SurfaceHit& nearest,
                       const dvec3& place_m) const noexcept {
    if (!nearest.hit())
        return 1;
    const haptics::Corners& t = mesh.triangle[nearest.triangle];
    std::array<std::uint32_t, 3> on{}; // the vertices that carry the nearest point
    int count = 0;
    for (int k = 0; k < 3; ++k)
        if (nearest.weight[k] > kAtCorner)
            on[count++] = t[k];
    dvec3 normal{0.0};
    if (count == 3) {
        normal = unit_normal(mesh.corners(nearest.triangle));
    } else {
        for (const std::uint32_t other : around(on[0])) {
            const haptics::Corners& o = mesh.triangle[other];
            const auto at = std::find(o.begin(), o.end(), on[0]) - o.begin();
            if (count == 2 && std::find(o.begin(), o.end(), on[1]) == o.end())
                continue;
            const haptics::TriangleCorners c = mesh.corners(other);
            normal += (count == 2 ? 1.0 : angle_rad(c, static_cast<int>(at))) * unit_normal(c);
        }
    }
    return glm::dot(place_m - nearest.place_m, normal) < 0.0 ? 0 : 1;
}

} // namespace sim
