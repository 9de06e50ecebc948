// tissue/solver/quadratic_linear.h
// Sums over nodes and the linear solve on node vectors. Internal to the quadratic solver.
#pragma once

#include "tissue/solver/quadratic.h"

namespace tissue {

/// y = factor S x, S the same for x, y and z and on the pattern of the mass: mass_kg, bed_npm. In
/// quadratic_mass.cpp.
void scalar_product(const QuadraticModel& model, std::span<const double> S, double factor,
                    const NodeVector<double>& x, NodeVector<double>& y) noexcept;
void scalar_product(const QuadraticModel& model, std::span<const float> S,
                    const NodeVector<float>& x, NodeVector<float>& y) noexcept;

/// y = factor M x.
inline void mass_product(const QuadraticModel& model, double factor, const NodeVector<double>& x,
                         NodeVector<double>& y) noexcept {
    scalar_product(model, model.mass_kg, factor, x, y);
}

/// What the bed adds to a matrix on the pattern of the mass, N/m. In quadratic_bed.cpp.
std::vector<double> bed_stiffness(const QuadraticModel& model, std::span<const BedSample> bed);

/// internal_n += B u, and the energy of the bed. `scratch` is overwritten.
double add_bed(const QuadraticModel& model, const NodeVector<double>& moved_m,
               NodeVector<double>& scratch, NodeVector<double>& internal_n) noexcept;

/// Zero for anchored nodes and the sink.
template <typename T> void clear_fixed(const QuadraticModel& model, NodeVector<T>& v) noexcept {
    for (const std::int32_t at : model.fixed) {
        for (int c = 0; c < 4; ++c)
            v[at + c] = T(0);
    }
}

/// A x = b on the nodes, QuadraticSystem::x from QuadraticSystem::b.
LinearReport solve_nodes(const QuadraticModel& model, const QuadraticOptions& options,
                         QuadraticSystem& system) noexcept;

} // namespace tissue
