// tissue/material/hyperelastic.h
// Energy, first Piola stress and tangent of an elastic solid from its deformation gradient F, per
// rest volume. Called per quadrature point by the reference solver; any thread, no allocation.
//   small strain  psi = mu e:e + lambda/2 (tr e)^2, e = sym(F) - I. Not invariant under rotation
//   neo-Hooke     psi = mu/2 (J^-2/3 I1 - 3) + K/2 (J - 1)^2, I1 = |F|^2, J = det F
// The latter is NEO HOOKE of CalculiX and Abaqus with C10 = mu/2, D1 = 2/K (CalculiX 2.20 manual,
// *HYPERELASTIC). P = dpsi/dF, tangent = dP/dF.
#pragma once

#include "tissue/material/elastic.h"

#include <array>
#include <glm/mat3x3.hpp>

namespace tissue {

enum class Law { neo_hooke, small_strain };

struct Elasticity {
    Law law = Law::neo_hooke;
    double mu_pa = 0.0;   // shear modulus
    double bulk_pa = 0.0; // K = lambda + 2 mu/3
};

/// Both laws have the same linearisation at rest. Throws as lame() does.
Elasticity elasticity(const Material& material, Law law);

/// dP_i/dF_j in Pa, symmetric; i, j = 3 column + row, the order in which a dmat3 is stored.
using Tangent = std::array<std::array<double, 9>, 9>;

/// Infinite for neo-Hooke if det F <= 0.
double energy_density_jpm3(const Elasticity& e, const glm::dmat3& F) noexcept;

/// For neo-Hooke det F must be positive.
glm::dmat3 piola_stress_pa(const Elasticity& e, const glm::dmat3& F) noexcept;
Tangent piola_tangent_pa(const Elasticity& e, const glm::dmat3& F) noexcept;

/// The nearest positive semidefinite tangent: negative eigenvalues become 0 (Teran et al. 2005).
/// Eigenvectors by Jacobi's rotations.
void project_positive(Tangent& tangent) noexcept;

} // namespace tissue
