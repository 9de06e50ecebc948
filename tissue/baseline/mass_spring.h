// tissue/baseline/mass_spring.h
// Masses at the nodes, springs along the edges of the tets, symplectic Euler. Called by studies and
// tests, see baseline.h.
//   k = sum over the tets of an edge of (24/25) E V / l^2
// On regular tets that is (2 sqrt(2)/25) E l per tet, the stiffness nearest to that of linear
// elements in the Frobenius norm (Lloyd, Szekely & Harders 2007); written with the volume it is the
// weighting that Van Gelder (1998) gives for tets of any shape. Central forces leave one modulus
// free: averaged over directions lambda = mu (Cauchy 1828), so Poisson's ratio is 1/4 whatever the
// material says. Springs do not know which side of a face a node is on: a mirrored tet rests.
#pragma once

#include "tissue/baseline/baseline.h"

namespace tissue {

struct Spring {
    std::uint32_t a = 0, b = 0;
    double rest_m = 0.0, npm = 0.0;
};

struct MassSpringModel {
    CorotatedModel body;
    std::vector<Spring> springs{}; // ordered by a, then b
    double critical_s = 0.0;       // 2/omega_max at rest; a pulled spring is stiffer sideways
    double substep_s = 0.0;        // the longest that step() takes, kCourant of it
};

/// Throws as make_corotated().
MassSpringModel make_mass_spring(const TetMesh& mesh, const Material& material,
                                 std::span<const std::uint8_t> anchored,
                                 const glm::dvec3& gravity_mps2 = glm::dvec3{0.0});
BaselineScratch make_scratch(const MassSpringModel& model);

/// `load_n` per node, constant during the step; may be empty.
BaselineReport step(const MassSpringModel& model, std::span<const glm::dvec3> load_n, double dt_s,
                    BaselineScratch& scratch, BaselineState& state) noexcept;

/// Of the springs on every node, with the sign of f_int.
void elastic_forces(const MassSpringModel& model, const BaselineState& state,
                    std::span<glm::dvec3> force_n) noexcept;
double elastic_energy_j(const MassSpringModel& model, const BaselineState& state) noexcept;

} // namespace tissue
