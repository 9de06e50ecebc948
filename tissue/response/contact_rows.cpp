// tissue/response/contact_rows.cpp
// Rows of contact points: a barycentric mix of three footprint rows. Tissue loop, every step.
#include "tissue/response/contact_rows.h"

namespace tissue {

using glm::dvec3;

void add_vertex_row(Dofs dofs, const ContactSurface& surface, std::uint32_t vertex,
                    const dvec3& scaled, std::span<double> out) noexcept {
    for (std::uint32_t k = surface.row_start[vertex]; k < surface.row_start[vertex + 1]; ++k) {
        const std::int32_t dof = dofs[surface.row_node[k]];
        if (dof < 0)
            continue; // an anchored node takes its share and does not move
        const double w = surface.row_weight[k];
        out[dof] += w * scaled.x;
        out[dof + 1] += w * scaled.y;
        out[dof + 2] += w * scaled.z;
    }
}

void add_row(Dofs dofs, const ContactSurface& surface, const ContactPoint& at,
             const dvec3& direction, double scale, std::span<double> out) noexcept {
    const Triangle& t = surface.triangles[at.triangle];
    for (int corner = 0; corner < 3; ++corner) {
        add_vertex_row(dofs, surface, t[corner], scale * at.weight[corner] * direction, out);
    }
}

dvec3 vertex_value(Dofs dofs, const ContactSurface& surface, std::uint32_t vertex,
                   std::span<const double> x) noexcept {
    dvec3 sum{0.0};
    for (std::uint32_t k = surface.row_start[vertex]; k < surface.row_start[vertex + 1]; ++k) {
        const std::int32_t dof = dofs[surface.row_node[k]];
        if (dof < 0)
            continue;
        sum += surface.row_weight[k] * dvec3{x[dof], x[dof + 1], x[dof + 2]};
    }
    return sum;
}

dvec3 row_value(Dofs dofs, const ContactSurface& surface, const ContactPoint& at,
                std::span<const double> x) noexcept {
    const Triangle& t = surface.triangles[at.triangle];
    dvec3 sum{0.0};
    for (int corner = 0; corner < 3; ++corner) {
        sum += at.weight[corner] * vertex_value(dofs, surface, t[corner], x);
    }
    return sum;
}

} // namespace tissue
