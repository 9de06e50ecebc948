// tests/tissue/reference_bed_test.cpp
// A reference body that lies in a bed: the closed form of a bar, and slopes of its energy.
#include "tests/tissue/reference_bodies.h"

#include <cmath>
#include <doctest/doctest.h>

namespace {

using glm::dvec3;
using namespace reference_bodies;

} // namespace

TEST_CASE("reference bed: a bar lying in it gives way at its end as coth says") {
    // E A u'' = (E/L^2) A u, E A u'(l) = P, u'(0) = 0:  u(l) = P L / (E A) coth(l / L)
    const double young_pa = 8e3, load_n = 1e-3, length = 0.02, bar_m = 0.06, area_m2 = 4e-4;
    const auto corners = tissue::box_mesh({bar_m, 0.02, 0.02}, {6, 1, 1});
    const auto mesh = tissue::quadratic_mesh(corners);
    const auto bed = tissue::make_bed(
        corners, [](const dvec3&) { return true; }, length);
    const auto model = tissue::make_reference(mesh, bodies::elastic(young_pa, 0.0),
                                              tissue::Law::small_strain, {}, dvec3{0.0}, bed);
    const auto share = face_areas_m2(mesh, [&](auto x) { return x.x > bar_m - 1e-9; });
    std::vector<dvec3> load;
    for (const double a : share)
        load.push_back({load_n * a / area_m2, 0, 0});
    auto system = make_system(model);
    auto state = rest_state(model);
    const auto report = solve_static(model, {load, {}}, {}, system, state);
    REQUIRE(report.converged);
    const double truth = load_n * length / (young_pa * area_m2) / std::tanh(bar_m / length);
    CHECK(mean_displacement_m(mesh, state.position_m, share).x ==
          doctest::Approx(truth).epsilon(2e-3).scale(0.0));
}

TEST_CASE("reference bed: under its weight a body in a bed sinks by rho g L^2 / E everywhere") {
    const double young_pa = 8e3, length = 0.004, rho = 1000.0;
    const auto corners = tissue::box_mesh({0.03, 0.02, 0.02}, {2, 2, 2}, 0.2);
    const auto bed = tissue::make_bed(
        corners, [](const dvec3&) { return true; }, length);
    const auto mesh = tissue::quadratic_mesh(corners);
    const auto model = tissue::make_reference(mesh, bodies::elastic(young_pa, 0.45, rho),
                                              tissue::Law::neo_hooke, {}, {0, 0, -9.81}, bed);
    auto system = make_system(model);
    auto state = rest_state(model);
    REQUIRE(solve_static(model, {}, {}, system, state).converged);
    // the mean: four points a tet integrate a linear field's energy, not a quadratic one's, so the
    // surface ripples by some percent
    const auto share = face_areas_m2(mesh, [](auto) { return true; });
    CHECK(mean_displacement_m(mesh, state.position_m, share).z ==
          doctest::Approx(-rho * 9.81 * length * length / young_pa).epsilon(0.05).scale(0.0));
}

TEST_CASE(
    "reference bed: its force is the slope of its energy, and the tangent that of its force") {
    const auto corners = tissue::box_mesh({0.04, 0.03, 0.03}, {2, 2, 2}, 0.1);
    const auto bed = tissue::make_bed(
        corners, [](auto x) { return x.x + x.y < 0.031; }, 0.004);
    const auto model =
        tissue::make_reference(tissue::quadratic_mesh(corners), bodies::elastic(8e3, 0.4),
                               tissue::Law::neo_hooke, {}, dvec3{0.0}, bed);
    const auto at = [&](double size, double along) {
        auto state = rest_state(model);
        for (std::size_t i = 0; i < state.position_m.size(); ++i) {
            const double s = static_cast<double>(i);
            state.position_m[i] += size * dvec3{std::sin(3 * s), std::sin(5 * s), std::sin(7 * s)} +
                                   along * dvec3{std::cos(s), std::cos(2 * s), std::sin(11 * s)};
        }
        return state;
    };
    const double h = 1e-7, size = 3e-4;
    auto system = make_system(model);
    linearize(model, at(size, 0.0), system);
    std::vector<double> d(model.unknown.size()), product(d.size());
    const auto up = at(size, h), down = at(size, -h);
    double slope_n = 0.0;
    for (std::size_t i = 0; i < d.size(); ++i) {
        const int k = static_cast<int>(i % 3);
        d[i] = (up.position_m[i / 3][k] - down.position_m[i / 3][k]) / (2 * h);
        slope_n += system.internal_n[i] * d[i];
    }
    CHECK((elastic_energy_j(model, up.position_m) - elastic_energy_j(model, down.position_m)) /
              (2 * h) ==
          doctest::Approx(slope_n).epsilon(1e-6).scale(0.0));
    tissue::multiply(model.all, system.stiffness, d, product);
    std::vector<dvec3> plus(d.size() / 3), minus(plus.size());
    elastic_forces(model, up.position_m, plus);
    elastic_forces(model, down.position_m, minus);
    double error = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < d.size(); ++i) {
        const int k = static_cast<int>(i % 3);
        const double e = (plus[i / 3][k] - minus[i / 3][k]) / (2 * h) - product[i];
        error += e * e;
        whole += product[i] * product[i];
    }
    CHECK(std::sqrt(error / whole) < 1e-5);
}

TEST_CASE("reference bed: a sample of a tet that the mesh lacks is refused") {
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh(dvec3{0.01}, {1, 1, 1}));
    CHECK_THROWS_WITH(
        tissue::make_reference(mesh, bodies::elastic(8e3, 0.4), tissue::Law::neo_hooke, {},
                               dvec3{0.0}, std::vector<tissue::BedSample>{{6, {1, 0, 0, 0}, 1.0}}),
        doctest::Contains("tet 6 of 6"));
}
