// tissue/response/linear_statics.h
// Linear elasticity on linear (4 nodes) or quadratic (10 nodes, straight edges) tetrahedra, at
// rest, with Young's modulus 1: what a kernel's own compliance is on either. Called by
// mesh_term.cpp at bake time and by tests; any thread, not real time.
#pragma once

#include "tissue/mesh/elastic_bed.h"
#include "tissue/mesh/tet_mesh.h"
#include "tissue/solver/sparse_factor.h"

namespace tissue {

struct LinearStatics {
    int order = 1;                                 // 1 linear, 2 quadratic
    std::vector<std::array<std::uint32_t, 3>> mid; // quadratic: edge (low, high), its node; sorted
    std::vector<std::int32_t> dof;                 // per node, first of 3 unknowns; -1: fixed
    int unknowns = 0;
    SparsePattern pattern;
    std::vector<double> stiffness_m; // K / E on the pattern, metres
};

/// Nodes are numbered as in quadratic_mesh(). A mid-edge node is fixed where
/// both ends are, so that the linear shapes stay a subspace of the quadratic ones. `bed`: what
/// holds the body elastically, seen by both orders at the same points for the same reason.
/// Throws std::invalid_argument for an order or a Poisson's ratio out of range.
LinearStatics make_linear_statics(const TetMesh& mesh, int order, double poisson,
                                  std::span<const std::uint8_t> anchored,
                                  std::span<const BedSample> bed = {});

/// Shape functions at a place on a boundary triangle: 3 or 6 entries (linear: the rest is 0).
struct SurfaceShape {
    std::array<std::uint32_t, 6> node{};
    std::array<double, 6> value{};
    int count = 0;
};
SurfaceShape surface_shape(const LinearStatics& statics, const Triangle& triangle,
                           const glm::dvec3& weight);

} // namespace tissue
