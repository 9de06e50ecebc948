// tests/tissue/quadratic_beam_test.cpp
// The beam that systems are compared by, in real-time steps: on its way and at rest.
#include "tests/tissue/quadratic_bodies.h"

#include <doctest/doctest.h>

using glm::dvec3;

namespace {

struct Beam {
    tissue::QuadraticMesh mesh =
        tissue::quadratic_mesh(tissue::box_mesh({0.2, 0.04, 0.04}, {10, 2, 2}));
    tissue::QuadraticModel model;
    tissue::QuadraticSystem system;
    tissue::QuadraticState state;
    std::size_t tip = 0;

    Beam(const tissue::Material& material, double dt_s)
        : model(make_quadratic(mesh, material, quadratic_bodies::held_at_x0(mesh), {0, -9.81, 0})),
          system(make_system(model, dt_s)), state(rest_state(model)) {
        while (glm::length(mesh.rest_m[tip] - dvec3(0.2, 0.02, 0.02)) > 1e-9)
            ++tip;
    }
    dvec3 tip_m() const { return state.position_m[tip] - mesh.rest_m[tip]; }
};

} // namespace

TEST_CASE("the tip of a falling beam stays within 3 % of the reference's at every step") {
    struct Case {
        double young_pa, poisson;
        bool folds; // to det F = 0.2; its tangent is indefinite on the way
    };
    for (const Case& c : {Case{100e3, 0.45, false}, {100e3, 0.49, false}, {30e3, 0.3, true}}) {
        const auto material = bodies::elastic(c.young_pa, c.poisson);
        Beam beam(material, 0.01);
        const auto reference =
            make_reference(beam.mesh, material, tissue::Law::neo_hooke,
                           quadratic_bodies::held_at_x0(beam.mesh), {0, -9.81, 0});
        auto exact = make_system(reference);
        auto expected = rest_state(reference);
        int projected = 0;
        for (int i = 0; i < 60; ++i) { // down, up and down again
            const auto report = quadratic_bodies::step(beam.model, {}, beam.system, beam.state);
            step(reference, {}, 0.01, tissue::TimeRule::implicit_euler, {.tolerance = 1e-6}, exact,
                 expected);
            const dvec3 there = expected.position_m[beam.tip] - beam.mesh.rest_m[beam.tip];
            CHECK(glm::length(beam.tip_m() - there) < 0.03 * glm::length(there));
            CHECK(report.linear_residual <= 1e-3);
            CHECK((c.folds || report.relative_residual <= 1e-3));
            projected += report.projected;
        }
        CHECK((projected > 0) == c.folds);
    }
}

TEST_CASE("a settled beam of 240 quadratic tets is within 3 % of the converged one") {
    for (const double dt_s : {0.01, 1.0 / 60, 0.02}) {
        auto material = bodies::elastic(100e3, 0.45);
        material.damping_mass_1ps = 10.0; // where it ends does not depend on it
        Beam beam(material, dt_s);
        for (int i = 0; i < static_cast<int>(3.0 / dt_s); ++i)
            quadratic_bodies::step(beam.model, {}, beam.system, beam.state);
        // CalculiX 2.20 and an independent solver
        const dvec3 converged{-38.2e-3, -113.8e-3, 0};
        CHECK(glm::length(beam.tip_m() - converged) < 0.03 * glm::length(converged));
        // the same mesh, in equilibrium; 3 s of damping leave exp(-15) of the fall
        const auto still = reference_bodies::heavy_beam({10, 2, 2}, 100e3, 0.45);
        CHECK(glm::length(beam.tip_m() - reference_bodies::tip_m(still)) <
              2e-3 * glm::length(converged));
    }
}
