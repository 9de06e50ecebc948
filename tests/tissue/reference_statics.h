// tests/tissue/reference_statics.h
// An independent solver for the statics of corotated linear tetrahedra, to test ours against.
// Nothing is shared with it but the mesh: the energy is written in principal stretches,
//   psi = mu sum (s_i - 1)^2 + lambda/2 (sum s_i - 3)^2,
// its gradient comes from the eigenvectors of F^T F, its tangent from differences of that
// gradient, the linear systems from a band Cholesky. Slow.
#pragma once

#include "tissue/mesh/tet_mesh.h"

#include <vector>

namespace reference {

struct Beam {
    tissue::TetMesh mesh;
    double lambda_pa, mu_pa, density_kgpm3;
    glm::dvec3 gravity_mps2;
    std::vector<std::uint8_t> anchored;
};

struct Equilibrium {
    std::vector<glm::dvec3> position_m;
    double relative_residual = 0.0; // |residual| / |weight|
    int iterations = 0;
};

/// Equilibrium under weight, reached in `load_steps` equal parts from rest.
Equilibrium solve(const Beam& beam, int load_steps, double tolerance);

} // namespace reference
