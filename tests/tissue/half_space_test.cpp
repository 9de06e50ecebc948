// tests/tissue/half_space_test.cpp
// Punches pressed into a half-space and into a layer, against closed forms, and what a layer on a
// rigid base adds. The normal displacement under the tool is held where contact theory has contact.
#include "tests/tissue/cylinders.h"
#include "tests/tissue/driven_bodies.h"

#include <doctest/doctest.h>
#include <functional>

using cylinders::radius_m;
using glm::dvec3;
using tissue::kHeld;
using tissue::Law;

namespace {

constexpr double kContact_m = 2e-3, kYoung_pa = 10e3;

// A quarter of a disc of `depth`, top at z = 0, out to `reach`, finer towards the edge of contact.
// `fine`: of the contact radius.
tissue::QuadraticMesh quarter(double depth_m, double reach_m, double fine, double growth) {
    cylinders::Rings rings{.segments = 2};
    std::vector<double> inward{0.0}, down{0.0};
    cylinders::add_growing(inward, 0.98 * kContact_m, fine * kContact_m, growth);
    for (auto i = inward.rbegin(); i != inward.rend(); ++i)
        rings.radius_m.push_back(kContact_m - *i);
    cylinders::add_growing(rings.radius_m, reach_m, fine * kContact_m, growth);
    cylinders::add_growing(down, depth_m, fine * kContact_m, growth);
    for (auto i = down.rbegin(); i != down.rend(); ++i)
        rings.z_m.push_back(-*i);
    return cylinders::mesh(rings);
}

bool touched(const dvec3& x) {
    return x.z > -1e-9 && radius_m(x) < kContact_m + 1e-9;
}

// Force on all of a tool that pushes the contact down by `depth_m(r)`; `bonded` holds it sideways.
double push_n(const tissue::QuadraticMesh& mesh, double poisson,
              const std::function<double(double)>& depth_m, bool bonded = false) {
    double bottom = 0.0, wall = 0.0, axis = 1.0;
    for (const dvec3& x : mesh.rest_m) {
        bottom = std::min(bottom, x.z);
        wall = std::max(wall, radius_m(x));
        axis = std::min(axis, radius_m(x));
    }
    const auto held = reference_bodies::flags(mesh, [&](const dvec3& x) {
        if (x.z < bottom + 1e-9 || radius_m(x) > wall - 1e-9)
            return static_cast<int>(kHeld);
        const bool centre = radius_m(x) < axis + 1e-9;
        return (touched(x) ? tissue::kHeldZ : 0) | (touched(x) && bonded ? kHeld : 0) |
               (x.x < 1e-12 || centre ? tissue::kHeldX : 0) |
               (x.y < 1e-12 || centre ? tissue::kHeldY : 0);
    });
    const auto target = reference_bodies::places(mesh, [&](const dvec3& x) {
        return touched(x) ? x - dvec3(0, 0, depth_m(radius_m(x))) : x;
    });
    const auto s =
        reference_bodies::solve(mesh, bodies::elastic(kYoung_pa, poisson), Law::small_strain, held,
                                {{}, target}, {}, {.tolerance = 1e-6});
    CHECK(s.report.converged);
    std::vector<dvec3> force(mesh.rest_m.size());
    elastic_forces(s.model, s.state.position_m, force);
    double sum = 0.0;
    for (std::size_t i = 0; i < force.size(); ++i)
        sum -= touched(mesh.rest_m[i]) ? force[i].z : 0.0;
    return 4 * sum;
}

} // namespace

TEST_CASE("on a half-space a flat punch, a ball and a cone push as theory says") {
    // a boundary 400 radii away adds a share of 2 a/(pi R) = 0.2 %
    const auto mesh = quarter(400 * kContact_m, 400 * kContact_m, 0.005, 1.5);
    const double a = kContact_m, w = 1e-5;
    const auto flat = [&](double) { return w; };
    const auto close = [](double expected) {
        return doctest::Approx(expected).epsilon(1e-2).scale(0.0);
    };
    for (const double poisson : {0.3, 0.49}) {
        const double plane_pa = kYoung_pa / (1 - poisson * poisson);
        CHECK(push_n(mesh, poisson, flat) == close(2 * plane_pa * a * w));
        // Mossakovskii (1954), Spence (1968)
        const double shear_pa = kYoung_pa / (2 + 2 * poisson);
        CHECK(push_n(mesh, poisson, flat, true) ==
              close(4 * shear_pa * a * w * std::log(3 - 4 * poisson) / (1 - 2 * poisson)));
    }
    const double plane_pa = kYoung_pa / (1 - 0.45 * 0.45);
    // Hertz: d = a^2/R
    const double ball = 1.0;
    CHECK(push_n(mesh, 0.45, [&](double r) { return (a * a - 0.5 * r * r) / ball; }) ==
          close(4.0 / 3 * plane_pa * a * a * a / ball));
    // Sneddon (1965): d = pi/2 a cot(alpha)
    const double slope = 1e-2;
    CHECK(push_n(mesh, 0.45, [&](double r) { return slope * (std::numbers::pi / 2 * a - r); }) ==
          close(std::numbers::pi / 2 * plane_pa * slope * a * a));
}

TEST_CASE("a layer bonded to a rigid base resists a flat punch as Hayes and others found") {
    // kappa of P = 4 G a w kappa/(1 - nu) (Hayes et al. 1972), from their Fredholm equation anew
    struct Row {
        double poisson;
        std::array<double, 4> kappa; // a/h = 0.2, 0.6, 1, 2
    };
    constexpr std::array<double, 4> kRatio{0.2, 0.6, 1.0, 2.0};
    constexpr std::array<Row, 4> kRows{{{0.30, {1.207, 1.785, 2.484, 4.353}},
                                        {0.45, {1.252, 2.033, 3.091, 6.421}},
                                        {0.475, {1.265, 2.112, 3.313, 7.432}},
                                        {0.495, {1.277, 2.191, 3.549, 8.717}}}};
    for (std::size_t k = 0; k < kRatio.size(); ++k) {
        const double h = kContact_m / kRatio[k], w = 1e-5;
        const auto mesh = quarter(h, kContact_m + 8 * h, 0.005, 1.5);
        for (const Row& row : kRows) {
            const double shear_pa = kYoung_pa / (2 + 2 * row.poisson);
            const double found = push_n(mesh, row.poisson, [&](double) { return w; }) *
                                 (1 - row.poisson) / (4 * shear_pa * kContact_m * w);
            CAPTURE(kRatio[k]);
            CAPTURE(row.poisson);
            CHECK(found == doctest::Approx(row.kappa[k]).epsilon(1e-2).scale(0.0));
        }
    }
}
