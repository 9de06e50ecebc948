// tissue/reference/reference_newton.h
// The least of an (incremental) potential, for statics and for one implicit step alike. Internal to
// the reference solver.
//   Pi(x) = E(x) + C(x) + d.B d/2 - f.d,  d = x - x_start, C: contact with a tip, if there is one
#pragma once

#include "tissue/reference/tip_contact.h"

namespace tissue {

/// All per component; B on ReferenceModel::all, or empty: statics.
struct Potential {
    std::span<const double> force_n;
    std::span<const double> inertia_npm;
    const TipContact* contact = nullptr;
};

/// From `moved_m`, the displacements of x_start, to the least of Pi with the held components of
/// `target_m` (empty: they stay). On failure `moved_m` is where the last part that converged led.
NewtonReport find_least(const ReferenceModel& model, const Potential& potential,
                        std::span<const glm::dvec3> target_m, const NewtonOptions& options,
                        ReferenceSystem& system, std::vector<glm::dvec3>& moved_m);

} // namespace tissue
