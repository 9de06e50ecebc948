// tissue/rod/rod_points.h
// A rod seen through points that it carries, in the pieces of a step that a Solid has: whatever
// puts contact on nodes puts it on these, and need not know that a rod is behind them. Called by
// the tissue loop; made at setup.
//   dx = T dq (rod_skin.h), so forces go to the rod by T^T and A^-1 of the points is T A^-1 T^T,
//   of the rank that a rod's motions have: for right-hand sides of contact, not to be inverted.
// T is that of the last linearisation. Three unknowns a point, x, y, z; points between held nodes
// stay, with rows of zeros.
#pragma once

#include "tissue/rod/rod_skin.h"

namespace tissue {

struct RodPoints {
    std::vector<RodVertex> vertex;
    std::vector<glm::dvec3> position_m;
    std::vector<double> load_n, answer; // on the rod's unknowns: scratch
};
RodPoints make_points(const RodModel& model, std::span<const glm::dvec3> rest_m);

/// The motion of the points under `load_n`, three per point, which may be empty. `system` is
/// linearised at `state`.
void free_motion(const RodModel& model, const RodState& state, const RodSystem& system,
                 std::span<const double> load_n, RodPoints& points, std::span<double> du) noexcept;

/// A^-1 b in place, three per point, column after column.
void solve(const RodModel& model, const RodState& state, const RodSystem& system, RodPoints& points,
           std::span<double> block, int columns) noexcept;

/// To the end of the step under `load_n`, which is all it needs; `du` becomes how the points moved.
RodReport end_step(const RodModel& model, std::span<const double> load_n, const RodOptions& options,
                   RodPoints& points, std::span<double> du, RodSystem& system,
                   RodState& state) noexcept;

} // namespace tissue
