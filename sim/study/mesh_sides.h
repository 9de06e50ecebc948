// sim/study/mesh_sides.h
// On which side of a mesh file's surface a place is, for judging contact methods on meshes whose
// making is not known. Called by the contact bench; pure, any thread.
#pragma once

#include "haptics/collision/queries.h"

#include <vector>

namespace sim {

/// By the nearest point of a closed mesh that is wound outward: 1 outside, 0 within. At an edge or
/// a vertex by the angle-weighted pseudonormal of the triangles that meet there (Baerentzen, Aanaes
/// 2005, Signed Distance Computation Using the Angle Weighted Pseudonormal). Of a mesh that is open
/// the answer is that of the nearest triangle's winding.
class MeshSides {
  public:
    /// Setup: which triangles meet at a vertex. The triangles must stay where they are.
    MeshSides(std::span<const haptics::Corners> triangle, std::size_t vertices);
    /// `nearest`: of the place. No hit: outside.
    int side_of(const haptics::MeshView& mesh, const haptics::SurfaceHit& nearest,
                const glm::dvec3& place_m) const noexcept;

  private:
    std::span<const std::uint32_t> around(std::uint32_t vertex) const noexcept;
    std::vector<std::uint32_t> begin_, triangle_; // vertex v: triangle_[begin_[v] .. begin_[v+1])
};

} // namespace sim
