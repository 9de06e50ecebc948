// tests/tissue/quadratic_theory_test.cpp
// Where the real-time quadratic solver comes to rest under a load on its end: small and large
// bending, Cook's membrane, nearly incompressible too.
#include "tests/tissue/quadratic_bodies.h"

#include <doctest/doctest.h>

using glm::dvec3;

namespace {

/// Held at x = 0, `pull_n` spread evenly over the face at x = `end_m`.
struct PulledBody {
    tissue::QuadraticMesh mesh;
    tissue::QuadraticModel model;
    std::vector<double> end, load_n;

    PulledBody(const tissue::TetMesh& corners, const tissue::Material& material, double end_m,
               const dvec3& pull_n)
        : mesh(tissue::quadratic_mesh(corners)),
          model(make_quadratic(mesh, material, quadratic_bodies::held_at_x0(mesh))),
          end(reference_bodies::face_areas_m2(mesh,
                                              [&](auto x) { return x.x > end_m * (1.0 - 1e-6); })),
          load_n(static_cast<std::size_t>(model.unknowns)) {
        double area_m2 = 0.0;
        for (const double a : end)
            area_m2 += a;
        for (std::size_t i = 0; i < end.size(); ++i) {
            for (int k = 0; k < 3 && model.dof[i] >= 0; ++k)
                load_n[model.dof[i] + k] = pull_n[k] * end[i] / area_m2;
        }
    }

    /// After so many steps so long that the mass hardly counts, each an exact Newton's.
    std::vector<dvec3> pulled_m(double dt_s, int steps) const {
        auto system = make_system(model, dt_s);
        auto state = rest_state(model);
        std::vector<double> du(load_n.size());
        tissue::QuadraticReport report;
        for (int i = 0; i < steps; ++i) {
            linearize(model, state, system, load_n);
            report = free_motion(model, quadratic_bodies::exact(), system, du);
            advance(model, system, du, state);
        }
        CHECK(report.relative_residual < 1e-5);
        return state.position_m;
    }
    dvec3 end_moved_m(double dt_s, int steps) const {
        return reference_bodies::mean_displacement_m(mesh, pulled_m(dt_s, steps), end);
    }
};

// Cantilever 100 x 20 x 20 mm, E 10 kPa, bent by a thousandth of 10 mN: a thousand times the
// deflection of its end, mm.
double cantilever_mm(double poisson) {
    const PulledBody beam(tissue::box_mesh({0.1, 0.02, 0.02}, {10, 2, 2}),
                          bodies::elastic(10e3, poisson), 0.1, {0, 0, 10e-6});
    return 1e3 * 1e3 * beam.end_moved_m(100.0, 3).z;
}

// Cook's membrane, a unit 1 mm of length and 1 kPa of stress, 10 thick, sheared by a ten-thousandth
// of 10: ten thousand times the deflection of the middle of its end, mm.
double cook_mm(double poisson) {
    auto corners = tissue::box_mesh({48e-3, 1e-3, 10e-3}, {8, 8, 2});
    for (dvec3& x : corners.rest_m) {
        const double low = 44 * x.x / 48, high = 44e-3 + 16 * x.x / 48;
        x.y = low + 1e3 * x.y * (high - low);
    }
    const PulledBody cook(corners, bodies::elastic(1e3, poisson), 48e-3, {0, 1e-4 * 10e-3, 0});
    const auto x = cook.pulled_m(100.0, 3);
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (glm::length(cook.mesh.rest_m[i] - dvec3(48e-3, 52e-3, 5e-3)) < 1e-6)
            return 1e3 * 1e4 * (x[i].y - 52e-3);
    }
    return 0.0;
}

} // namespace

TEST_CASE("quadratic theory: a cantilever bends as converged ones do, near nu = 0.5 too") {
    // Timoshenko (nu = 0), an independent solver's P2 on the same cells, and what its P2 on 10, 20
    // and 30 cells tends to
    struct Case {
        double poisson, same_mm, converged_mm, gate;
    };
    CHECK(cantilever_mm(0.0) == doctest::Approx(25.600).scale(0.0).epsilon(5e-3));
    for (const Case& c :
         {Case{0.30, 25.21, 25.43, 0.01}, {0.45, 24.30, 25.04, 0.03}, {0.49, 23.59, 24.89, 0.06}}) {
        const double w_mm = cantilever_mm(c.poisson);
        CHECK(w_mm == doctest::Approx(c.same_mm).scale(0.0).epsilon(2e-3));
        CHECK(w_mm == doctest::Approx(c.converged_mm).scale(0.0).epsilon(c.gate));
    }
}

TEST_CASE("quadratic theory: a slender beam follows the elastica from small to large bending") {
    // Mattiasson (1981)
    struct Case {
        double alpha, deflection, shortening;
    };
    const double length = 0.2, side = 0.01, young = 100e3;
    for (const Case& c : {Case{0.25, 0.08275, 0.00412},
                          {1.0, 0.30172, 0.05643},
                          {3.0, 0.60325, 0.25442},
                          {10.0, 0.81061, 0.55500}}) {
        const double pull_n = c.alpha * young * std::pow(side, 4) / 12 / (length * length);
        auto material = bodies::elastic(young, 0.0);
        material.damping_mass_1ps = 4.0;
        const PulledBody beam(tissue::box_mesh({length, side, side}, {40, 2, 1}), material, length,
                              {0, pull_n, 0});
        const dvec3 tip = beam.end_moved_m(0.05, 200) / length;
        CHECK(tip.y == doctest::Approx(c.deflection).scale(0.0).epsilon(0.01));
        CHECK(-tip.x == doctest::Approx(c.shortening).scale(0.0).epsilon(0.01));
    }
}

TEST_CASE("quadratic theory: Cook's membrane leans as other quadratic tetrahedra let it") {
    // an independent solver's P2 on 8 x 8 x 2 cells; converged: 23.79, 23.79, 23.83, 24.0
    struct Case {
        double poisson, same_mm, converged_mm, gate;
    };
    for (const Case& c : {Case{1.0 / 3, 23.66, 23.79, 0.015},
                          {0.45, 23.46, 23.79, 0.015},
                          {0.49, 23.12, 23.83, 0.03}}) {
        const double w_mm = cook_mm(c.poisson);
        CHECK(w_mm == doctest::Approx(c.same_mm).scale(0.0).epsilon(3e-3));
        CHECK(w_mm == doctest::Approx(c.converged_mm).scale(0.0).epsilon(c.gate));
    }
}
