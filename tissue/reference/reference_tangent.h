// tissue/reference/reference_tangent.h
// Newton's linear systems where the tangent changes little from one to the next: conjugate
// gradients with the factor of an earlier tangent as preconditioner. Of 100 000 unknowns a factor
// costs as much as some 30 products and solves. Internal to the reference solver.
#pragma once

#include "tissue/reference/reference.h"

namespace tissue {

/// Solves K step = right on the unknowns, K in ReferenceSystem::matrix, with the last factor, to
/// |residual| <= tolerance |right| in at most `products` products with K. Their number, or 0:
/// there is no factor, they did not suffice, or K is not positive definite on their way; `step` is
/// of no use then.
int solve_with_old_factor(const ReferenceModel& model, ReferenceSystem& system, int products,
                          double tolerance, std::span<const double> right, std::span<double> step);

} // namespace tissue
