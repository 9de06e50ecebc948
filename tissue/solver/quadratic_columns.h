// tissue/solver/quadratic_columns.h
// Many right-hand sides of a quadratic body at its last linearisation, sixteen side by side: the
// rows of a contact and the basis of the local model need dozens in a step. Called by
// tissue/solver/solid.cpp and tissue/response/quadratic_basis.cpp in the tissue loop.
// Each column has conjugate gradients of its own with the preconditioner of quadratic_linear.cpp;
// what is shared is reading: a number of the factor, or of a tet, meets sixteen columns at once.
#pragma once

#include "tissue/solver/quadratic.h"

namespace tissue {

/// At setup; `order`: unknown that is eliminated k-th.
BlockScratch make_block_scratch(const QuadraticModel& model, std::span<const int> order);

struct ColumnsReport {
    int iterations = 0;             // of each group of sixteen, added up
    double relative_residual = 0.0; // |A x - b| / |b|, the worst
    bool projected = false;         // A was indefinite, see LinearReport
};

/// M-orthonormal modes in which K is `lambda`, near enough: later solves, of one column too, start
/// from their answer V (V^T A V)^-1 V^T b until others are given. A contact basis holds the answers
/// to the loads of a step before, so half of the iterations go where a body is deformed, and what
/// is solved roughly in every step converges over the steps. One mode after the other on the
/// unknowns; none: nothing is known. Bits then depend on the modes, but all else does not.
void remember_modes(const QuadraticModel& model, std::span<const double> shape,
                    std::span<const double> lambda, QuadraticSystem& system) noexcept;

/// Leaves `share` of the geometric stiffness in the tangent: without any, A is positive definite.
/// In quadratic_linear.cpp.
void scale_geometric_stiffness(float share, QuadraticSystem& system) noexcept;

/// A X = B in place, `columns` columns on the unknowns, one after the other. A column stops at the
/// tolerance, whatever the others do; its answer does not depend on them unless A is indefinite on
/// one of them: then its group begins again without (half of) the geometric stiffness, as in
/// solve(), and so do later groups. `residual`: of each column, or empty. `first`: what to start
/// from instead of the known modes, as `block`, or empty. A recovering body solves exactly. No
/// allocation, here and below.
ColumnsReport solve_columns(const QuadraticModel& model, const QuadraticOptions& options,
                            QuadraticSystem& system, std::span<double> block, int columns,
                            std::span<double> residual = {},
                            std::span<const double> first = {}) noexcept;

/// X <- A0^-1 B, A0 what approximates A: the preconditioner of the solve alone.
void precondition_columns(const QuadraticModel& model, QuadraticSystem& system,
                          std::span<double> block, int columns) noexcept;

/// Y = K X, K at the last linearisation, in single precision. A recovering body: as at rest.
void stiffness_products(const QuadraticModel& model, std::span<const double> x, int columns,
                        QuadraticSystem& system, std::span<double> y) noexcept;
/// Y = M X, in double.
void mass_products(const QuadraticModel& model, std::span<const double> x, int columns,
                   QuadraticSystem& system, std::span<double> y) noexcept;

} // namespace tissue
