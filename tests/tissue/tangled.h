// tests/tissue/tangled.h
// Bodies to be turned inside out, for the tests of steps with inverted tets.
#pragma once

#include "tests/tissue/bodies.h"
#include "tissue/solver/descent.h"

namespace tangled {

using glm::dvec3;

#ifdef TROCAR_SANITIZED
inline constexpr int kCases = 1; // ten times as slow, and looking for other faults than rare ones
#else
inline constexpr int kCases = 10;
#endif
inline constexpr int kFew = (kCases + 2) / 3; // where there are twelve materials and steps of each

/// A body, where it is, and all that a step needs.
struct Body {
    tissue::CorotatedModel model;
    tissue::CorotatedState state;
    tissue::CorotatedSystem system;
    tissue::Descent descent;
    std::vector<double> du, load_n;

    Body(const tissue::TetMesh& mesh, const tissue::Material& material,
         std::span<const std::uint8_t> anchored = {}, const dvec3& gravity_mps2 = dvec3{0.0})
        : model(tissue::make_corotated(mesh, material, anchored, gravity_mps2)),
          state(tissue::rest_state(model)), system(tissue::make_system(model)),
          descent(tissue::make_descent(model)), du(static_cast<std::size_t>(model.unknowns)) {}

    /// After `state` was set by hand.
    void begin(double dt_s) { tissue::linearize(model, state, dt_s, system); }
    tissue::StepEnd step() {
        tissue::free_motion(model, state, system, du);
        if (!load_n.empty()) { // as the contact solve does: du += A^-1 f
            std::vector<double> pushed = load_n;
            system.factor.solve(pushed, 1);
            for (std::size_t k = 0; k < du.size(); ++k)
                du[k] += pushed[k];
        }
        return tissue::finish_step(model, load_n, du, system, descent, state);
    }
    double energy_j() const {
        return tissue::elastic_energy_j(model, state) + bodies::kinetic_energy_j(model, state);
    }
    double volume_error() const {
        return std::abs(tissue::volume_m3(model.mesh, state.position_m) /
                            tissue::volume_m3(model.mesh, model.mesh.rest_m) -
                        1.0);
    }
    dvec3 momentum_ns() const {
        dvec3 sum{0.0};
        for (std::size_t i = 0; i < model.mass_kg.size(); ++i)
            sum += model.mass_kg[i] * state.velocity_mps[i];
        return sum;
    }
};

inline dvec3 in_ball(double radius_m, std::mt19937_64& random) {
    for (;;) {
        const dvec3 x = bodies::signed_vector(random);
        if (glm::length(x) <= 1.0)
            return radius_m * x;
    }
}

inline tissue::TetMesh cube(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    return tissue::box_mesh({0.03, 0.03, 0.03}, {3, 3, 3}, 0.1, random());
}

enum class Shape { thrown, flat, inside_out, pulled_through };
inline constexpr Shape kShapes[] = {Shape::thrown, Shape::flat, Shape::inside_out,
                                    Shape::pulled_through};

/// Free nodes only: anchored ones stay.
inline void throw_about(Body& body, Shape shape, std::mt19937_64& random) {
    for (std::size_t i = 0; i < body.state.position_m.size(); ++i) {
        dvec3& x = body.state.position_m[i];
        if (body.model.dof[i] < 0)
            continue;
        if (shape == Shape::thrown)
            x = dvec3{0.015} + in_ball(0.015, random);
        if (shape == Shape::flat)
            x.z = 0.0;
        if (shape == Shape::inside_out)
            x.z = -x.z;
        if (shape == Shape::pulled_through && x.x > 0.02 && x.y > 0.02 && x.z > 0.02)
            x -= 0.05; // a corner, out at the opposite one
    }
}

} // namespace tangled
