// tissue/baseline/tled.h
// Total Lagrangian explicit dynamics of linear tetrahedra (Miller, Joldes, Lance & Wittek 2007):
// shape functions of the rest shape, neo-Hooke as in material/hyperelastic.h, central differences,
// lumped masses, damping by mass. Called by studies and tests, see baseline.h.
//   (1 + alpha h/2) v_{n+1/2} = (1 - alpha h/2) v_{n-1/2} + h M^-1 (f - f_int(x_n))
//   x_{n+1} = x_n + h v_{n+1/2}
// The state holds v_n, halfway between the two: a half step opens and closes every substep, which
// is the same scheme. The critical step is of the rest shape and kept, as in the paper. P1
// elements: what settles is as locked as any P1 answer. Inverted tets do not return, see step().
#pragma once

#include "tissue/baseline/baseline.h"
#include "tissue/material/hyperelastic.h"

namespace tissue {

struct TledModel {
    CorotatedModel body;
    Elasticity elasticity;
    double critical_s = 0.0; // 2/omega_max at rest
    double substep_s = 0.0;  // the longest that step() takes, kCourant of it
};

/// Throws as make_corotated().
TledModel make_tled(const TetMesh& mesh, const Material& material,
                    std::span<const std::uint8_t> anchored,
                    const glm::dvec3& gravity_mps2 = glm::dvec3{0.0});
BaselineScratch make_scratch(const TledModel& model);

/// `load_n` per node, constant during the step; may be empty. The stress is continued to det F < 0
/// by the real cube root: a wall without bound at det F = 0 keeps a tet on the side where it is,
/// and what starts at the wall ends as no number.
BaselineReport step(const TledModel& model, std::span<const glm::dvec3> load_n, double dt_s,
                    BaselineScratch& scratch, BaselineState& state) noexcept;

/// Elastic force of the tets on every node, with the sign of f_int.
void elastic_forces(const TledModel& model, const BaselineState& state,
                    std::span<glm::dvec3> force_n) noexcept;
/// Infinite if a tet is inverted.
double elastic_energy_j(const TledModel& model, const BaselineState& state) noexcept;

} // namespace tissue
