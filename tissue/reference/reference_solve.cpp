// tissue/reference/reference_solve.cpp
// Static equilibrium and one implicit step of a reference body, as minima of a potential.
#include "tissue/reference/reference_newton.h"

#include "tissue/reference/reference_element.h"

#include <limits>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dvec3;

void check_size(const ReferenceModel& model, std::span<const dvec3> given, const char* what) {
    if (!given.empty() && given.size() != model.mesh.rest_m.size()) {
        throw std::invalid_argument(std::string(what) + " for " + std::to_string(given.size()) +
                                    " nodes: the mesh has " +
                                    std::to_string(model.mesh.rest_m.size()));
    }
}

std::vector<double> total_load_n(const ReferenceModel& model, const ReferenceLoad& load) {
    check_size(model, load.force_n, "forces");
    check_size(model, load.held_m, "places of held components");
    std::vector<double> total = model.weight_n;
    for (std::size_t i = 0; i < 3 * load.force_n.size(); ++i)
        total[i] += load.force_n[i / 3][static_cast<int>(i % 3)];
    return total;
}

// B = M/h^2 + (alpha M + beta K)/h, and M v/h on top of the load.
std::vector<double> add_inertia(const ReferenceModel& model, const ReferenceState& state,
                                std::span<const dvec3> moved_m, double h_s, ReferenceSystem& system,
                                std::vector<double>& force_n) {
    const double mass = 1.0 / (h_s * h_s) + model.material.damping_mass_1ps / h_s;
    const double stiffness = model.material.damping_stiffness_s / h_s;
    if (stiffness > 0.0)
        linearize_at(model, moved_m, system, false);
    std::vector<double> inertia_npm(model.mass_kg.size());
    for (std::size_t k = 0; k < inertia_npm.size(); ++k) {
        inertia_npm[k] = mass * model.mass_kg[k];
        if (stiffness > 0.0)
            inertia_npm[k] += stiffness * system.stiffness[k];
    }
    std::vector<double> speed(force_n.size()), momentum(force_n.size());
    for (std::size_t i = 0; i < speed.size(); ++i)
        speed[i] = state.velocity_mps[i / 3][static_cast<int>(i % 3)] / h_s;
    multiply(model.all, model.mass_kg, speed, momentum);
    for (std::size_t i = 0; i < force_n.size(); ++i)
        force_n[i] += momentum[i];
    return inertia_npm;
}

} // namespace

NewtonReport solve_static(const ReferenceModel& model, const ReferenceLoad& load,
                          const NewtonOptions& options, ReferenceSystem& system,
                          ReferenceState& state) {
    const std::vector<double> force_n = total_load_n(model, load);
    state.velocity_mps.assign(state.position_m.size(), dvec3{0.0});
    std::vector<dvec3> moved = displacements_m(model, state.position_m);
    const PronyStep prony = prony_step(model.material, std::numeric_limits<double>::infinity());
    check_memory(model, state.memory);
    begin_memory(model, prony, state.memory, moved, system);
    const NewtonReport report = find_least(
        model, {force_n, {}}, displacements_m(model, load.held_m), options, system, moved);
    end_memory(model, prony, moved, moved, state.memory);
    for (std::size_t i = 0; i < moved.size(); ++i)
        state.position_m[i] = model.mesh.rest_m[i] + moved[i];
    return report;
}

NewtonReport step(const ReferenceModel& model, const ReferenceLoad& load, double dt_s,
                  TimeRule rule, const NewtonOptions& options, ReferenceSystem& system,
                  ReferenceState& state) {
    if (!(dt_s > 0.0)) {
        throw std::invalid_argument("dt_s = " + std::to_string(dt_s) + ": must be greater than 0");
    }
    // midpoint: (x + x')/2 and (v + v')/2 are an implicit Euler step of half the length
    const bool half = rule == TimeRule::midpoint;
    const double h_s = half ? 0.5 * dt_s : dt_s;
    std::vector<double> force_n = total_load_n(model, load);
    const std::vector<dvec3> start = displacements_m(model, state.position_m);
    const PronyStep prony = prony_step(model.material, h_s);
    check_memory(model, state.memory);
    begin_memory(model, prony, state.memory, start, system);
    const std::vector<double> inertia_npm = add_inertia(model, state, start, h_s, system, force_n);
    std::vector<dvec3> held = displacements_m(model, load.held_m), moved = start;
    for (std::size_t i = 0; half && i < held.size(); ++i)
        held[i] = 0.5 * (start[i] + held[i]);

    const NewtonReport report =
        find_least(model, {force_n, inertia_npm}, held, options, system, moved);
    if (report.reached < 1.0)
        return report;
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const dvec3 way = moved[i] - start[i];
        state.position_m[i] += half ? 2.0 * way : way;
        dvec3& v = state.velocity_mps[i];
        v = half ? 2.0 * way / h_s - v : way / h_s;
    }
    end_memory(model, prony, start, moved, state.memory);
    if (half)
        end_memory(model, prony, moved, displacements_m(model, state.position_m), state.memory);
    return report;
}

} // namespace tissue
