// tissue/solver/quadratic_recovery.h
// What a quadratic body does while a tet of it is inside out, where neo-Hooke has no meaning: it
// moves as a linear body about its rest shape, turned as a whole. That energy is convex, so it
// leads out of any tangle. Internal to the quadratic solver.
#pragma once

#include "tissue/solver/quadratic.h"

namespace tissue {

/// Residual on the unknowns, from start_m and momentum_n, and QuadraticSystem::turned: 1 where
/// anything holds it, otherwise the rotation nearest to the motion since rest.
void linearize_recovering(const QuadraticModel& model, QuadraticSystem& system) noexcept;

/// A^-1 b in place, on the unknowns.
void solve_recovering(QuadraticSystem& system, std::span<double> b) noexcept;

} // namespace tissue
