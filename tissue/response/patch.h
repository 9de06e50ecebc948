// tissue/response/patch.h
// The part of a surface that a tool can reach before the next answer: triangles around a point,
// with their own short numbering. Gathered every FEM step; no allocation.
#pragma once

#include "tissue/mesh/contact_surface.h"

namespace tissue {

struct Patch {
    std::vector<std::uint32_t> vertex;                      // of the surface
    std::vector<std::uint32_t> triangle;                    // of the surface: stable ids
    std::vector<std::array<std::int16_t, 3>> corner;        // into vertex
    std::vector<std::array<std::int16_t, 3>> neighbour;     // into triangle, -1: rim
    std::vector<std::int32_t> vertex_local, triangle_local; // scratch, size of the surface, -1
    std::size_t max_vertices = 0, max_triangles = 0;
};
/// Throws std::invalid_argument if the limits do not fit 16 bits or hold no triangle.
Patch make_patch(const ContactSurface& surface, int max_vertices, int max_triangles);

/// Breadth first from `centre`, all triangles with a corner within `radius_m` of its centroid,
/// until the limits given to make_patch are reached. `centre` itself is always in, and first.
void gather_patch(const ContactSurface& surface, std::span<const glm::dvec3> position_m,
                  std::uint32_t centre, double radius_m, Patch& patch) noexcept;

} // namespace tissue
