// tests/tissue/quadratic_invariance_test.cpp
// What no motion may do to a real-time quadratic body, with and without a memory: forces from
// turning it, momentum from inside, and less or more damping than implicit Euler's own.
#include "tests/tissue/quadratic_bodies.h"

#include <doctest/doctest.h>
#include <numbers>

using bodies::elastic;
using glm::dvec3;

namespace {

dvec3 at(const std::vector<double>& node_vector, std::size_t node) {
    return {node_vector[4 * node], node_vector[4 * node + 1], node_vector[4 * node + 2]};
}

tissue::Material with_memory(double poisson) {
    auto m = elastic(20e3, poisson);
    m.prony = {{0.4, 0.05}, {0.2, 1.0}};
    return m;
}

} // namespace

TEST_CASE("turned by 1 to 720 degrees a quadratic body makes no force") {
    const auto mesh = quadratic_bodies::curved_box(3);
    for (const double poisson : {0.3, 0.45, 0.49}) {
        const auto model = make_quadratic(mesh, with_memory(poisson), {});
        auto system = make_system(model, 0.01);
        for (const double degrees : {1.0, 37.0, 90.0, 179.0, 360.0, 720.0}) {
            auto state = rest_state(model);
            const auto R = bodies::rotation({1, -2, 3}, degrees * std::numbers::pi / 180);
            for (dvec3& x : state.position_m)
                x = R * x + dvec3(0.3, 0.1, -0.2);
            linearize(model, state, system);
            // E times the area of the box's least face
            for (std::size_t i = 0; i < mesh.rest_m.size(); ++i)
                CHECK(glm::length(at(system.internal_n, i)) < 1e-9 * 20e3 * 0.08 * 0.06);
        }
    }
}

TEST_CASE("forces inside a bent quadratic body sum to nothing, and turn nothing") {
    const auto mesh = quadratic_bodies::curved_box(3);
    for (const double poisson : {0.3, 0.49}) {
        const auto model = make_quadratic(mesh, with_memory(poisson), {});
        auto system = make_system(model, 0.01);
        auto state = rest_state(model);
        for (int i = 0; i < 20; ++i) { // something to remember
            state.velocity_mps = quadratic_bodies::random_vectors(mesh.rest_m.size(), 0.3, 7);
            quadratic_bodies::step(model, {}, system, state);
        }
        for (auto* v : {&state.velocity_mps, &state.gain_mps})
            v->assign(mesh.rest_m.size(), dvec3{0.0});
        linearize(model, state, system);
        dvec3 force{0.0}, torque{0.0};
        double forces = 0.0, torques = 0.0;
        for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
            const dvec3 f = at(system.internal_n, i);
            force += f;
            torque += glm::cross(state.position_m[i], f);
            forces += glm::length(f);
            torques += glm::length(glm::cross(state.position_m[i], f));
        }
        CHECK(forces > 1e-3);
        CHECK(glm::length(force) < 1e-12 * forces);
        CHECK(glm::length(torque) < 1e-12 * torques);
    }
}

TEST_CASE("a quadratic bar swings with the string's frequency and loses what the rule takes") {
    // nu = 0, clamped at x = 0: slowest mode sin(pi x/2L), omega = pi/(2L) sqrt(E/rho); per step
    // 1/(1 - i omega dt)
    constexpr double kLength = 0.08, kYoung = 10e3, kStretch_m = 1e-6;
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh({kLength, 0.01, 0.01}, {8, 1, 1}));
    const auto model =
        make_quadratic(mesh, elastic(kYoung, 0.0), quadratic_bodies::held_at_x0(mesh));
    const double omega = std::numbers::pi / (2 * kLength) * std::sqrt(kYoung / 1000.0);
    std::size_t end = 0;
    while (mesh.rest_m[end].x < kLength - 1e-9)
        ++end;
    for (const int steps : {8, 20, 60}) { // a period
        const double dt = 2 * std::numbers::pi / omega / steps, w = omega * dt;
        auto system = make_system(model, dt);
        auto state = rest_state(model);
        for (dvec3& x : state.position_m)
            x.x += kStretch_m * std::sin(std::numbers::pi * x.x / (2 * kLength));
        for (int n = 1; n <= 2 * steps; ++n) {
            quadratic_bodies::step(model, quadratic_bodies::exact(), system, state);
            const double expected =
                kStretch_m * std::pow(1 + w * w, -0.5 * n) * std::cos(n * std::atan(w));
            CHECK(std::abs(state.position_m[end].x - kLength - expected) < 1e-3 * kStretch_m);
        }
    }
}
