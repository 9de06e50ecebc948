// tissue/response/contact_rows.h
// Rows of the contact points on the unknowns of a body, and what pushing there does.
// A contact point lies on a triangle of the ContactSurface; its row is the barycentric mix of
// the footprint rows of the three corners, times a direction.
#pragma once

#include "tissue/mesh/contact_surface.h"

#include <span>

namespace tissue {

/// Of each node, the first of its 3 unknowns; -1: anchored. Every solver numbers them so.
using Dofs = std::span<const std::int32_t>;

struct ContactPoint {
    std::uint32_t triangle = 0;
    glm::dvec3 weight{1.0, 0.0, 0.0}; // barycentric
};

/// out += scale * sum_i w_i direction on the unknowns of node i. `out`: one right-hand side.
void add_row(Dofs dofs, const ContactSurface& surface, const ContactPoint& at,
             const glm::dvec3& direction, double scale, std::span<double> out) noexcept;

/// The same for one vertex of the surface: out += sum_i w_i scaled.
void add_vertex_row(Dofs dofs, const ContactSurface& surface, std::uint32_t vertex,
                    const glm::dvec3& scaled, std::span<double> out) noexcept;

/// Motion of the contact point for a vector of unknowns: sum_i w_i x_i.
glm::dvec3 row_value(Dofs dofs, const ContactSurface& surface, const ContactPoint& at,
                     std::span<const double> x) noexcept;

/// The same for one vertex of the surface.
glm::dvec3 vertex_value(Dofs dofs, const ContactSurface& surface, std::uint32_t vertex,
                        std::span<const double> x) noexcept;

} // namespace tissue
