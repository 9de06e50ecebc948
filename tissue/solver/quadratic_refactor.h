// tissue/solver/quadratic_refactor.h
// A new factor for the preconditioner of a quadratic body, at the tangent where it was when that
// was begun. The one at rest serves while tissue is moved and stretched a little; a flap that is
// lifted needs twenty iterations with it and two with one of its own. Begun and taken by the tissue
// loop, made by another thread meanwhile. Which steps begin and take is for the caller to say, from
// what repeats: then runs repeat, however long it takes.
#pragma once

#include "tissue/solver/quadratic.h"

#include <future>

namespace tissue {

/// Where the lower triangle of every node pair of every tet lies on QuadraticModel::pattern: by
/// tet, pair a >= b of its nodes and column of the block of the later node. -1: a fixed node.
std::vector<std::array<std::array<std::int32_t, 3>, 55>> block_places(const QuadraticModel& model);

/// A factor in the making, and what it is made of. Made once per model.
struct Refactoring {
    SparseFactor factor;
    std::vector<double> matrix; // A
    QuadraticTangents tangent;
    std::vector<glm::mat3> warp; // of each node since rest
    SingleFactor single;
    std::future<bool> made; // last: what is destroyed first waits for the thread
};
Refactoring make_refactoring(const QuadraticModel& model);

/// Steps after which a factor that was begun is there, at 2.2e9 products a second: by what must be
/// computed, which `of`, of the same pattern, tells, and not by any clock.
int steps_to_refactor(const QuadraticModel& model, const SingleFactor& of, double dt_s);

/// Begins with A at the last linearisation. Where it is not positive definite, half of its
/// geometric stiffness is left out, then all. False, and nothing begun, if the body recovers, no
/// thread is to be had or one is at work. Until it is taken, model, system and `job` must stay
/// where they are. Allocates.
bool begin_refactoring(const QuadraticModel& model, const QuadraticSystem& system,
                       Refactoring& job) noexcept;

/// Waits for what was begun and warps from there. False, and the factor of before, if nothing was
/// or A could not be factored.
bool take_refactoring(Refactoring& job, QuadraticSystem& system) noexcept;

} // namespace tissue
