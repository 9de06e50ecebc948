// tests/tissue/reference_beam_test.cpp
// Slender and thick beams, small and large bending, against theory, an independent solver and
// converged values.
#include "tests/tissue/reference_bodies.h"

#include <doctest/doctest.h>

using bodies::elastic;
using glm::dvec3;
using reference_bodies::flags;
using reference_bodies::heavy_beam;
using reference_bodies::tip_m;
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

} // namespace

TEST_CASE("a clamped cantilever bends as other quadratic tetrahedra do, and as Timoshenko's") {
    // what an independent solver found for P2 on 10x2x2 cells, to 4 digits
    CHECK(cantilever_mm({10, 2, 2}, 0.30) == doctest::Approx(25.21).scale(0.0).epsilon(1e-3));
    CHECK(cantilever_mm({10, 2, 2}, 0.45) == doctest::Approx(24.30).scale(0.0).epsilon(1e-3));
    CHECK(cantilever_mm({10, 2, 2}, 0.49) == doctest::Approx(23.59).scale(0.0).epsilon(1e-3));
    CHECK(cantilever_mm({10, 2, 2}, 0.499) == doctest::Approx(23.18).scale(0.0).epsilon(1e-3));
    // P L^3/(3 E I) + P L/(kappa G A) with kappa = 10/12 (Cowper, nu = 0): 25.000 + 0.600
    CHECK(cantilever_mm({10, 2, 2}, 0.0) == doctest::Approx(25.600).scale(0.0).epsilon(5e-3));
}

TEST_CASE("the elastica by shooting is the published one") {
    // Mattiasson (1981), by elliptic integrals
    CHECK(elastica(1).deflection == doctest::Approx(0.30172).scale(0.0).epsilon(1e-5));
    CHECK(elastica(1).shortening == doctest::Approx(0.05643).scale(0.0).epsilon(1e-4));
    CHECK(elastica(10).deflection == doctest::Approx(0.81061).scale(0.0).epsilon(1e-5));
    CHECK(elastica(10).shortening == doctest::Approx(0.55500).scale(0.0).epsilon(1e-5));
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
        CHECK(tip.y == doctest::Approx(theory.deflection).scale(0.0).epsilon(0.01));
        CHECK(-tip.x == doctest::Approx(theory.shortening).scale(0.0).epsilon(0.01));
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
    CHECK(s.report.parts == 1);
    CHECK(s.report.projected > 0); // on the way the tangent is indefinite
    CHECK(tip_m(s).y < -0.19);
}
