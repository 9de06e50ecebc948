// tissue/rod/rod_skin.h
// The skin of a tube that is a rod: each vertex stands still as seen from the cross-section it
// belongs to, blended between the two edges that are nearest. Called by the tissue loop.
//   x = sum over both w (middle of the edge + R offset),  R = [across, along x across, along]
//   dx = sum over both w ((dx_a + dx_b)/2 + omega x R offset),
//   omega = t x (dx_b - dx_a)/|e| + t dtheta
// The cross-section itself stays round: what the wall gives under a tip is for the local law.
#pragma once

#include "tissue/rod/rod.h"

namespace tissue {

struct RodVertex {
    std::array<std::int32_t, 2> edge{}; // the second may have no weight
    std::array<double, 2> weight{};     // sum 1
    std::array<glm::dvec3, 2> offset_m{};
};

/// Any points near the rod at rest; exact there.
std::vector<RodVertex> attach(const RodModel& model, std::span<const glm::dvec3> rest_m);

/// Where the vertex is, world. Real-time safe.
glm::dvec3 place_m(const RodState& state, const RodVertex& vertex) noexcept;

/// dx along `direction` by the unknowns, a row H of up to 22 entries: the force F along `direction`
/// at the vertex is H^T F. Adds to `row`, one value per unknown. Real-time safe.
void add_row(const RodModel& model, const RodState& state, const RodVertex& vertex,
             const glm::dvec3& direction, double factor, std::span<double> row) noexcept;

/// The same row times a motion `q` of the unknowns: dx along `direction`, m. Real-time safe.
double row_times(const RodModel& model, const RodState& state, const RodVertex& vertex,
                 const glm::dvec3& direction, std::span<const double> q) noexcept;

} // namespace tissue
