// sim/study/geodesic.h
// The icosahedron with every face cut into n x n triangles, seen from its centre: which vertices a
// face's grid has, and in which triangle a direction lies, found without any search. Called by
// contact_workload; pure, any thread.
#pragma once

#include "haptics/collision/mesh_view.h"

#include <vector>

namespace sim {

/// 20 n^2 triangles, 10 n^2 + 2 vertices. Corners of the icosahedron come first, then the edges,
/// then the inner vertices face by face.
class Geodesic {
  public:
    /// Throws std::invalid_argument unless 1 <= cells <= 1000.
    explicit Geodesic(int cells);

    int cells() const noexcept { return cells_; }
    /// Unit directions of the vertices, by number.
    std::vector<glm::dvec3> directions() const;
    /// Face by face, row by row; counter-clockwise from outside.
    std::vector<haptics::Corners> triangles() const;
    /// The triangle whose cone from the centre holds this direction (of any length but 0): on flat
    /// faces a ray from the centre keeps its barycentric coordinates, so it is a division and a
    /// rounding. On an edge: one of those that share it.
    haptics::Corners corners_at(const glm::dvec3& direction) const noexcept;

  private:
    /// Of the place i/n of the way to the face's second corner and j/n to its third.
    std::uint32_t vertex(int face, int i, int j) const noexcept;
    haptics::Corners pointing_up(int face, int i, int j) const noexcept;
    haptics::Corners pointing_down(int face, int i, int j) const noexcept;

    int cells_;
    std::array<std::array<int, 3>, 20> edge_; // of each face: opposite to its corner
};

} // namespace sim
