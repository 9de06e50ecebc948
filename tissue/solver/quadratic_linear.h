// tissue/solver/quadratic_linear.h
// Sums over nodes and the linear solve on node vectors. Internal to the quadratic solver.
#pragma once

#include "tissue/solver/quadratic.h"

namespace tissue {

/// y = factor M x
template <typename T>
void mass_product(const QuadraticModel& model, T factor, const NodeVector<T>& x,
                  NodeVector<T>& y) noexcept {
    const T* kg = nullptr;
    if constexpr (sizeof(T) == sizeof(float))
        kg = model.mass_single_kg.data();
    else
        kg = model.mass_kg.data();
    for (std::size_t i = 0; i + 1 < model.mass_start.size(); ++i) {
        T sum[4]{};
        for (std::int32_t k = model.mass_start[i]; k < model.mass_start[i + 1]; ++k) {
            const T* from = x.data() + model.mass_column[k];
            for (int c = 0; c < 4; ++c)
                sum[c] += kg[k] * from[c];
        }
        for (int c = 0; c < 4; ++c)
            y[4 * i + c] = factor * sum[c];
    }
}

/// Zero for anchored nodes and the sink.
template <typename T> void clear_fixed(const QuadraticModel& model, NodeVector<T>& v) noexcept {
    for (const std::int32_t at : model.fixed) {
        for (int c = 0; c < 4; ++c)
            v[at + c] = T(0);
    }
}

/// A x = r on the nodes, QuadraticSystem::x from r, which becomes what is left.
LinearReport solve_nodes(const QuadraticModel& model, const QuadraticOptions& options,
                         QuadraticSystem& system) noexcept;

} // namespace tissue
