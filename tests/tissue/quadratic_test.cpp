// tests/tissue/quadratic_test.cpp
// The real-time quadratic solver beside the reference solver, and invariants of both.
#include "tests/tissue/allocations.h"
#include "tests/tissue/quadratic_bodies.h"

#include <doctest/doctest.h>
#include <numeric>

using bodies::elastic;
using glm::dvec3;
using quadratic_bodies::bent;
using quadratic_bodies::curved_box;
using quadratic_bodies::greatest_distance_m;
using quadratic_bodies::held_at_x0;
using quadratic_bodies::random_vectors;
using quadratic_bodies::step;
using tissue::Law;

namespace {

tissue::Material damped(double poisson) {
    tissue::Material m = elastic(20e3, poisson);
    m.damping_mass_1ps = 1.5;
    m.damping_stiffness_s = 4e-3;
    return m;
}

} // namespace

TEST_CASE("forces of a bent body of curved tets are the reference's to rounding") {
    const auto mesh = curved_box(3);
    const auto material = elastic(20e3, 0.45);
    const auto model = make_quadratic(mesh, material, {});
    const auto reference = make_reference(mesh, material, Law::neo_hooke, {});
    auto system = make_system(model, 0.01);
    auto state = rest_state(model);
    state.position_m = bent(mesh.rest_m, 5);
    linearize(model, state, system);

    std::vector<dvec3> expected(mesh.rest_m.size());
    elastic_forces(reference, state.position_m, expected);
    double greatest = 0.0, off = 0.0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const dvec3 f{system.internal_n[4 * i], system.internal_n[4 * i + 1],
                      system.internal_n[4 * i + 2]};
        greatest = std::max(greatest, glm::length(expected[i]));
        off = std::max(off, glm::length(f - expected[i]));
    }
    CHECK(off < 1e-12 * greatest);
    CHECK(system.energy_j ==
          doctest::Approx(elastic_energy_j(reference, state.position_m)).scale(0.0));
    auto exact = make_system(reference);
    linearize(reference, {state.position_m, {}}, exact);
    CHECK(system.min_det_f == doctest::Approx(exact.min_det_f).scale(0.0));
}

TEST_CASE("a solve of any right-hand side leaves what it says of the reference's matrix") {
    const auto mesh = curved_box(3);
    const auto material = damped(0.45);
    const auto held = held_at_x0(mesh);
    const auto model = make_quadratic(mesh, material, held, {5, -30, 0});
    const auto reference = make_reference(mesh, material, Law::neo_hooke, held);
    const double dt = 0.01;
    auto system = make_system(model, dt);
    auto state = rest_state(model);
    for (int i = 0; i < 20; ++i)
        step(model, {}, system, state);
    CHECK(greatest_distance_m(state.position_m, mesh.rest_m) > 0.02);
    for (auto* v : {&state.velocity_mps, &state.gain_mps})
        v->assign(mesh.rest_m.size(), dvec3{0.0}); // so that A is made at `state` itself
    linearize(model, state, system);

    auto exact = make_system(reference);
    linearize(reference, {state.position_m, {}}, exact);
    const auto n = static_cast<std::size_t>(model.unknowns);
    std::vector<double> matrix, b, x(n), Ax(n);
    for (const std::int32_t k : reference.free_source) {
        matrix.push_back((1 / (dt * dt) + material.damping_mass_1ps / dt) * reference.mass_kg[k] +
                         (1 + material.damping_stiffness_s / dt) * exact.stiffness[k]);
    }
    CHECK(exact.factor.factor(matrix));
    std::mt19937_64 random(1);
    for (std::size_t k = 0; k < n; ++k)
        b.push_back(bodies::signed_unit(random));
    for (const double tolerance : {1e-2, 1e-3, 1e-5}) {
        const auto report = solve(model, {.linear_tolerance = tolerance}, b, system, x);
        CHECK(report.iterations > 0);
        CHECK_FALSE(report.projected);
        CHECK(report.relative_residual <= tolerance);
        multiply(reference.free, matrix, x, Ax);
        for (std::size_t k = 0; k < n; ++k)
            Ax[k] -= b[k];
        // single precision: 1e-7 for each of some ten operations
        CHECK(std::abs(bodies::norm(Ax) / bodies::norm(b) - report.relative_residual) < 2e-6);
    }
}

TEST_CASE("damped steps of a bent body are the reference's") {
    for (const double poisson : {0.3, 0.45, 0.49}) {
        const auto mesh = curved_box(3);
        const auto held = held_at_x0(mesh);
        const dvec3 gravity{0, -9.81, 0};
        const auto model = make_quadratic(mesh, damped(poisson), held, gravity);
        const auto reference = make_reference(mesh, damped(poisson), Law::neo_hooke, held, gravity);
        auto system = make_system(model, 0.01);
        auto exact = make_system(reference);
        auto state = rest_state(model);
        state.velocity_mps = random_vectors(mesh.rest_m.size(), 0.1, 7);
        for (std::size_t i = 0; i < held.size(); ++i)
            state.velocity_mps[i] *= held[i] == 0;
        tissue::ReferenceState expected{state.position_m, state.velocity_mps};
        for (int i = 0; i < 10; ++i) {
            step(model, quadratic_bodies::exact(), system, state);
            step(reference, {}, 0.01, tissue::TimeRule::implicit_euler, {}, exact, expected);
        }
        const double moved = greatest_distance_m(expected.position_m, mesh.rest_m);
        CHECK(moved > 2e-3);
        // K d of the damping is summed in single precision
        CHECK(greatest_distance_m(state.position_m, expected.position_m) < 1e-5 * moved);
    }
}

TEST_CASE("where A is indefinite a solve says so and takes a positive one") {
    const auto mesh = curved_box(3);
    const auto material = elastic(20e3, 0.45);
    const auto held = held_at_x0(mesh);
    const auto model = make_quadratic(mesh, material, held);
    const auto reference = make_reference(mesh, material, Law::neo_hooke, held);
    auto system = make_system(model, 0.1);
    auto state = rest_state(model);
    for (dvec3& x : state.position_m)
        x *= 0.7; // pressed, and it wants to turn
    linearize(model, state, system);
    auto exact = make_system(reference);
    linearize(reference, {state.position_m, {}}, exact);
    std::vector<double> matrix;
    for (const std::int32_t k : reference.free_source)
        matrix.push_back(reference.mass_kg[k] / (0.1 * 0.1) + exact.stiffness[k]);
    CHECK_FALSE(exact.factor.factor(matrix));

    std::mt19937_64 random(1);
    std::vector<double> b, x(static_cast<std::size_t>(model.unknowns));
    for (int k = 0; k < model.unknowns; ++k)
        b.push_back(bodies::signed_unit(random));
    const auto first = solve(model, {}, b, system, x);
    CHECK(first.projected);
    CHECK(first.relative_residual <= 1e-3);
    CHECK_FALSE(solve(model, {}, b, system, x).projected); // already is
}

TEST_CASE("way and A^-1 residual is the first Newton iteration") {
    const auto mesh = curved_box(4);
    const auto model = make_quadratic(mesh, elastic(20e3, 0.45), held_at_x0(mesh), {0, -9.81, 0});
    auto system = make_system(model, 0.01);
    auto state = rest_state(model);
    const tissue::QuadraticOptions once{.max_newton = 1};
    for (int i = 0; i < 3; ++i)
        step(model, once, system, state);
    const auto n = static_cast<std::size_t>(model.unknowns);
    std::vector<double> way(n), residual(n), du(n), expected(n);
    linearize(model, state, system);
    way_and_residual(model, system, way, residual);
    solve(model, once, residual, system, du);
    free_motion(model, once, system, expected);
    for (std::size_t k = 0; k < n; ++k)
        CHECK(way[k] + du[k] == doctest::Approx(expected[k]).scale(0.0).epsilon(1e-6));
}

TEST_CASE("patch test: inside a boundary that moved affinely all nodes follow") {
    const dvec3 size{0.1, 0.08, 0.06};
    const auto mesh = reference_bodies::irregular_box(size, 3, 2);
    const auto held = reference_bodies::flags(
        mesh, [&](auto x) { return reference_bodies::on_box(x, size) ? tissue::kHeld : 0; });
    const glm::dmat3 F{1.2, 0.1, -0.05, 0.2, 0.9, 0.1, -0.1, 0.15, 1.05};
    const auto places = reference_bodies::places(mesh, [&](auto x) { return F * x; });
    auto material = elastic(20e3, 0.45);
    material.damping_mass_1ps = 100.0;
    const auto model = make_quadratic(mesh, material, held);
    auto system = make_system(model, 0.01);
    auto state = rest_state(model);
    const auto shake = random_vectors(mesh.rest_m.size(), 1e-3, 3);
    for (std::size_t i = 0; i < held.size(); ++i)
        state.position_m[i] = places[i] + (held[i] != 0 ? dvec3{0.0} : shake[i]);
    for (int i = 0; i < 100; ++i)
        step(model, quadratic_bodies::exact(), system, state);
    CHECK(greatest_distance_m(state.position_m, places) < 1e-9 * 0.1);
}

TEST_CASE("a turned body makes the turned step") {
    const auto mesh = curved_box(6);
    const auto model = make_quadratic(mesh, elastic(20e3, 0.45), {});
    auto system = make_system(model, 0.01);
    const glm::dmat3 R = bodies::rotation({1, 2, 3}, 2.5);
    auto straight = rest_state(model), turned = straight;
    straight.position_m = bent(mesh.rest_m, 5);
    straight.velocity_mps = random_vectors(mesh.rest_m.size(), 0.1, 9);
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
        turned.position_m[i] = R * straight.position_m[i];
        turned.velocity_mps[i] = R * straight.velocity_mps[i];
    }
    const auto before = straight.position_m;
    for (int i = 0; i < 5; ++i) {
        step(model, quadratic_bodies::exact(), system, straight);
        step(model, quadratic_bodies::exact(), system, turned);
    }
    CHECK(greatest_distance_m(straight.position_m, before) > 1e-2);
    for (dvec3& x : straight.position_m)
        x = R * x;
    CHECK(greatest_distance_m(straight.position_m, turned.position_m) < 1e-9 * 0.1);
}

TEST_CASE("a free body gains the momentum of its weight and no turn") {
    const auto mesh = curved_box(8);
    const dvec3 gravity{1, -9.81, 2};
    const auto model = make_quadratic(mesh, elastic(20e3, 0.45), {}, gravity);
    const double dt = 0.01;
    auto system = make_system(model, dt);
    auto state = rest_state(model);
    state.position_m = bent(mesh.rest_m, 5);
    state.velocity_mps = random_vectors(mesh.rest_m.size(), 0.1, 9);
    const auto momentum = [&] {
        dvec3 sum{0.0};
        for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
            for (int k = model.mass_start[i]; k < model.mass_start[i + 1]; ++k)
                sum += model.mass_kg[k] * state.velocity_mps[model.mass_column[k] / 4];
        }
        return sum;
    };
    for (int i = 0; i < 10; ++i) {
        const dvec3 before = momentum();
        step(model, quadratic_bodies::exact(), system, state);
        const dvec3 gain = momentum() - before;
        const dvec3 weight =
            std::accumulate(model.mass_kg.begin(), model.mass_kg.end(), 0.0) * gravity;
        CHECK(glm::length(gain - dt * weight) < 1e-9 * glm::length(dt * weight));
    }
}

TEST_CASE("a quadratic step allocates nothing outside CHOLMOD") {
    const auto mesh = curved_box(4);
    auto material = damped(0.45);
    material.prony = {{0.3, 0.5}};
    const auto model = make_quadratic(mesh, material, held_at_x0(mesh), {0, -9.81, 0});
    auto system = make_system(model, 0.01);
    auto state = rest_state(model);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns));
    const auto one = [&] {
        linearize(model, state, system);
        free_motion(model, {}, system, du);
        advance(model, system, du, state);
        solve(model, {}, du, system, du);
    };
    one();
    const std::size_t before = bodies::allocations();
    for (int i = 0; i < 20; ++i)
        one();
    for (dvec3& x : state.position_m)
        x.x = -x.x; // inside out
    one();
    CHECK(system.recovering);
    CHECK(bodies::allocations() == before);
}

TEST_CASE("setup of a quadratic body names what is wrong") {
    const auto mesh = curved_box(4);
    const auto model = make_quadratic(mesh, elastic(20e3, 0.45), held_at_x0(mesh));
    CHECK_THROWS_WITH_AS(make_system(model, 0.0), doctest::Contains("dt_s = 0.0"),
                         std::invalid_argument);
    CHECK_THROWS_AS(make_system(model, bodies::kStatics), std::invalid_argument);
    const std::vector<std::uint8_t> few(3);
    CHECK_THROWS_AS(make_quadratic(mesh, elastic(20e3, 0.45), few), std::invalid_argument);
}
