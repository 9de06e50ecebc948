// tissue/solver/corotated.cpp
// The corotated step: factorisation, free motion, and what goes with them. Tissue loop, every step.
#include "tissue/solver/corotated.h"

#include "tissue/solver/corotated_assembly.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

// A = M/dt^2 + (alpha M + beta K)/dt + K
void combine(const CorotatedModel& model, double dt_s, CorotatedSystem& system) noexcept {
    const double rate = 1.0 / dt_s; // statics: 0
    const double of_k = 1.0 + model.material.damping_stiffness_s * rate;
    const double of_m = rate * rate + model.material.damping_mass_1ps * rate;
    for (std::size_t k = 0; k < system.matrix.size(); ++k) {
        system.matrix[k] = of_k * system.stiffness[k];
    }
    add_mass(model, of_m, system.matrix);
}

double squared(std::span<const double> v) noexcept {
    double sum = 0.0;
    for (const double x : v)
        sum += x * x;
    return sum;
}

} // namespace

void linearize(const CorotatedModel& model, const CorotatedState& state, double dt_s,
               CorotatedSystem& system, bool exact) noexcept {
    system.dt_s = dt_s;
    system.exact_tangent = exact;
    assemble(model, state, exact, system);
    combine(model, dt_s, system);
    system.factored = system.factor.factor(system.matrix);
    if (system.factored || !exact)
        return;

    // not positive definite: the warped stiffness is
    system.exact_tangent = false;
    assemble(model, state, false, system);
    combine(model, dt_s, system);
    system.factored = system.factor.factor(system.matrix);
}

void follow_tangent(const CorotatedModel& model, std::span<const double> du,
                    CorotatedSystem& system) noexcept {
    const std::span<double> product = std::span(system.work).first(du.size());
    multiply(model.pattern, system.stiffness, du, product);
    for (std::size_t i = 0; i < du.size(); ++i)
        system.internal_n[i] += product[i];
}

StepReport free_motion(const CorotatedModel& model, const CorotatedState& state,
                       CorotatedSystem& system, std::span<double> du,
                       std::span<const double> load_n) noexcept {
    const auto n = static_cast<std::size_t>(model.unknowns);
    const std::span<double> right = std::span(system.work).first(n);
    const std::span<double> product = std::span(system.work).subspan(n, n);
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        const dvec3 momentum_n = model.mass_kg[i] / system.dt_s * state.velocity_mps[i];
        for (int k = 0; k < 3; ++k) {
            right[model.dof[i] + k] = momentum_n[k] - system.internal_n[model.dof[i] + k];
        }
    }
    for (std::size_t k = 0; k < load_n.size(); ++k)
        right[k] += load_n[k];
    StepReport report{0.0, system.exact_tangent, system.inverted};
    if (system.factored) {
        std::copy(right.begin(), right.end(), du.begin());
        system.factor.solve(du, 1);
    } else {
        std::fill(du.begin(), du.end(), 0.0);
    }

    multiply(model.pattern, system.matrix, du, product);
    for (std::size_t i = 0; i < n; ++i)
        product[i] -= right[i];
    const double load2 = squared(right);
    report.relative_residual = load2 > 0.0 ? std::sqrt(squared(product) / load2) : 0.0;
    if (!system.factored)
        report.relative_residual = 1.0; // also where the load is not a number
    return report;
}

void advance(const CorotatedModel& model, std::span<const double> du, double dt_s,
             CorotatedState& state) noexcept {
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        const std::int32_t d = model.dof[i];
        const dvec3 step{du[d], du[d + 1], du[d + 2]};
        state.position_m[i] += step;
        state.velocity_mps[i] = step / dt_s;
    }
}

void elastic_forces(const CorotatedModel& model, const CorotatedState& state,
                    std::span<dvec3> force_n) noexcept {
    std::fill(force_n.begin(), force_n.end(), dvec3{0.0});
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        const ElementShape shape = element_shape(model, e, state.position_m);
        const dmat3 stress_nm = element_stress_nm(model, e, shape);
        for (int a = 0; a < 4; ++a) {
            force_n[model.mesh.tets[e][a]] +=
                stress_nm * (shape.rotation * model.gradient_1pm[e][a]);
        }
    }
    for (const HeldTet& held : model.held) {
        for (int a = 0; a < 4; ++a)
            force_n[model.mesh.tets[held.tet][a]] += bed_force_n(model, held, state, a);
    }
}

double elastic_energy_j(const CorotatedModel& model, const CorotatedState& state) noexcept {
    double sum = 0.0;
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        sum += element_energy_j(model, e, element_shape(model, e, state.position_m));
    }
    for (const HeldTet& held : model.held) {
        for (int a = 0; a < 4; ++a) {
            const std::uint32_t node = model.mesh.tets[held.tet][a];
            sum += 0.5 * glm::dot(bed_force_n(model, held, state, a),
                                  state.position_m[node] - model.mesh.rest_m[node]);
        }
    }
    return sum;
}

} // namespace tissue
