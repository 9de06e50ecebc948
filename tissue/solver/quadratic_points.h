// tissue/solver/quadratic_points.h
// What is summed over the quadrature points of a quadratic body, sixteen tets at a time. Internal
// to the quadratic solver.
#pragma once

#include "tissue/solver/quadratic.h"

namespace tissue {

struct PointSums {
    double energy_j = 0.0;
    double shape_j = 0.0; // of this, what is not of the change of volume
    double min_det_f = 0.0;
};

/// f_int, tangents and mean deformation gradients at displacements `moved_m` under M of the points
/// (none: elastic). Energy, forces and tangents have a meaning only if min_det_f > 0.
PointSums stresses(const QuadraticModel& model, std::span<const double> moved_m,
                   std::span<const QuadraticSymmetric> shear_pa, std::span<double> internal_n,
                   QuadraticTangents& tangents, std::span<QuadraticStretch> stretch) noexcept;

/// q += factor K p
void add_tangent_product(const QuadraticModel& model, const QuadraticTangents& tangents,
                         float factor, std::span<const float> p, std::span<float> q) noexcept;

/// QuadraticSystem::shear_pa, for the step from `state`. In quadratic_memory.cpp.
void begin_memory(const QuadraticModel& model, const QuadraticState& state,
                  QuadraticSystem& system) noexcept;
/// QuadraticState::memory, after the step that led to where `state` is.
void end_memory(const QuadraticModel& model, const QuadraticSystem& system,
                QuadraticState& state) noexcept;

} // namespace tissue
