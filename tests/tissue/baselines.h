// tests/tissue/baselines.h
// What the tests of the baselines share: one name for four makers, and bodies to make.
#pragma once

#include "tests/tissue/bodies.h"
#include "tissue/baseline/mass_spring.h"
#include "tissue/baseline/projective.h"
#include "tissue/baseline/run.h"
#include "tissue/baseline/tled.h"
#include "tissue/baseline/xpbd.h"

namespace baselines {

using glm::dvec3;

template <typename Model>
Model make(const tissue::TetMesh& mesh, const tissue::Material& material,
           std::span<const std::uint8_t> anchored = {}, const dvec3& gravity_mps2 = dvec3{0.0}) {
    if constexpr (std::is_same_v<Model, tissue::MassSpringModel>)
        return tissue::make_mass_spring(mesh, material, anchored, gravity_mps2);
    else if constexpr (std::is_same_v<Model, tissue::TledModel>)
        return tissue::make_tled(mesh, material, anchored, gravity_mps2);
    else if constexpr (std::is_same_v<Model, tissue::XpbdModel>)
        return tissue::make_xpbd(mesh, material, anchored, gravity_mps2);
    else
        return tissue::make_projective(mesh, material, anchored, gravity_mps2);
}

/// Relative error. doctest's Approx adds 1 to the size of what it compares: of micrometres it would
/// pass anything.
inline double off(double value, double expected) {
    return std::abs(value - expected) / std::abs(expected);
}

using tissue::fastest_mps;
using tissue::lone_tet;
using tissue::run;
using tissue::settled;
inline constexpr auto& kBase = tissue::kLoneTetBase;

inline tissue::TetMesh small_box() {
    return tissue::box_mesh({0.03, 0.02, 0.02}, {3, 2, 2}, 0.1);
}

/// 0.2 x 0.04 x 0.04 m, x = 0 clamped, 1000 kg/m3, under its weight in -y.
struct Beam {
    tissue::TetMesh mesh;
    std::vector<std::uint8_t> anchored;
    tissue::Material material;
    dvec3 gravity_mps2{0.0, -9.81, 0.0};

    Beam(const std::array<int, 3>& cells, double young_pa, double poisson)
        : mesh(tissue::box_mesh({0.2, 0.04, 0.04}, cells)),
          anchored(bodies::anchors(mesh, [](auto x) { return x.x < 1e-9; })),
          material(bodies::elastic(young_pa, poisson)) {
        // twice the first frequency of a cantilever, (1.875/L)^2 sqrt(E I/(rho A)), whatever is
        // asked of it settles soonest
        const double omega_radps = std::pow(1.8751 / 0.2, 2) * std::sqrt(young_pa / 12e3) * 0.04;
        material.damping_mass_1ps = 2.0 * omega_radps;
    }
    template <typename Model> Model made() const {
        return make<Model>(mesh, material, anchored, gravity_mps2);
    }
    /// Mean displacement of the end face, over its nodes.
    dvec3 tip_m(const tissue::BaselineState& state) const {
        dvec3 sum{0.0};
        int nodes = 0;
        for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
            if (mesh.rest_m[i].x > 0.2 - 1e-9) {
                sum += state.position_m[i] - mesh.rest_m[i];
                ++nodes;
            }
        }
        return sum / static_cast<double>(nodes);
    }
    /// The static answer of corotated linear tetrahedra on this mesh.
    tissue::CorotatedState p1() const {
        const auto model = tissue::make_corotated(mesh, material, anchored, gravity_mps2);
        tissue::CorotatedState state = tissue::rest_state(model);
        if (!tissue::solve_static(model, {}, 1e-10, 60, state).converged)
            throw std::runtime_error("the static corotated beam did not converge");
        return state;
    }
};

/// Free nodes moved by up to `noise_m`, moving at up to `noise_mps`.
inline tissue::BaselineState shaken(const tissue::CorotatedModel& body, double noise_m,
                                    double noise_mps, unsigned seed) {
    std::mt19937_64 random(seed);
    tissue::BaselineState state = tissue::rest_state(body);
    for (std::size_t i = 0; i < body.dof.size(); ++i) {
        if (body.dof[i] < 0)
            continue;
        state.position_m[i] += noise_m * bodies::signed_vector(random);
        state.velocity_mps[i] = noise_mps * bodies::signed_vector(random);
    }
    return state;
}

/// Relative change of the energy in ten seconds of steps of a fifth of the critical one, from the
/// mean over the first second to that over the last: in between it swings with omega h.
template <typename Model> double energy_drift(Model model) {
    model.substep_s = 0.2 * model.critical_s;
    tissue::BaselineState state = shaken(model.body, 2e-4, 0.02, 6);
    auto scratch = make_scratch(model);
    double first_j = 0.0, last_j = 0.0;
    for (int i = 0; i < 1000; ++i) {
        step(model, {}, 0.01, scratch, state);
        const double energy_j =
            elastic_energy_j(model, state) + bodies::kinetic_energy_j(model.body, state);
        first_j += i < 100 ? energy_j : 0.0;
        last_j += i >= 900 ? energy_j : 0.0;
    }
    return off(last_j, first_j);
}

/// Greatest difference between the forces and the differenced energy, over the greatest force.
template <typename Model>
double gradient_error(const Model& model, const tissue::BaselineState& state) {
    constexpr double kStep_m = 1e-7;
    std::vector<dvec3> force(state.position_m.size());
    elastic_forces(model, state, force);
    double error = 0.0, size = 0.0;
    tissue::BaselineState moved = state;
    for (std::size_t i = 0; i < force.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            moved.position_m[i][k] = state.position_m[i][k] + kStep_m;
            const double above = elastic_energy_j(model, moved);
            moved.position_m[i][k] = state.position_m[i][k] - kStep_m;
            const double below = elastic_energy_j(model, moved);
            moved.position_m[i][k] = state.position_m[i][k];
            error = std::max(error, std::abs((above - below) / (2 * kStep_m) - force[i][k]));
            size = std::max(size, std::abs(force[i][k]));
        }
    }
    return error / size;
}

} // namespace baselines
