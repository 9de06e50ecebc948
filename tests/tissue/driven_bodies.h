// tests/tissue/driven_bodies.h
// The reference and the real-time quadratic solver behind one door: boxes whose faces are led, and
// what the led nodes are held with. For tests that ask the same of both.
#pragma once

#include "tests/tissue/quadratic_bodies.h"

#include <functional>

namespace driven {

using Place = std::function<glm::dvec3(const glm::dvec3&)>;

/// Held nodes go to `place(rest place)` in steps.
struct Reference {
    static constexpr const char* kName = "reference";
    tissue::ReferenceModel model;
    tissue::ReferenceState state;
    tissue::ReferenceSystem system;
    double dt_s;

    Reference(const tissue::QuadraticMesh& mesh, const tissue::Material& m,
              const std::vector<std::uint8_t>& held, double step_s)
        : model(make_reference(mesh, m, tissue::Law::neo_hooke, held)), state(rest_state(model)),
          system(make_system(model)), dt_s(step_s) {}

    /// True if it found the root.
    bool step(const Place& place) {
        const auto held = reference_bodies::places(model.mesh, place);
        return tissue::step(model, {{}, held}, dt_s, tissue::TimeRule::implicit_euler,
                            {.tolerance = 1e-9}, system, state)
                   .reached == 1.0;
    }
    void set_dt(double step_s) { dt_s = step_s; }
    std::vector<glm::dvec3> forces_n() {
        std::vector<glm::dvec3> f(model.mesh.rest_m.size());
        internal_forces(model, state, f);
        return f;
    }
};

/// Held nodes must be held in all components: they are moved before a step.
struct Quadratic {
    static constexpr const char* kName = "quadratic";
    tissue::QuadraticModel model;
    tissue::QuadraticState state;
    tissue::QuadraticSystem system;
    double dt_s;

    Quadratic(const tissue::QuadraticMesh& mesh, const tissue::Material& m,
              const std::vector<std::uint8_t>& held, double step_s)
        : model(make_quadratic(mesh, m, held)), state(rest_state(model)),
          system(make_system(model, step_s)), dt_s(step_s) {}

    bool step(const Place& place) {
        for (std::size_t i = 0; i < model.dof.size(); ++i) {
            if (model.dof[i] < 0)
                state.position_m[i] = place(model.mesh.rest_m[i]);
        }
        const auto report = quadratic_bodies::step(model, quadratic_bodies::exact(), system, state);
        return !report.recovering && report.relative_residual < 1e-6;
    }
    void set_dt(double step_s) {
        if (step_s != dt_s)
            system = make_system(model, step_s);
        dt_s = step_s;
    }
    /// Of a step that stays where it is and takes no time to speak of.
    std::vector<glm::dvec3> forces_n() {
        auto now = make_system(model, 1e-9 * dt_s);
        auto still = state;
        for (auto* v : {&still.velocity_mps, &still.gain_mps})
            v->assign(v->size(), glm::dvec3{0.0});
        linearize(model, still, now);
        std::vector<glm::dvec3> f;
        for (std::size_t i = 0; i < model.dof.size(); ++i)
            f.push_back(
                {now.internal_n[4 * i], now.internal_n[4 * i + 1], now.internal_n[4 * i + 2]});
        return f;
    }
};

/// All nodes, held or not, where a body is to look for equilibrium from.
template <typename Body> void carry(Body& body, const Place& place) {
    body.state.position_m = reference_bodies::places(body.model.mesh, place);
}

/// Sum of the forces on the nodes where `chosen(rest place)`.
template <typename Body, typename Chosen> glm::dvec3 force_where_n(Body& body, Chosen chosen) {
    const auto f = body.forces_n();
    glm::dvec3 sum{0.0};
    for (std::size_t i = 0; i < f.size(); ++i)
        sum += chosen(body.model.mesh.rest_m[i]) ? f[i] : glm::dvec3{0.0};
    return sum;
}

} // namespace driven
