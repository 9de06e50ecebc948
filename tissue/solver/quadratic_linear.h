// tissue/solver/quadratic_linear.h
// Sums over nodes and the linear solve on node vectors. Internal to the quadratic solver.
#pragma once

#include "tissue/solver/quadratic.h"

namespace tissue {

/// y = factor M x. In quadratic_mass.cpp.
void mass_product(const QuadraticModel& model, double factor, const NodeVector<double>& x,
                  NodeVector<double>& y) noexcept;
void mass_product(const QuadraticModel& model, float factor, const NodeVector<float>& x,
                  NodeVector<float>& y) noexcept;

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
