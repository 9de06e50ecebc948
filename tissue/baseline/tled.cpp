// tissue/baseline/tled.cpp
// Forces, critical step and steps of total Lagrangian explicit dynamics. Called by studies, tests.
#include "tissue/baseline/tled.h"

#include "tissue/solver/corotated_element.h"

#include <algorithm>

namespace tissue {

using glm::dmat3;
using glm::dvec3;

TledModel make_tled(const TetMesh& mesh, const Material& material,
                    std::span<const std::uint8_t> anchored, const dvec3& gravity_mps2) {
    TledModel model{.body = make_corotated(mesh, material, anchored, gravity_mps2),
                    .elasticity = elasticity(material, Law::neo_hooke)};
    // at rest neo-Hooke and corotated elements have one tangent: that of linear elasticity
    CorotatedSystem system = make_system(model.body);
    linearize(model.body, rest_state(model.body), std::numeric_limits<double>::infinity(), system);
    const auto product = [&](std::span<const double> u, std::span<double> force) {
        multiply(model.body.pattern, system.stiffness, u, force);
    };
    model.critical_s = 2.0 / greatest_frequency_radps(model.body, product);
    model.substep_s = kCourant * model.critical_s;
    return model;
}

BaselineScratch make_scratch(const TledModel& model) {
    return {.node = std::vector<dvec3>(model.body.dof.size())};
}

void elastic_forces(const TledModel& model, const BaselineState& state,
                    std::span<dvec3> force_n) noexcept {
    const CorotatedModel& body = model.body;
    std::fill(force_n.begin(), force_n.end(), dvec3{0.0});
    for (std::size_t e = 0; e < body.mesh.tets.size(); ++e) {
        const dmat3 F = deformation_gradient(body, e, state.position_m);
        const dmat3 P = body.volume_m3[e] * piola_stress_pa(model.elasticity, F);
        for (int a = 0; a < 4; ++a)
            force_n[body.mesh.tets[e][a]] += P * body.gradient_1pm[e][a];
    }
}

double elastic_energy_j(const TledModel& model, const BaselineState& state) noexcept {
    double sum = 0.0;
    for (std::size_t e = 0; e < model.body.mesh.tets.size(); ++e) {
        const dmat3 F = deformation_gradient(model.body, e, state.position_m);
        sum += model.body.volume_m3[e] * energy_density_jpm3(model.elasticity, F);
    }
    return sum;
}

BaselineReport step(const TledModel& model, std::span<const dvec3> load_n, double dt_s,
                    BaselineScratch& scratch, BaselineState& state) noexcept {
    const CorotatedModel& body = model.body;
    const int substeps = substep_count(dt_s, model.substep_s);
    const double h = dt_s / substeps;
    const double half_damping = 0.5 * h * body.material.damping_mass_1ps;
    const auto half_kick = [&](std::size_t i) {
        return 0.5 * h *
               (free_acceleration_mps2(body, load_n, i) - scratch.node[i] / body.mass_kg[i]);
    };

    elastic_forces(model, state, scratch.node); // the load may have changed, the force may not
    for (int k = 0; k < substeps; ++k) {
        for (std::size_t i = 0; i < body.dof.size(); ++i) {
            if (body.dof[i] < 0)
                continue;
            state.velocity_mps[i] = (1.0 - half_damping) * state.velocity_mps[i] + half_kick(i);
            state.position_m[i] += h * state.velocity_mps[i];
        }
        elastic_forces(model, state, scratch.node);
        for (std::size_t i = 0; i < body.dof.size(); ++i) {
            if (body.dof[i] >= 0)
                state.velocity_mps[i] =
                    (state.velocity_mps[i] + half_kick(i)) / (1.0 + half_damping);
        }
    }
    return look_at(body, state, substeps);
}

} // namespace tissue
