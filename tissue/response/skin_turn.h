// tissue/response/skin_turn.h
// What a footprint row leaves out: a skin vertex stands off the mean of its nodes by an offset that
// turns with a triangle of them (contact_surface.h), so it moves when that triangle turns. At the
// edge of a body the offset is millimetres; forces there need the moment, and gaps the motion, else
// contact of edges swings from step to step. Tissue loop, real-time safe.
//   triangle with unit normal n, gradients g_i of its barycentric coordinates, offset o = R o_rest:
//   dn = -sum g_i (n . du_i),  turn about n: 1/2 sum n . (g_i x du_i)
//   d . dx = sum_i push_i . du_i,  push_i = -(g_i . (m x n)) n + 1/2 (n . m) n x g_i,  m = o x d
#pragma once

#include "tissue/response/contact_rows.h"

namespace tissue {

/// Of one vertex and one direction: what a unit force there adds on three nodes.
struct SkinTurn {
    std::array<std::uint32_t, 3> node{};
    std::array<glm::dvec3, 3> push{};
};

/// `place_m`: the vertex, nodes at `node_m`. Zero where the frame is degenerate or there is none.
SkinTurn skin_turn(const ContactSurface& surface, std::span<const glm::dvec3> node_m,
                   std::uint32_t vertex, const glm::dvec3& place_m,
                   const glm::dvec3& direction) noexcept;

void add_turn(Dofs dofs, const SkinTurn& turn, double scale, std::span<double> out) noexcept;
/// Motion of the vertex along the direction.
double turn_value(Dofs dofs, const SkinTurn& turn, std::span<const double> x) noexcept;

} // namespace tissue
