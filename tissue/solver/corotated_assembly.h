// tissue/solver/corotated_assembly.h
// f_int and K of a corotated body at a state. Internal to the corotated solver.
#pragma once

#include "tissue/solver/corotated_element.h"
#include "tissue/solver/tangle.h"

namespace tissue {

/// Force of the bed on corner `a` of a held tet.
glm::dvec3 bed_force_n(const CorotatedModel& model, const HeldTet& held,
                       const CorotatedState& state, int a) noexcept;

/// f_int - f_ext and K into `system`; on the way the peak of the stress and
/// what is inverted. With `tangles`, their tets are pulled to the rotation of their tangle, by a
/// quadratic energy; both figures then mean nothing.
void assemble(const CorotatedModel& model, const CorotatedState& state, bool exact,
              CorotatedSystem& system, const Tangles* tangles = nullptr) noexcept;

/// Forces alone: f_int - f_ext into `force_n`, on the unknowns.
struct ForceSums {
    int inverted = 0;
    double peak_von_mises_pa = 0.0;
};
ForceSums assemble_forces(const CorotatedModel& model, const CorotatedState& state,
                          std::span<double> force_n) noexcept;

/// beta K on the pattern, K the warped stiffness of bed and tets outside the tangles: positive
/// semidefinite. What K is inside one says nothing of how tissue damps.
void assemble_damping(const CorotatedModel& model, const CorotatedState& state,
                      const Tangles& tangles, std::span<double> values_nspm) noexcept;

/// values += of_m M
void add_mass(const CorotatedModel& model, double of_m, std::span<double> values) noexcept;

} // namespace tissue
