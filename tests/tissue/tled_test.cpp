// tests/tissue/tled_test.cpp
// Total Lagrangian explicit dynamics: stress and critical step against closed forms, statics
// against the corotated solver, and where it explodes or stays inverted.
#include "tests/tissue/baselines.h"

#include <doctest/doctest.h>

using bodies::elastic;
using glm::dvec3;

TEST_CASE("a sheared block pulls with mu gamma A, inside there is no force") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.03, 0.02, 0.02}, {3, 2, 2}, 0.1);
    const auto model = tissue::make_tled(mesh, elastic(8e3, 0.45), {});
    const double mu_pa = 8e3 / (2 * 1.45), shear = 0.7;
    tissue::BaselineState state = tissue::rest_state(model.body);
    for (dvec3& x : state.position_m)
        x.x += shear * x.z;
    std::vector<dvec3> force(mesh.rest_m.size());
    tissue::elastic_forces(model, state, force);
    double top_n = 0.0;
    for (std::size_t i = 0; i < force.size(); ++i) {
        const dvec3 x = mesh.rest_m[i];
        top_n += x.z > 0.02 - 1e-9 ? force[i].x : 0.0;
        const bool side = x.x < 1e-9 || x.y < 1e-9 || x.z < 1e-9 || x.x > 0.03 - 1e-9 ||
                          x.y > 0.02 - 1e-9 || x.z > 0.02 - 1e-9;
        if (!side)
            CHECK(glm::length(force[i]) < 1e-14);
    }
    CHECK(baselines::off(top_n, mu_pa * shear * 0.03 * 0.02) < 1e-12);
}

TEST_CASE("forces of TLED are the gradient of its energy") {
    const auto model = tissue::make_tled(baselines::small_box(), elastic(7e3, 0.3), {});
    CHECK(baselines::gradient_error(model, baselines::shaken(model.body, 1e-3, 0, 4)) < 1e-6);
}

TEST_CASE("a lone tet's critical step is the time a pressure wave takes through its height") {
    // K = V (lambda + 2 mu)/H^2, m = rho V/4: 2/omega = H/c_p
    const double height_m = 0.008;
    for (const double poisson : {0.3, 0.45, 0.499}) {
        const tissue::Material material = elastic(7e3, poisson);
        const tissue::Lame l = tissue::lame(material);
        const auto model =
            tissue::make_tled(baselines::lone_tet(height_m), material, baselines::kBase);
        CHECK(baselines::off(model.critical_s,
                             height_m * std::sqrt(1000 / (l.lambda_pa + 2 * l.mu_pa))) < 1e-4);
        CHECK(baselines::off(model.substep_s, 0.9 * model.critical_s) < 1e-12);
    }
}

TEST_CASE("critical steps of a cube are those computed by others, and vanish as nu goes to 1/2") {
    // 30 mm, 6^3 cells, rho 1000, E = 10 kPa; eigenvalues of an assembled matrix, to 3 digits
    const double published_ms[][3] = {
        {0.3, 0.913, 5e-4}, {0.45, 0.523, 5e-4}, {0.49, 0.242, 5e-4}, {0.499, 0.0769, 5e-5}};
    const tissue::TetMesh mesh = tissue::box_mesh({0.03, 0.03, 0.03}, {6, 6, 6});
    for (const auto& [poisson, ms, rounding_ms] : published_ms) {
        const auto model = tissue::make_tled(mesh, elastic(1e4, poisson), {});
        CHECK(std::abs(1e3 * model.critical_s - ms) < rounding_ms);
    }
}

TEST_CASE("central differences are stable below the critical step and diverge above it") {
    for (const double poisson : {0.3, 0.49}) {
        auto model = tissue::make_tled(baselines::small_box(), elastic(7e3, poisson), {});
        for (const double share : {0.95, 1.05}) {
            model.substep_s = share * model.critical_s;
            tissue::BaselineState state = baselines::shaken(model.body, 0, 1e-6, 5);
            const auto report = baselines::run(model, {}, model.substep_s, 1000, state);
            // what grows by (1.05 + sqrt(1.05^2 - 1))^2 = 1.9 each step ends as no number
            CHECK((report.finite && baselines::fastest_mps(state) < 2e-5) == (share < 1));
            CHECK((!report.finite || baselines::fastest_mps(state) > 1.0) == (share > 1));
        }
    }
}

TEST_CASE("TLED loses no energy in ten seconds") {
    CHECK(baselines::energy_drift(
              tissue::make_tled(baselines::small_box(), elastic(7e3, 0.3), {})) < 0.01);
}

TEST_CASE("a beam of TLED settles where linear tetrahedra do, locked") {
    // Strains below a thousandth: neo-Hooke and corotated are one law
    for (const double poisson : {0.3, 0.49}) {
        baselines::Beam beam({10, 2, 2}, 1e5, poisson);
        beam.gravity_mps2 *= 0.01;
        const auto state = baselines::settled(beam.made<tissue::TledModel>(), {}, 0.01, 1e-7, 2000);
        const double tip = beam.tip_m(state).y, p1 = beam.tip_m(beam.p1()).y;
        MESSAGE("nu ", poisson, " tip ", 1e3 * tip, " mm, P1 ", 1e3 * p1);
        CHECK(baselines::off(tip, p1) < 2e-3);
    }
}

TEST_CASE("a tet pushed through its base by TLED rests inside out") {
    // Over a held base of rest shape, F = diag(1, 1, -s) rests where
    //   (2/3) mu (s^1/3 - s^-5/3) + K (s + 1) = 0
    const double height_m = 0.008;
    tissue::Material material = elastic(7e3, 0.3);
    material.damping_mass_1ps = 2000.0;
    auto model = tissue::make_tled(baselines::lone_tet(height_m), material, baselines::kBase);
    model.substep_s *= 0.05; // longer ones may leap over the wall at det F = 0
    const double mu = model.elasticity.mu_pa, bulk = model.elasticity.bulk_pa;
    double low = 1e-3, high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double s = 0.5 * (low + high);
        const double slope =
            2.0 / 3 * mu * (std::cbrt(s) - 1 / std::cbrt(std::pow(s, 5))) + bulk * (s + 1);
        (slope < 0 ? low : high) = s;
    }
    tissue::BaselineState state = tissue::rest_state(model.body);
    state.position_m[3].z = -0.5 * height_m;
    const auto report = baselines::run(model, {}, 0.001, 2000, state);
    CHECK(report.finite);
    CHECK(report.inverted == 1);
    CHECK(baselines::off(state.position_m[3].z, -low * height_m) < 1e-6);
}
