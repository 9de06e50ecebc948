// tissue/solver/corotated_static.cpp
// Static equilibrium of a corotated body: at load (rest under gravity), in studies and tests.
#include "tissue/solver/corotated.h"

#include "tissue/solver/plain_vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tissue {
namespace {

using glm::dvec3;

// Load and weight on the unknowns.
std::vector<double> total_load_n(const CorotatedModel& model, std::span<const double> load_n) {
    std::vector<double> total(static_cast<std::size_t>(model.unknowns), 0.0);
    std::copy(load_n.begin(), load_n.end(), total.begin());
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        for (int k = 0; k < 3; ++k) {
            total[model.dof[i] + k] += model.mass_kg[i] * model.gravity_mps2[k];
        }
    }
    return total;
}

void move_to(const CorotatedModel& model, const CorotatedState& from, std::span<const double> du,
             double share, CorotatedState& to) noexcept {
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        const std::int32_t d = model.dof[i];
        to.position_m[i] = from.position_m[i] + share * dvec3{du[d], du[d + 1], du[d + 2]};
    }
}

// Work of the loads from rest, J.
double load_work_j(const CorotatedModel& model, std::span<const double> total,
                   const CorotatedState& state) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        const std::int32_t d = model.dof[i];
        sum += glm::dot(dvec3{total[d], total[d + 1], total[d + 2]},
                        state.position_m[i] - model.mesh.rest_m[i]);
    }
    return sum;
}

} // namespace

StaticReport solve_static(const CorotatedModel& model, std::span<const double> load_n,
                          double tolerance, int max_iterations, CorotatedState& state) {
    constexpr double kStatics = std::numeric_limits<double>::infinity();
    constexpr double kDescent = 1e-4;   // Armijo's share of the promised decrease
    constexpr double kRoundoff = 1e-13; // of the energy: below it, a decrease cannot be seen
    constexpr int kHalvings = 30;
    CorotatedSystem system = make_system(model);
    CorotatedState trial = state;
    const std::vector<double> total = total_load_n(model, load_n);
    std::vector<double> residual(total.size()), du(total.size());
    std::vector<dvec3> nodal(model.dof.size());
    std::fill(state.velocity_mps.begin(), state.velocity_mps.end(), dvec3{0.0});

    StaticReport report;
    for (;;) {
        linearize(model, state, kStatics, system);
        // internal_n holds f_int minus the weight already
        for (std::size_t i = 0; i < total.size(); ++i)
            residual[i] = -system.internal_n[i];
        for (std::size_t i = 0; i < load_n.size(); ++i)
            residual[i] += load_n[i];
        elastic_forces(model, state, nodal);
        double elastic2 = 0.0;
        for (const dvec3& f : nodal)
            elastic2 += glm::dot(f, f);
        const double size = norm_of(total) + std::sqrt(elastic2);
        report.relative_residual = size > 0.0 ? norm_of(residual) / size : 0.0;
        report.converged = report.relative_residual <= tolerance;
        if (report.converged || report.iterations >= max_iterations || !system.factored)
            break;

        du = residual;
        system.factor.solve(du, 1);
        const double slope = product_of(residual, du); // > 0: A is positive definite
        const double elastic_j = elastic_energy_j(model, state);
        const double work_j = load_work_j(model, total, state);
        const double noise_j = kRoundoff * (std::abs(elastic_j) + std::abs(work_j));
        double share = 1.0;
        for (int k = 0; k < kHalvings; ++k) {
            move_to(model, state, du, share, trial);
            const double after = elastic_energy_j(model, trial) - load_work_j(model, total, trial);
            if (after <= elastic_j - work_j - kDescent * share * slope + noise_j)
                break;
            share *= 0.5;
        }
        move_to(model, state, du, share, state);
        ++report.iterations;
    }
    return report;
}

} // namespace tissue
