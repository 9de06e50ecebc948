// tissue/baseline/baseline.h
// The methods that accuracy-against-speed charts show beside ours, each as its paper has it, also
// where it fails. Called by studies and tests, never by a loop. One method per file, one shape:
//   XModel    make_X(mesh, material, anchored, gravity)    what never changes
//   XScratch  make_scratch(model)                          sized once, nothing is allocated later
//   BaselineReport step(model, load_n, dt_s, scratch, state)
// Mesh, shape functions, lumped masses and anchors are those of the corotated solver (`body`), so
// that what differs between two methods is the method. All damp by mass alone (damping_mass_1ps);
// none has a term for damping_stiffness_s, which is ignored.
#pragma once

#include "tissue/solver/corotated.h"

#include <functional>

namespace tissue {

/// `recovering` has no meaning here.
using BaselineState = CorotatedState;

struct BaselineReport {
    int substeps = 0;
    /// What is left of the equations of the step; not a number: the method does not know it.
    double relative_residual = std::numeric_limits<double>::quiet_NaN();
    int inverted = 0;   // tets with det F <= 0 at the end of the step
    bool finite = true; // all positions and velocities are numbers
};

struct BaselineScratch {
    std::vector<glm::dvec3> node;     // forces, or places before a substep
    std::vector<double> multiplier{}; // of constraints, if the method has some
};

/// Share of the critical step that an explicit method takes: 0.8 to 0.98 makes up for what becomes
/// stiffer under load (Belytschko, Liu & Moran 2000, 6.2.1).
inline constexpr double kCourant = 0.9;

/// Linearised elastic force on the unknowns, given displacements of them.
using StiffnessProduct =
    std::function<void(std::span<const double> u_m, std::span<double> force_n)>;

/// Greatest eigenfrequency of M^-1 K by power iteration, 1e-4 too small at most: explicit steps
/// beyond 2/omega diverge. At setup. Throws std::runtime_error if it does not settle.
double greatest_frequency_radps(const CorotatedModel& body, const StiffnessProduct& product);

/// The fewest equal parts of `dt_s` that are not longer than `longest_s`.
int substep_count(double dt_s, double longest_s) noexcept;

/// (load + weight)/m of a free node. `load_n` is per node, in N; empty: none.
inline glm::dvec3 free_acceleration_mps2(const CorotatedModel& body,
                                         std::span<const glm::dvec3> load_n,
                                         std::size_t node) noexcept {
    return load_n.empty() ? body.gravity_mps2
                          : body.gravity_mps2 + load_n[node] / body.mass_kg[node];
}

/// Counts what is inverted and whether all are numbers.
BaselineReport look_at(const CorotatedModel& body, const BaselineState& state,
                       int substeps) noexcept;

} // namespace tissue
