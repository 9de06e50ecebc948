// tissue/solver/quadratic_refactor.h
// A new factor for the preconditioner of a quadratic body, at the tangent where it is now. The one
// at rest serves while tissue is moved and stretched a little; a flap that is lifted needs twenty
// iterations with it and two with one of its own. Tissue loop, some steps' worth: CHOLMOD and the
// new lines allocate.
#pragma once

#include "tissue/solver/quadratic.h"

namespace tissue {

/// Where the lower triangle of every node pair of every tet lies on QuadraticModel::pattern: by
/// tet, pair a >= b of its nodes and column of the block of the later node. -1: a fixed node.
std::vector<std::array<std::array<std::int32_t, 3>, 55>> block_places(const QuadraticModel& model);

/// Factors A at the last linearisation and warps from there. Where A is not positive definite, half
/// of its geometric stiffness is left out, then all. False, and the factor of before, if even that
/// fails or the body recovers.
bool refactor(const QuadraticModel& model, QuadraticSystem& system);

} // namespace tissue
