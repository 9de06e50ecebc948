// tests/tissue/reference_beam_test.cpp
// Slender and thick beams at large rotation, twist, and a pressed block, against theory and
// published converged values.
#include "tests/tissue/reference_bodies.h"

#include <doctest/doctest.h>
#include <numbers>

using bodies::elastic;
using glm::dvec3;
using reference_bodies::flags;
using reference_bodies::places;
using tissue::kHeld;
using tissue::Law;

namespace {

struct Elastica {
    double deflection, shortening; // of the length
};

// theta'' = -alpha cos theta, theta(0) = 0, theta'(1) = 0: shooting for theta'(0), RK4.
Elastica elastica(double alpha) {
    constexpr int kSteps = 2000;
    struct Y {
        double theta, slope, x, y;
    };
    const auto rate = [&](const Y& v) {
        return Y{v.slope, -alpha * std::cos(v.theta), std::cos(v.theta), std::sin(v.theta)};
    };
    const auto along = [](const Y& a, double h, const Y& b) {
        return Y{a.theta + h * b.theta, a.slope + h * b.slope, a.x + h * b.x, a.y + h * b.y};
    };
    const auto shoot = [&](double slope) {
        Y v{0, slope, 0, 0};
        constexpr double h = 1.0 / kSteps;
        for (int i = 0; i < kSteps; ++i) {
            const Y a = rate(v), b = rate(along(v, h / 2, a)), c = rate(along(v, h / 2, b)),
                    d = rate(along(v, h, c));
            v = along(along(along(along(v, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
        }
        return v;
    };
    double low = 0, high = alpha; // alpha: the slope if the beam stayed straight
    for (int i = 0; i < 60; ++i)
        (shoot(0.5 * (low + high)).slope < 0 ? low : high) = 0.5 * (low + high);
    const Y end = shoot(low);
    return {end.y, 1 - end.x};
}

// J = a^4 [1/3 - 64/pi^5 sum_odd tanh(n pi/2)/n^5] of a square (Timoshenko & Goodier)
double square_torsion_m4(double side_m) {
    double sum = 0.0;
    for (int n = 1; n < 40; n += 2)
        sum += std::tanh(n * std::numbers::pi / 2) / std::pow(n, 5);
    return std::pow(side_m, 4) * (1.0 / 3 - 64 / std::pow(std::numbers::pi, 5) * sum);
}

// The peers' beam: 0.2 x 0.04 x 0.04 m, clamped at x = 0, rho 1000, its weight in -y.
reference_bodies::Solved heavy_beam(const std::array<int, 3>& cells, double young_pa,
                                    double poisson) {
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh({0.2, 0.04, 0.04}, cells));
    return reference_bodies::solve(mesh, elastic(young_pa, poisson), Law::neo_hooke,
                                   flags(mesh, [](auto x) { return x.x < 1e-9 ? kHeld : 0; }), {},
                                   {0, -9.81, 0});
}

// Displacement of the centre of the end face, which is a node if it is halved in half cells.
dvec3 tip_m(const reference_bodies::Solved& s) {
    for (std::size_t i = 0; i < s.model.mesh.rest_m.size(); ++i) {
        if (glm::length(s.model.mesh.rest_m[i] - dvec3(0.2, 0.02, 0.02)) < 1e-9)
            return s.state.position_m[i] - s.model.mesh.rest_m[i];
    }
    FAIL("no node at the tip");
    return {};
}

// Small-deflection cantilever 100 x 20 x 20 mm, E 10 kPa, nu, 10 mN of uniform shear on the end:
// mean deflection of the end face, mm.
double cantilever_mm(const std::array<int, 3>& cells, double poisson) {
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh({0.1, 0.02, 0.02}, cells));
    const auto end = reference_bodies::face_areas_m2(mesh, [](auto x) { return x.x > 0.1 - 1e-9; });
    std::vector<dvec3> force;
    for (const double area : end)
        force.push_back({0, 0, 10e-3 * area / (0.02 * 0.02)});
    const auto s = reference_bodies::solve(
        mesh, elastic(10e3, poisson), Law::small_strain,
        flags(mesh, [](auto x) { return x.x < 1e-9 ? kHeld : 0; }), {force, {}});
    CHECK(s.report.converged);
    return reference_bodies::mean_displacement_m(mesh, s.state.position_m, end).z * 1e3;
}

// Cook's membrane, corners (0,0) (48,44) (48,60) (0,44), thickness 10, E = 1, x = 0 clamped, total
// shear 10 on x = 48: deflection of the middle of the loaded edge.
double cook(const std::array<int, 3>& cells, double poisson) {
    auto corners = tissue::box_mesh({48, 1, 10}, cells);
    for (dvec3& x : corners.rest_m) {
        const double low = 44 * x.x / 48, high = 44 + 16 * x.x / 48;
        x.y = low + x.y * (high - low);
    }
    const auto mesh = tissue::quadratic_mesh(corners);
    const auto end = reference_bodies::face_areas_m2(mesh, [](auto x) { return x.x > 48 - 1e-6; });
    std::vector<dvec3> force;
    for (const double area : end)
        force.push_back({0, 10 * area / (16 * 10), 0});
    const auto s = reference_bodies::solve(
        mesh, elastic(1, poisson), Law::small_strain,
        flags(mesh, [](auto x) { return x.x < 1e-6 ? kHeld : 0; }), {force, {}});
    CHECK(s.report.converged);
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
        if (glm::length(mesh.rest_m[i] - dvec3(48, 52, 5)) < 1e-6)
            return s.state.position_m[i].y - 52;
    }
    return 0.0;
}

} // namespace

TEST_CASE("a clamped cantilever bends as other quadratic tetrahedra do, and as Timoshenko's") {
    // what an independent solver found for P2 on 10x2x2 cells, to 4 digits
    CHECK(cantilever_mm({10, 2, 2}, 0.30) == doctest::Approx(25.21).epsilon(1e-3));
    CHECK(cantilever_mm({10, 2, 2}, 0.45) == doctest::Approx(24.30).epsilon(1e-3));
    CHECK(cantilever_mm({10, 2, 2}, 0.49) == doctest::Approx(23.59).epsilon(1e-3));
    CHECK(cantilever_mm({10, 2, 2}, 0.499) == doctest::Approx(23.18).epsilon(1e-3));
    // P L^3/(3 E I) + P L/(kappa G A) with kappa = 10/12 (Cowper, nu = 0): 25.000 + 0.600
    CHECK(cantilever_mm({10, 2, 2}, 0.0) == doctest::Approx(25.600).epsilon(5e-3));
}

TEST_CASE("Cook's membrane leans as other quadratic tetrahedra let it, near nu = 0.5 too") {
    // what an independent solver found for P2 on 8x8x2 cells; converged: 23.79, 23.79, 23.83, 24.0
    CHECK(cook({8, 8, 2}, 1.0 / 3) == doctest::Approx(23.66).epsilon(2e-3));
    CHECK(cook({8, 8, 2}, 0.45) == doctest::Approx(23.46).epsilon(2e-3));
    CHECK(cook({8, 8, 2}, 0.49) == doctest::Approx(23.12).epsilon(2e-3));
    CHECK(cook({8, 8, 2}, 0.499) == doctest::Approx(22.60).epsilon(2e-3));
}

TEST_CASE("the elastica by shooting is the published one") {
    // Mattiasson (1981), by elliptic integrals
    CHECK(elastica(1).deflection == doctest::Approx(0.30172).epsilon(1e-5));
    CHECK(elastica(1).shortening == doctest::Approx(0.05643).epsilon(1e-4));
    CHECK(elastica(10).deflection == doctest::Approx(0.81061).epsilon(1e-5));
    CHECK(elastica(10).shortening == doctest::Approx(0.55500).epsilon(1e-5));
}

TEST_CASE("a slender beam follows the elastica from small to large bending") {
    const double length = 0.2, side = 0.01, young = 100e3;
    const double bending_nm2 = young * std::pow(side, 4) / 12;
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh({length, side, side}, {40, 2, 1}));
    const auto held = flags(mesh, [](auto x) { return x.x < 1e-9 ? kHeld : 0; });
    const auto end =
        reference_bodies::face_areas_m2(mesh, [&](auto x) { return x.x > length - 1e-9; });
    for (const double alpha : {0.25, 1.0, 3.0, 10.0}) {
        const double pull_pa = alpha * bending_nm2 / (length * length) / (side * side);
        std::vector<dvec3> force;
        for (const double area : end)
            force.push_back({0, pull_pa * area, 0});
        const auto s =
            reference_bodies::solve(mesh, elastic(young, 0.0), Law::neo_hooke, held, {force, {}});
        CHECK(s.report.converged);
        const dvec3 tip =
            reference_bodies::mean_displacement_m(mesh, s.state.position_m, end) / length;
        const Elastica theory = elastica(alpha);
        // shear adds 0.15 % (Timoshenko, E/G = 2), strains of 11 % their nonlinearity
        CHECK(tip.y == doctest::Approx(theory.deflection).epsilon(0.01));
        CHECK(-tip.x == doctest::Approx(theory.shortening).epsilon(0.01));
    }
}

TEST_CASE("a twisted square bar answers with Saint-Venant's torque, warping free") {
    const double side = 0.02, length = 0.04, twist_rad = 1e-3, young = 10e3, poisson = 0.45;
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh({side, side, length}, {6, 6, 4}));
    const dvec3 middle{side / 2, side / 2, 0};
    const auto held = flags(mesh, [&](const dvec3& x) {
        const bool end = x.z < 1e-9 || x.z > length - 1e-9;
        return (end ? tissue::kHeldX | tissue::kHeldY : 0) |
               (glm::length(x - middle) < 1e-9 ? tissue::kHeldZ : 0);
    });
    const auto turned = places(mesh, [&](const dvec3& x) {
        const dvec3 arm = x - middle;
        return dvec3(0, 0, x.z) + dvec3(side / 2, side / 2, 0) +
               bodies::rotation({0, 0, 1}, twist_rad * x.z / length) * dvec3(arm.x, arm.y, 0);
    });
    for (const Law law : {Law::neo_hooke, Law::small_strain}) {
        // rounding is 1e-10 here: the strain is 5e-4, its forces a difference of moduli
        const auto s = reference_bodies::solve(mesh, elastic(young, poisson), law, held,
                                               {{}, turned}, {}, {.tolerance = 1e-9});
        CHECK(s.report.converged);
        std::vector<dvec3> force(mesh.rest_m.size());
        elastic_forces(s.model, s.state.position_m, force);
        double torque_nm = 0.0;
        for (std::size_t i = 0; i < force.size(); ++i) {
            if (mesh.rest_m[i].z > length - 1e-9)
                torque_nm += glm::cross(s.state.position_m[i] - middle, force[i]).z;
        }
        const double shear_pa = young / (2 * (1 + poisson));
        const double theory_nm = shear_pa * square_torsion_m4(side) * twist_rad / length;
        CHECK(torque_nm == doctest::Approx(theory_nm).epsilon(2e-3));
    }
}

TEST_CASE("a heavy beam of 240 quadratic tetrahedra is 2.5 % off the converged one") {
    // converged tips and the error of 10x2x2 cells by CalculiX 2.20 and an independent solver
    struct Case {
        double young_pa, poisson;
        dvec3 tip_m;
    };
    const Case cases[]{{100e3, 0.45, {-38.2e-3, -113.8e-3, 0}},
                       {30e3, 0.45, {-115.6e-3, -180.7e-3, 0}},
                       {100e3, 0.30, {-39.4e-3, -115.3e-3, 0}},
                       {30e3, 0.30, {-117.5e-3, -181.5e-3, 0}}};
    for (const Case& c : cases) {
        const auto coarse = heavy_beam({10, 2, 2}, c.young_pa, c.poisson);
        CHECK(coarse.report.converged);
        CHECK(coarse.report.relative_residual < 1e-8);
        const double size = glm::length(c.tip_m);
        const double off = glm::length(tip_m(coarse) - c.tip_m) / size;
        CHECK(off < 0.026);
        if (c.young_pa == 100e3 && c.poisson == 0.45)
            CHECK(std::abs(off - 0.025) < 0.001);
        if ((c.young_pa == 100e3) != (c.poisson == 0.45))
            continue; // two of the four are enough for the rest
        // the clamped edge is singular: order 1.8 (Richardson, the same source)
        const auto fine = heavy_beam({20, 4, 4}, c.young_pa, c.poisson);
        CHECK(fine.report.converged);
        const dvec3 limit = tip_m(fine) + (tip_m(fine) - tip_m(coarse)) / (std::pow(2.0, 1.8) - 1);
        CHECK(glm::length(limit - c.tip_m) < 0.002 * size);
    }
}

TEST_CASE("a beam fifty times softer still finds its rest from the straight state") {
    const auto s = heavy_beam({10, 2, 2}, 2e3, 0.45);
    CHECK(s.report.converged);
    CHECK(tip_m(s).y < -0.19);
}

TEST_CASE(
    "a block pressed to two thirds of its height converges, and its energy is the work done") {
    const dvec3 size{0.03, 0.03, 0.03};
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh(size, {4, 4, 4}));
    const auto pressed = [&](const dvec3& x) {
        return x.z > size.z - 1e-9 &&
               std::max(std::abs(x.x - 0.015), std::abs(x.y - 0.015)) < 0.008;
    };
    const auto held =
        flags(mesh, [&](const dvec3& x) { return x.z < 1e-9 || pressed(x) ? kHeld : 0; });
    const auto model = make_reference(mesh, elastic(10e3, 0.45), Law::neo_hooke, held);
    tissue::ReferenceSystem system = make_system(model);
    tissue::ReferenceState state = rest_state(model);
    std::vector<dvec3> force(mesh.rest_m.size());
    // Simpson's rule over the depths, pressing on from each equilibrium
    constexpr int kDepths = 8;
    const double depth_m = size.z / 3;
    double work_j = 0.0;
    tissue::NewtonReport report;
    for (int i = 1; i <= kDepths; ++i) {
        const double down = depth_m * i / kDepths;
        const auto target =
            places(mesh, [&](const dvec3& x) { return x - dvec3(0, 0, pressed(x) ? down : 0); });
        report = solve_static(model, {{}, target}, {}, system, state);
        REQUIRE(report.converged);
        elastic_forces(model, state.position_m, force);
        double push_n = 0.0;
        for (std::size_t k = 0; k < force.size(); ++k)
            push_n -= pressed(mesh.rest_m[k]) ? force[k].z : 0.0;
        const double weight = i == kDepths ? 1 : i % 2 == 1 ? 4 : 2;
        work_j += weight * push_n * depth_m / (3 * kDepths);
    }
    CHECK(report.energy_j == doctest::Approx(work_j).epsilon(1e-4));

    // and all at once
    const auto target =
        places(mesh, [&](const dvec3& x) { return x - dvec3(0, 0, pressed(x) ? depth_m : 0); });
    tissue::ReferenceState at_once = rest_state(model);
    const auto whole = solve_static(model, {{}, target}, {}, system, at_once);
    CHECK(whole.converged);
    for (std::size_t i = 0; i < at_once.position_m.size(); ++i)
        CHECK(glm::length(at_once.position_m[i] - state.position_m[i]) < 1e-7 * size.z);
}
