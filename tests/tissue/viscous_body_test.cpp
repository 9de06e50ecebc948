// tests/tissue/viscous_body_test.cpp
// Bodies with a Prony series, in the reference and in the real-time quadratic solver: relaxation,
// storage and loss, the step size, energy, and what turned inside out.
#include "tests/tissue/driven_bodies.h"

#include <complex>
#include <doctest/doctest.h>
#include <numbers>

using glm::dmat3;
using glm::dvec3;
using quadratic_bodies::greatest_distance_m;

namespace {

constexpr double kSide_m = 0.02;

// So light that inertia is nothing beside 9 kPa, also in a microsecond.
tissue::Material viscous(double poisson) {
    tissue::Material m = bodies::elastic(9e3, poisson, 1e-6);
    m.prony = {{0.3, 0.5}, {0.2, 8.0}};
    return m;
}

// G(t)/G0
double relaxed_share(const tissue::Material& m, double t_s) {
    double share = 1.0;
    for (const auto& [g, tau] : m.prony)
        share -= g * (1 - std::exp(-t_s / tau));
    return share;
}

std::complex<double> shear_modulus_pa(const tissue::Material& m, double w) {
    std::complex<double> share = relaxed_share(m, 1e9);
    for (const auto& [g, tau] : m.prony)
        share += g * std::complex(0.0, w * tau) / std::complex(1.0, w * tau);
    return share * lame(m).mu_pa;
}

tissue::QuadraticMesh cube() {
    return reference_bodies::irregular_box(dvec3(kSide_m), 2, 3);
}
// All of the surface held: inside, the field is homogeneous.
std::vector<std::uint8_t> surface(const tissue::QuadraticMesh& mesh) {
    return reference_bodies::flags(mesh, [](auto x) {
        return reference_bodies::on_box(x, dvec3(kSide_m)) ? tissue::kHeld : 0;
    });
}
bool on_top(const dvec3& x) {
    return x.z > kSide_m - 1e-9;
}
driven::Place sheared(double by) {
    return [by](const dvec3& x) { return x + dvec3(by * x.z, 0, 0); };
}

template <typename Body> double shear_stress_pa(Body& body) {
    return driven::force_where_n(body, on_top).x / (kSide_m * kSide_m);
}

} // namespace

TEST_CASE_TEMPLATE("a block sheared at once relaxes as the series over four decades of time", Body,
                   driven::Reference, driven::Quadratic) {
    for (const double poisson : {0.45, 0.49}) {
        const auto material = viscous(poisson);
        const double mu = lame(material).mu_pa, shear = 0.4;
        const auto mesh = cube();
        Body body(mesh, material, surface(mesh), 1e-6);
        for (int i = 1; i <= 4; ++i)
            REQUIRE(body.step(sheared(0.1 * i)));
        double t = 0.0;
        for (double dt = 5e-3; t < 100; dt *= 1.7) {
            body.set_dt(dt);
            REQUIRE(body.step(sheared(shear)));
            t += dt;
            // neo-Hooke in simple shear: sigma_xz = mu gamma, at any gamma
            const double expected = relaxed_share(material, t) * mu * shear;
            CHECK(shear_stress_pa(body) == doctest::Approx(expected).epsilon(1e-5).scale(0.0));
        }
    }
}

TEST_CASE_TEMPLATE("a driven block stores and loses as its series at 0.1, 1 and 10 Hz", Body,
                   driven::Reference, driven::Quadratic) {
    const auto material = viscous(0.45);
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh(dvec3(kSide_m), {1, 1, 1}));
    for (const double hz : {0.1, 1.0, 10.0}) {
        for (const int steps : {32, 64}) {
            Body body(mesh, material, surface(mesh), 1 / (hz * steps));
            // what is left of the start: 0.2 exp(-t/8 s) from 4 periods on, 0.004 at 1 Hz, 4e-4
            // at 10 Hz; over whole periods a constant averages out
            const int settle = hz < 1 ? 4 : hz < 5 ? 10 : 40;
            const double size = 1e-3;
            std::complex<double> modulus = 0.0;
            for (int i = 1; i <= (settle + 1) * steps; ++i) {
                const double angle = 2 * std::numbers::pi * i / steps;
                REQUIRE(body.step(sheared(size * std::sin(angle))));
                if (i > settle * steps) {
                    modulus += 2.0 / steps * shear_stress_pa(body) / size *
                               std::complex(std::sin(angle), std::cos(angle));
                }
            }
            const auto expected = shear_modulus_pa(material, 2 * std::numbers::pi * hz);
            CHECK(modulus.real() == doctest::Approx(expected.real()).epsilon(4e-3).scale(0.0));
            CHECK(modulus.imag() == doctest::Approx(expected.imag()).epsilon(1e-2).scale(0.0));
        }
    }
}

TEST_CASE("a bar pulled to and fro with free sides has Young's complex modulus") {
    // E = 9 K G/(3 K + G) with the complex G and the real K
    const auto material = viscous(0.4);
    const auto mesh = reference_bodies::irregular_box(dvec3(kSide_m), 1, 1);
    const auto held = reference_bodies::flags(mesh, [](const dvec3& x) {
        return (x.x < 1e-9 ? tissue::kHeldX : 0) | (x.y < 1e-9 ? tissue::kHeldY : 0) |
               (x.z < 1e-9 || on_top(x) ? tissue::kHeldZ : 0);
    });
    const double bulk = lame(material).lambda_pa + 2.0 / 3.0 * lame(material).mu_pa;
    const double hz = 1.0, size = 1e-4;
    constexpr int kSteps = 32, kSettle = 10;
    driven::Reference body(mesh, material, held, 1 / (hz * kSteps));
    std::complex<double> modulus = 0.0;
    for (int i = 1; i <= (kSettle + 1) * kSteps; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSteps;
        const double stretch = size * std::sin(angle);
        REQUIRE(body.step([&](const dvec3& x) { return x + dvec3(0, 0, stretch * x.z); }));
        if (i > kSettle * kSteps) {
            modulus += 2.0 / kSteps / (size * kSide_m * kSide_m) *
                       driven::force_where_n(body, on_top).z *
                       std::complex(std::sin(angle), std::cos(angle));
        }
    }
    const auto G = shear_modulus_pa(material, 2 * std::numbers::pi * hz);
    const auto expected = 9.0 * bulk * G / (3.0 * bulk + G);
    CHECK(modulus.real() == doctest::Approx(expected.real()).epsilon(4e-3).scale(0.0));
    CHECK(modulus.imag() == doctest::Approx(expected.imag()).epsilon(1e-2).scale(0.0));
}

TEST_CASE("steps of a viscous body are the reference's, damped, curved, at nu 0.45 and 0.49") {
    for (const double poisson : {0.45, 0.49}) {
        auto material = bodies::elastic(20e3, poisson);
        material.prony = {{0.5, 0.02}, {0.2, 0.5}};
        material.damping_mass_1ps = 1.5;
        material.damping_stiffness_s = 2e-3;
        const auto mesh = quadratic_bodies::curved_box(3);
        const auto held = quadratic_bodies::held_at_x0(mesh);
        const dvec3 gravity{0, -9.81, 0};
        const auto model = make_quadratic(mesh, material, held, gravity);
        const auto reference =
            make_reference(mesh, material, tissue::Law::neo_hooke, held, gravity);
        auto system = make_system(model, 0.01);
        auto exact = make_system(reference);
        auto state = rest_state(model);
        state.velocity_mps = quadratic_bodies::random_vectors(mesh.rest_m.size(), 0.1, 7);
        for (std::size_t i = 0; i < held.size(); ++i)
            state.velocity_mps[i] *= held[i] == 0;
        auto expected = rest_state(reference);
        expected.velocity_mps = state.velocity_mps;
        for (int i = 0; i < 15; ++i) {
            quadratic_bodies::step(model, quadratic_bodies::exact(), system, state);
            step(reference, {}, 0.01, tissue::TimeRule::implicit_euler, {}, exact, expected);
        }
        const double moved = greatest_distance_m(expected.position_m, mesh.rest_m);
        CHECK(moved > 4e-3);
        CHECK(greatest_distance_m(state.position_m, expected.position_m) < 1e-5 * moved);

        // and left alone it comes to what statics call the end
        auto still = rest_state(reference);
        CHECK(solve_static(reference, {}, {}, exact, still).converged);
        auto slow = make_system(model, 5.0);
        for (int i = 0; i < 20; ++i)
            quadratic_bodies::step(model, quadratic_bodies::exact(), slow, state);
        const double sag = greatest_distance_m(still.position_m, mesh.rest_m);
        CHECK(greatest_distance_m(state.position_m, still.position_m) < 1e-5 * sag);
    }
}

TEST_CASE("what is turned inside out comes back, with a memory that is finite and fades") {
    for (const double poisson : {0.45, 0.49}) {
        auto material = bodies::elastic(20e3, poisson);
        material.prony = {{0.5, 0.02}, {0.3, 0.2}};
        const auto mesh = quadratic_bodies::curved_box(3);
        const auto held = quadratic_bodies::held_at_x0(mesh);
        const auto model = make_quadratic(mesh, material, held);
        auto system = make_system(model, 0.01);
        auto state = rest_state(model);
        for (std::size_t i = 0; i < held.size(); ++i)
            state.position_m[i].x *= held[i] != 0 ? 1.0 : -1.0;
        CHECK(quadratic_bodies::step(model, {}, system, state).recovering);
        for (int i = 0; i < 400; ++i) {
            quadratic_bodies::step(model, {}, system, state);
            for (const auto& tensor : state.memory) {
                for (const auto& component : tensor.point[0]) {
                    for (const double x : component)
                        REQUIRE(std::abs(x) <= 76.0);
                }
            }
        }
        CHECK(greatest_distance_m(state.position_m, mesh.rest_m) < 1e-4);
        CHECK_FALSE(system.recovering);
    }
}

TEST_CASE("a cycle of shear loses pi G'' gamma^2 of energy, and energy is never gained") {
    const auto material = viscous(0.45);
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh(dvec3(kSide_m), {1, 1, 1}));
    const double hz = 1.0, size = 1e-2, volume = kSide_m * kSide_m * kSide_m;
    constexpr int kSteps = 128, kSettle = 8;
    driven::Reference body(mesh, material, surface(mesh), 1 / (hz * kSteps));
    double lost = 0.0, stress = 0.0, stored = 0.0, at = 0.0;
    for (int i = 1; i <= (kSettle + 1) * kSteps; ++i) {
        const double shear = size * std::sin(2 * std::numbers::pi * i / kSteps);
        REQUIRE(body.step(sheared(shear)));
        const double stress_now = shear_stress_pa(body);
        const double stored_now = stored_energy_j(body.model, body.state);
        const double gone =
            0.5 * (stress + stress_now) * (shear - at) * volume - (stored_now - stored);
        CHECK(gone > -1e-12 * stored_now);
        if (i > kSettle * kSteps)
            lost += gone;
        stress = stress_now;
        stored = stored_now;
        at = shear;
    }
    const double expected = std::numbers::pi * size * size * volume *
                            shear_modulus_pa(material, 2 * std::numbers::pi * hz).imag();
    CHECK(lost == doctest::Approx(expected).epsilon(1e-2).scale(0.0));
}
