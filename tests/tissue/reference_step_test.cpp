// tests/tissue/reference_step_test.cpp
// Time steps of the reference solver against closed forms of the discrete rules and invariants.
#include "tests/tissue/reference_bodies.h"

#include <doctest/doctest.h>
#include <numbers>

using bodies::elastic;
using glm::dvec3;
using reference_bodies::flags;
using reference_bodies::irregular_box;
using reference_bodies::places;
using tissue::kHeld;
using tissue::Law;
using tissue::TimeRule;

namespace {

const dvec3 kBox{0.04, 0.04, 0.04};
constexpr TimeRule kRules[]{TimeRule::implicit_euler, TimeRule::midpoint};

struct Momentum {
    dvec3 linear_ns{0.0}, angular_nms{0.0};
    double kinetic_j = 0.0;
};

Momentum momentum(const tissue::ReferenceModel& model, const tissue::ReferenceState& state) {
    std::vector<double> v(model.unknown.size()), p(v.size());
    for (std::size_t i = 0; i < v.size(); ++i)
        v[i] = state.velocity_mps[i / 3][static_cast<int>(i % 3)];
    multiply(model.all, model.mass_kg, v, p);
    Momentum m;
    for (std::size_t i = 0; i < state.position_m.size(); ++i) {
        const dvec3 pi{p[3 * i], p[3 * i + 1], p[3 * i + 2]};
        m.linear_ns += pi;
        m.angular_nms += glm::cross(state.position_m[i], pi);
        m.kinetic_j += 0.5 * glm::dot(pi, state.velocity_mps[i]);
    }
    return m;
}

// A bar along x held at x = 0 in x, and nowhere across: with nu = 0 its motion along x is that of a
// string of springs, slowest mode sin(pi x / 2 L), omega = pi/(2 L) sqrt(E/rho).
struct Bar {
    static constexpr double kLength = 0.08, kYoung = 10e3, kDensity = 1000.0, kStretch_m = 1e-3;
    tissue::ReferenceModel model;
    tissue::ReferenceState state;
    double omega_radps = std::numbers::pi / (2 * kLength) * std::sqrt(kYoung / kDensity);

    explicit Bar(tissue::Material material) {
        const auto mesh =
            tissue::quadratic_mesh(tissue::box_mesh({kLength, 0.01, 0.01}, {8, 1, 1}));
        model = make_reference(mesh, material, Law::small_strain, flags(mesh, [](const dvec3& x) {
                                   return tissue::kHeldY | tissue::kHeldZ |
                                          (x.x < 1e-9 ? tissue::kHeldX : 0);
                               }));
        state = rest_state(model);
        for (dvec3& x : state.position_m)
            x.x += kStretch_m * std::sin(std::numbers::pi * x.x / (2 * kLength));
    }
    double end_m() const {
        for (std::size_t i = 0; i < state.position_m.size(); ++i) {
            if (model.mesh.rest_m[i].x > kLength - 1e-9)
                return state.position_m[i].x - kLength;
        }
        return 0.0;
    }
};

// The same rule for one degree of freedom, x'' + (alpha + beta w^2) x' + w^2 x = 0.
void scalar_step(double omega, double alpha, double beta, double dt, TimeRule rule, double& x,
                 double& v) {
    const double h = rule == TimeRule::midpoint ? dt / 2 : dt;
    const double w2 = omega * omega, c = alpha + beta * w2;
    const double v_new = (v - h * w2 * x) / (1 + h * c + h * h * w2);
    const double x_new = x + h * v_new;
    x = rule == TimeRule::midpoint ? 2 * x_new - x : x_new;
    v = rule == TimeRule::midpoint ? 2 * v_new - v : v_new;
}

} // namespace

TEST_CASE("the mass of a reference body is its own, and its weight is exact") {
    const auto mesh = irregular_box(kBox, 2, 2);
    const dvec3 gravity{1, 2, -9.81};
    const auto model = make_reference(mesh, elastic(1e3, 0.3, 1060.0), Law::neo_hooke, {}, gravity);
    const double mass = 1060.0 * kBox.x * kBox.y * kBox.z;
    // rigid translation, then rotation about the centre: m v^2/2, and a^2 m/6 w^2/2 of a cube
    tissue::ReferenceState state = rest_state(model);
    for (dvec3& v : state.velocity_mps)
        v = {0, 2, 0};
    CHECK(momentum(model, state).kinetic_j == doctest::Approx(2 * mass).scale(0.0).epsilon(1e-12));
    for (std::size_t i = 0; i < state.position_m.size(); ++i)
        state.velocity_mps[i] = glm::cross(dvec3(0, 0, 3), mesh.rest_m[i] - 0.5 * kBox);
    CHECK(momentum(model, state).kinetic_j ==
          doctest::Approx(0.5 * 9 * mass * kBox.x * kBox.x / 6).scale(0.0).epsilon(1e-12));
    dvec3 weight{0.0};
    for (std::size_t i = 0; i < model.weight_n.size(); ++i)
        weight[static_cast<int>(i % 3)] += model.weight_n[i];
    CHECK(glm::length(weight - mass * gravity) < 1e-12 * mass * 9.81);
}

TEST_CASE("a falling body falls as one, by each rule's own formula") {
    // n steps: x = g dt^2 n (n + 1)/2 implicit Euler, g (n dt)^2 / 2 midpoint
    const auto mesh = irregular_box(kBox, 2, 2);
    const dvec3 gravity{0, 3, -9.81};
    const auto model = make_reference(mesh, elastic(1e3, 0.3), Law::neo_hooke, {}, gravity);
    const double dt = 0.01;
    for (const TimeRule rule : kRules) {
        tissue::ReferenceSystem system = make_system(model);
        tissue::ReferenceState state = rest_state(model);
        for (int n = 1; n <= 5; ++n) {
            CHECK(step(model, {}, dt, rule, {.tolerance = 1e-13}, system, state).converged);
            const dvec3 fallen =
                gravity * dt * dt * (rule == TimeRule::midpoint ? n * n / 2.0 : n * (n + 1) / 2.0);
            for (std::size_t i = 0; i < mesh.rest_m.size(); ++i)
                CHECK(glm::length(state.position_m[i] - mesh.rest_m[i] - fallen) < 1e-10 * kBox.x);
        }
    }
}

TEST_CASE("a free body keeps its momentum; by the midpoint rule its angular momentum too") {
    const auto mesh = irregular_box(kBox, 2, 7);
    const auto model = make_reference(mesh, elastic(5e3, 0.45), Law::neo_hooke, {});
    for (const TimeRule rule : kRules) {
        tissue::ReferenceSystem system = make_system(model);
        tissue::ReferenceState state = rest_state(model);
        // turning, sheared and pulled at 10 m/s per m: strains of tens of per cent
        for (std::size_t i = 0; i < state.velocity_mps.size(); ++i) {
            const dvec3 x = mesh.rest_m[i] - 0.3 * kBox;
            state.velocity_mps[i] = dvec3(10 * x.y, 15 * x.z - 10 * x.y, 300 * x.x * x.y + 0.2);
        }
        const Momentum before = momentum(model, state);
        double most_j = 0.0;
        for (int n = 0; n < 20; ++n) {
            const Momentum last = momentum(model, state);
            const auto report = step(model, {}, 5e-3, rule, {.tolerance = 1e-13}, system, state);
            REQUIRE(report.relative_residual < 1e-12);
            const Momentum now = momentum(model, state);
            CHECK(glm::length(now.linear_ns - last.linear_ns) <
                  1e-9 * glm::length(before.linear_ns));
            if (rule == TimeRule::midpoint) {
                CHECK(glm::length(now.angular_nms - last.angular_nms) <
                      1e-9 * glm::length(before.angular_nms));
            }
            most_j = std::max(most_j, report.energy_j);
        }
        CHECK(most_j > 0.1 * before.kinetic_j); // it did deform
        CHECK(glm::length(momentum(model, state).linear_ns - before.linear_ns) <
              1e-9 * glm::length(before.linear_ns));
    }
}

TEST_CASE("a bar swings with the string's frequency and loses what the rule takes") {
    // eight quadratic elements: the discrete frequency is right to 1e-6
    for (const TimeRule rule : kRules) {
        Bar bar(elastic(Bar::kYoung, 0.0));
        tissue::ReferenceSystem system = make_system(bar.model);
        // omega dt = 0.31: 20 steps a period. Amplification per step: implicit Euler
        // 1/(1 - i omega dt), midpoint (1 + i omega dt/2)/(1 - i omega dt/2)
        const double dt = 2 * std::numbers::pi / bar.omega_radps / 20;
        const double w = bar.omega_radps * dt;
        for (int n = 1; n <= 30; ++n) {
            CHECK(step(bar.model, {}, dt, rule, {}, system, bar.state).converged);
            const bool euler = rule == TimeRule::implicit_euler;
            const double size = euler ? std::pow(1 + w * w, -0.5 * n) : 1.0;
            const double angle = n * (euler ? std::atan(w) : 2 * std::atan(w / 2));
            const double expected = Bar::kStretch_m * size * std::cos(angle);
            CHECK(std::abs(bar.end_m() - expected) < 1e-3 * Bar::kStretch_m);
        }
    }
}

TEST_CASE("damping of a mode is alpha + beta omega^2") {
    tissue::Material material = elastic(Bar::kYoung, 0.0);
    material.damping_mass_1ps = 10.0;
    material.damping_stiffness_s = 3e-3;
    for (const TimeRule rule : kRules) {
        Bar bar(material);
        tissue::ReferenceSystem system = make_system(bar.model);
        const double dt = 2 * std::numbers::pi / bar.omega_radps / 20;
        double x = Bar::kStretch_m, v = 0.0;
        for (int n = 1; n <= 15; ++n) {
            CHECK(step(bar.model, {}, dt, rule, {}, system, bar.state).converged);
            scalar_step(bar.omega_radps, 10.0, 3e-3, dt, rule, x, v);
            CHECK(std::abs(bar.end_m() - x) < 1e-3 * Bar::kStretch_m);
        }
    }
}

TEST_CASE("by the midpoint rule a linear body keeps its energy") {
    Bar bar(elastic(Bar::kYoung, 0.0));
    tissue::ReferenceSystem system = make_system(bar.model);
    const double start_j = elastic_energy_j(bar.model, bar.state.position_m);
    for (int n = 0; n < 40; ++n) {
        step(bar.model, {}, 4e-3, TimeRule::midpoint, {.tolerance = 1e-13}, system, bar.state);
        const double now_j = elastic_energy_j(bar.model, bar.state.position_m) +
                             momentum(bar.model, bar.state).kinetic_j;
        CHECK(now_j == doctest::Approx(start_j).scale(0.0).epsilon(1e-10));
    }
}

TEST_CASE("a base that accelerates is gravity the other way") {
    // in the frame of a base at a (n dt)^2/2 (midpoint), a dt^2 n (n + 1)/2 (implicit Euler: its
    // discrete acceleration is a from the first step on) the body weighs -a
    const auto mesh = irregular_box(kBox, 2, 7);
    const auto held = flags(mesh, [](const dvec3& x) { return x.z < 1e-9 ? kHeld : 0; });
    tissue::Material material = elastic(2e3, 0.45);
    material.damping_stiffness_s = 2e-3; // alpha would know the frame
    const dvec3 a{8, 0, 5};
    const auto shaken = make_reference(mesh, material, Law::neo_hooke, held);
    const auto weighed = make_reference(mesh, material, Law::neo_hooke, held, -a);
    tissue::ReferenceSystem system = make_system(shaken);
    const double dt = 0.01;
    for (const TimeRule rule : kRules) {
        tissue::ReferenceState moving = rest_state(shaken), resting = rest_state(weighed);
        double sag_m = 0.0;
        for (int n = 1; n <= 10; ++n) {
            const double steps2 = rule == TimeRule::midpoint ? n * n : n * (n + 1);
            const dvec3 base = a * dt * dt * steps2 / 2.0;
            const auto target = places(mesh, [&](const dvec3& x) { return x + base; });
            CHECK(step(shaken, {{}, target}, dt, rule, {}, system, moving).converged);
            CHECK(step(weighed, {}, dt, rule, {}, system, resting).converged);
            for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
                CHECK(glm::length(moving.position_m[i] - base - resting.position_m[i]) <
                      1e-8 * kBox.x);
                sag_m = std::max(sag_m, glm::length(resting.position_m[i] - mesh.rest_m[i]));
            }
        }
        CHECK(sag_m > 0.02 * kBox.x);
    }
}

TEST_CASE("a body left to itself under damping ends at the static equilibrium") {
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh({0.2, 0.04, 0.04}, {6, 1, 1}));
    const auto held = flags(mesh, [](const dvec3& x) { return x.x < 1e-9 ? kHeld : 0; });
    tissue::Material material = elastic(100e3, 0.45);
    material.damping_mass_1ps = 8.0;
    const auto model = make_reference(mesh, material, Law::neo_hooke, held, {0, -9.81, 0});
    tissue::ReferenceSystem system = make_system(model);
    tissue::ReferenceState moving = rest_state(model), still = rest_state(model);
    CHECK(solve_static(model, {}, {}, system, still).converged);
    for (int n = 0; n < 300; ++n) {
        REQUIRE(step(model, {}, 0.02, TimeRule::implicit_euler, {}, system, moving).converged);
    }
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i)
        CHECK(glm::length(moving.position_m[i] - still.position_m[i]) < 1e-6 * 0.2);
}
