#include "tissue/solver/tangle.h"

#include "tissue/solver/corotated_element.h"

#include <algorithm>

namespace tissue {
namespace {

// Disjoint sets with path halving (Tarjan & van Leeuwen 1984); the lowest node stands for its set.
std::int32_t standing_for(std::vector<std::int32_t>& node, std::int32_t i) noexcept {
    while (node[i] != i)
        i = node[i] = node[node[i]];
    return i;
}

void join(std::vector<std::int32_t>& node, const Tet& tet) noexcept {
    for (const std::uint32_t corner : tet)
        if (node[corner] < 0)
            node[corner] = static_cast<std::int32_t>(corner);
    for (int a = 1; a < 4; ++a) {
        const std::int32_t one = standing_for(node, static_cast<std::int32_t>(tet[0]));
        const std::int32_t other = standing_for(node, static_cast<std::int32_t>(tet[a]));
        node[std::max(one, other)] = std::min(one, other);
    }
}

} // namespace

Tangles make_tangles(const CorotatedModel& model) {
    const std::size_t nodes = model.dof.size();
    return {.node = std::vector<std::int32_t>(nodes, -1),
            .rotation = std::vector<glm::dmat3>(nodes)};
}

void find_tangles(const CorotatedModel& model, std::span<const glm::dvec3> position_m,
                  Tangles& tangles) noexcept {
    tangles.inverted = 0;
    std::fill(tangles.node.begin(), tangles.node.end(), -1);
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        if (determinant(deformation_gradient(model, e, position_m)) > 0.0)
            continue;
        ++tangles.inverted;
        join(tangles.node, model.mesh.tets[e]);
    }
    if (tangles.inverted == 0)
        return;
    for (std::size_t i = 0; i < tangles.node.size(); ++i) {
        if (tangles.node[i] >= 0)
            tangles.node[i] = standing_for(tangles.node, static_cast<std::int32_t>(i));
        tangles.rotation[i] = glm::dmat3(0.0);
    }
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        for (const std::uint32_t corner : model.mesh.tets[e]) {
            if (tangles.node[corner] < 0)
                continue;
            tangles.rotation[tangles.node[corner]] +=
                model.volume_m3[e] * deformation_gradient(model, e, position_m);
            break;
        }
    }
    for (std::size_t i = 0; i < tangles.node.size(); ++i)
        if (tangles.node[i] == static_cast<std::int32_t>(i))
            tangles.rotation[i] = closest_rotation(tangles.rotation[i]);
}

} // namespace tissue
