// tissue/solver/stress.h
// Von Mises stress of corotated tetrahedra, what the score calls how hard tissue was handled.
//   e = sym(R^T F) - I, sigma = 2 mu e + lambda tr(e) I, vm^2 = 3/2 dev(sigma) : dev(sigma)
// One value per tet: strain is constant in it. Rotating sigma changes nothing, so the solver's
// own sigma of S = R sym(R^T F) R^T serves, and linearize() keeps the peak as it passes. What a
// tip presses or pinches within less than a tet is not in it.
#pragma once

#include "tissue/solver/corotated.h"
#include "tissue/solver/quadratic.h"

namespace tissue {

/// Square of the von Mises stress of a symmetric tensor, in its unit squared.
inline double von_mises_squared(const glm::dmat3& s) noexcept {
    const double xy = s[0][0] - s[1][1], yz = s[1][1] - s[2][2], zx = s[2][2] - s[0][0];
    const double shear2 = s[1][0] * s[1][0] + s[2][1] * s[2][1] + s[2][0] * s[2][0];
    return 0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * shear2;
}

/// Into `out_pa`, one per tet, for any state; inverted tets have a finite value too. Costs a polar
/// rotation per tet: for tests and pictures, the loop reads CorotatedSystem::peak_von_mises_pa.
void von_mises_pa(const CorotatedModel& model, std::span<const glm::dvec3> position_m,
                  std::span<double> out_pa) noexcept;

/// Peak over the quadrature points of a quadratic body where its tangent was made last. Neo-Hooke:
/// dev(sigma) = J^(-5/3) dev(F M F^T), M = mu 1 without a memory; a point that is inside out counts
/// as 0.
double peak_von_mises_pa(const QuadraticModel& model, const QuadraticSystem& system) noexcept;

} // namespace tissue
