// tissue/baseline/xpbd.h
// Extended position based dynamics (Macklin, Mueller & Chentanez 2016) of neo-Hookean tetrahedra
// (Macklin & Mueller 2021) in small steps (Macklin et al. 2019): one Gauss-Seidel sweep a substep.
// Called by studies and tests, see baseline.h.
//   psi = mu/2 (I1 - 3) + lambda'/2 (J - 1 - mu/lambda')^2, I1 = |F|^2, J = det F
//   C_D = sqrt(I1), compliance 1/(mu V);  C_H = J - 1 - mu/lambda', compliance 1/(lambda' V)
//   dl = -(C + l a/h^2) / (sum w |grad C|^2 + a/h^2),  x += w grad C dl
// lambda' = lambda + mu gives psi the tangent of linear elasticity at rest (Smith, de Goes & Kim
// 2018); with Lame's lambda itself it would be softer in volume by mu.
// The two constraints of a tet pull against each other also at rest, each along its gradient where
// the one before had left the tet, and multipliers begin every substep at 0. More sweeps make
// C + l a/h^2 vanish, but do not bring x to where M (x - x~) = h^2 times the forces at x: that
// error goes with h^2 alone, in units of the tet's own time, so a coarse step or a fine mesh is
// soft, and crooked.
#pragma once

#include "tissue/baseline/baseline.h"

namespace tissue {

struct XpbdModel {
    CorotatedModel body;
    double lambda_pa = 0.0; // lambda' above
    int substeps = 10;      // of every step
    int sweeps = 1;         // of every substep
};

/// Throws as make_corotated().
XpbdModel make_xpbd(const TetMesh& mesh, const Material& material,
                    std::span<const std::uint8_t> anchored,
                    const glm::dvec3& gravity_mps2 = glm::dvec3{0.0});
BaselineScratch make_scratch(const XpbdModel& model);

/// `load_n` per node, constant during the step; may be empty.
BaselineReport step(const XpbdModel& model, std::span<const glm::dvec3> load_n, double dt_s,
                    BaselineScratch& scratch, BaselineState& state) noexcept;

/// V psi over the tets, J, less what it is at rest.
double elastic_energy_j(const XpbdModel& model, const BaselineState& state) noexcept;

} // namespace tissue
