// See the header.
#include "tissue/response/skin_turn.h"

#include <glm/geometric.hpp>

namespace tissue {

using glm::dvec3;

SkinTurn skin_turn(const ContactSurface& surface, std::span<const dvec3> node_m,
                   std::uint32_t vertex, const dvec3& place_m, const dvec3& direction) noexcept {
    SkinTurn out;
    if (surface.frame_node.empty())
        return out;
    dvec3 mean_m{0.0};
    for (std::uint32_t k = surface.row_start[vertex]; k < surface.row_start[vertex + 1]; ++k)
        mean_m += surface.row_weight[k] * node_m[surface.row_node[k]];
    out.node = surface.frame_node[vertex];
    const dvec3 &a = node_m[out.node[0]], &b = node_m[out.node[1]], &c = node_m[out.node[2]];
    const dvec3 area = glm::cross(b - a, c - a);
    const double size = glm::length(area);
    if (!(size > 0.0))
        return out;
    const dvec3 n = area / size, m = glm::cross(place_m - mean_m, direction);
    const dvec3 across = glm::cross(m, n);
    const double about = 0.5 * glm::dot(n, m);
    const std::array<dvec3, 3> opposite{c - b, a - c, b - a};
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 g = glm::cross(n, opposite[i]) / size;
        out.push[i] = -glm::dot(g, across) * n + about * glm::cross(n, g);
    }
    return out;
}

void add_turn(Dofs dofs, const SkinTurn& turn, double scale, std::span<double> out) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t dof = dofs[turn.node[i]];
        if (dof < 0)
            continue;
        for (int k = 0; k < 3; ++k)
            out[dof + k] += scale * turn.push[i][k];
    }
}

double turn_value(Dofs dofs, const SkinTurn& turn, std::span<const double> x) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t dof = dofs[turn.node[i]];
        if (dof >= 0)
            sum += glm::dot(turn.push[i], dvec3{x[dof], x[dof + 1], x[dof + 2]});
    }
    return sum;
}

} // namespace tissue
