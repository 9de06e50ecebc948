// tests/tissue/indenter_test.cpp
// The reference indenter against Hertz, the bonded layer of Hayes, and its own derivatives. A
// quarter of a body with two planes of symmetry is solved.
#include "tests/tissue/reference_bodies.h"
#include "tissue/mesh/refine.h"
#include "tissue/reference/indenter.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>

namespace {

using glm::dvec3;
using namespace reference_bodies;

constexpr double kRadius_m = 1.5e-3;

// A box with symmetry at x = 0 and y = 0, bottom fixed, far sides on rollers, fine around the
// middle of its top.
struct Quarter {
    tissue::ReferenceModel model;
    tissue::ReferenceSystem system;
    tissue::ReferenceState state;
    dvec3 place_m;

    Quarter(const dvec3& size_m, const std::array<int, 3>& cells, const tissue::RefineSize& fine,
            double young_pa, double poisson, tissue::Law law)
        : model(make(size_m, cells, fine, bodies::elastic(young_pa, poisson), law)),
          system(make_system(model)), state(rest_state(model)), place_m{0, 0, size_m.z} {}

    static tissue::ReferenceModel make(const dvec3& size_m, const std::array<int, 3>& cells,
                                       const tissue::RefineSize& fine,
                                       const tissue::Material& material, tissue::Law law) {
        const auto box = tissue::box_mesh(size_m, cells);
        const auto mesh =
            tissue::quadratic_mesh(tissue::refined(box, {}, {}, {0, 0, size_m.z}, fine).mesh);
        const auto held = flags(mesh, [&](const dvec3& x) {
            int flag = x.z < 1e-9 ? tissue::kHeld : 0;
            flag |= x.x < 1e-9 || x.x > size_m.x - 1e-9 ? tissue::kHeldX : 0;
            return flag | (x.y < 1e-9 || x.y > size_m.y - 1e-9 ? tissue::kHeldY : 0);
        });
        return tissue::make_reference(mesh, material, law, held);
    }

    tissue::PressReport press(tissue::Press p) {
        p.place_m = place_m;
        state = rest_state(model);
        return tissue::press(model, p, system, state);
    }
};

// Hertz: P = 4/3 E/(1-nu^2) sqrt(R) d^1.5
double hertz_n(double young_pa, double poisson, double radius_m, double depth_m) {
    return 4.0 / 3.0 * young_pa / (1 - poisson * poisson) * std::sqrt(radius_m) *
           std::pow(depth_m, 1.5);
}

} // namespace

TEST_CASE("indenter: shallow, a sphere on a half-space feels Hertz within 3 %") {
    // 14 tip radii each way, edges a sixth of the contact radius
    // lateral motion, which Hertz leaves out, shrinks with 1 - 2 nu
    for (const double poisson : {0.45, 0.49}) {
        CAPTURE(poisson);
        Quarter q(dvec3(14 * kRadius_m), {4, 4, 4},
                  {.edge_m = 0.15 * kRadius_m, .core_m = 0.3 * kRadius_m, .growth = 0.8}, 6e3,
                  poisson, tissue::Law::small_strain);
        const auto report = q.press({.radius_m = kRadius_m,
                                     .depth_m = {0.02 * kRadius_m, 0.05 * kRadius_m},
                                     .step_m = 0.02 * kRadius_m,
                                     .penalty = 300.0});
        REQUIRE(report.point.size() == 2);
        const auto& p = report.point.back();
        CHECK(4 * p.force_n.z ==
              doctest::Approx(hertz_n(6e3, poisson, kRadius_m, p.depth_m)).epsilon(0.03).scale(0));
        // a quarter of the disc
        CHECK(2 * p.radius_m ==
              doctest::Approx(std::sqrt(kRadius_m * p.depth_m)).epsilon(0.08).scale(0));
        CHECK(p.penetration_m < 0.05 * p.depth_m);
    }
}

TEST_CASE("indenter: a sphere on a bonded layer feels the table of Hayes within 3 %") {
    // nu 0.45, a/T = 0.6: chi 0.685, kappa_s 1.619; R = 8 T, so that it is a paraboloid
    const double thickness_m = 2e-3, radius_m = 8 * thickness_m, young_pa = 6e3, poisson = 0.45;
    const double contact_m = 0.6 * thickness_m;
    const double depth_m = 0.685 * contact_m * contact_m / radius_m;
    const double shear_pa = young_pa / (2 * (1 + poisson));
    Quarter q({5 * thickness_m, 5 * thickness_m, thickness_m}, {5, 5, 1},
              {.edge_m = 0.35 * contact_m, .core_m = 1.1 * contact_m}, young_pa, poisson,
              tissue::Law::small_strain);
    const auto report = q.press(
        {.radius_m = radius_m, .depth_m = {depth_m}, .step_m = 0.5 * depth_m, .penalty = 3000.0});
    REQUIRE(report.point.size() == 1);
    const double truth_n = 8.0 / 3.0 * shear_pa * contact_m * depth_m * 1.619 / (1 - poisson);
    CHECK(4 * report.point[0].force_n.z == doctest::Approx(truth_n).epsilon(0.03).scale(0));
    // and nobody could take it for a half-space
    CHECK(truth_n > 1.5 * hertz_n(young_pa, poisson, radius_m, depth_m));
}

TEST_CASE("indenter: force is the slope of the work done, with and without friction") {
    // P = d(elastic energy)/d(depth) without friction; stuck skin stores what is done on it too
    Quarter q(dvec3(10 * kRadius_m), {2, 2, 2},
              {.edge_m = 0.8 * kRadius_m, .core_m = 0.8 * kRadius_m, .growth = 1.0}, 6e3, 0.45,
              tissue::Law::neo_hooke);
    for (const double friction : {0.0, std::numeric_limits<double>::infinity()}) {
        CAPTURE(friction);
        double energy_j[2] = {};
        double force_n = 0.0;
        const double h = 0.04;
        for (const int side : {0, 1}) {
            // stuck places are fixed at the end of a step: both ways take the same steps
            tissue::Press p{.radius_m = kRadius_m,
                            .depth_m = {0.25 * kRadius_m, 0.5 * kRadius_m, 0.75 * kRadius_m,
                                        (1.0 + (side ? h : -h)) * kRadius_m},
                            .friction = friction,
                            .penalty = 1000.0};
            const auto report = q.press(p);
            REQUIRE(report.point.size() == 4);
            energy_j[side] = 4 * elastic_energy_j(q.model, q.state.position_m);
            force_n += 0.5 * 4 * report.point.back().force_n.z;
        }
        CHECK(force_n == doctest::Approx((energy_j[1] - energy_j[0]) / (2 * h * kRadius_m))
                             .epsilon(0.02)
                             .scale(0));
    }
}

TEST_CASE("indenter: halving steps and stiffening the penalty move the force by less than 2 %") {
    Quarter q(dvec3(10 * kRadius_m), {2, 2, 2},
              {.edge_m = 0.8 * kRadius_m, .core_m = 0.8 * kRadius_m, .growth = 1.0}, 6e3, 0.45,
              tissue::Law::neo_hooke);
    tissue::Press p{.radius_m = kRadius_m, .depth_m = {kRadius_m}, .friction = 0.1};
    const double whole_n = q.press(p).point.at(0).force_n.z;
    p.step_m = 0.125 * kRadius_m;
    p.penalty = 400.0;
    const double fine_n = q.press(p).point.at(0).force_n.z;
    // friction, one step late, is worth 3 % of the force here in all
    CHECK(whole_n == doctest::Approx(fine_n).epsilon(0.02).scale(0));
}

TEST_CASE("indenter: old factors under conjugate gradients lead to the same equilibria") {
    Quarter q(dvec3(10 * kRadius_m), {2, 2, 2},
              {.edge_m = 0.8 * kRadius_m, .core_m = 0.8 * kRadius_m, .growth = 1.0}, 6e3, 0.45,
              tissue::Law::neo_hooke);
    tissue::Press p{.radius_m = kRadius_m,
                    .depth_m = {0.5 * kRadius_m, kRadius_m, 2.0 * kRadius_m},
                    .friction = std::numeric_limits<double>::infinity()};
    const auto own = q.press(p);
    REQUIRE(own.point.size() == 3);
    CHECK(own.factors == own.iterations);
    // 30 mostly suffice; one never does, and every tangent is factored after all
    for (const int products : {30, 1}) {
        CAPTURE(products);
        p.newton.products = products;
        const auto old = q.press(p);
        REQUIRE(old.point.size() == 3);
        CAPTURE(old.factors);
        CAPTURE(old.iterations);
        // one product is rarely enough
        CHECK((products == 1 ? 4 * old.factors > 3 * old.iterations
                             : 2 * old.factors < old.iterations));
        CHECK(old.iterations < 1.2 * own.iterations);
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(glm::length(old.point[i].force_n - own.point[i].force_n) <
                  1e-5 * glm::length(own.point[i].force_n));
    }
}

TEST_CASE("indenter: a tip that sticks does so from its first touch, however far its depths") {
    // a strip, soft upwards and stiff sideways, pressed askew near its free end: a first step that
    // slides would find no force sideways
    const dvec3 size_m{40e-3, 8e-3, 3e-3}, place_m{36e-3, 4e-3, 3e-3};
    const auto mesh = tissue::quadratic_mesh(
        tissue::refined(tissue::box_mesh(size_m, {10, 2, 1}), {}, {}, place_m,
                        {.edge_m = 0.7 * kRadius_m, .core_m = 0.7 * kRadius_m, .growth = 2.0})
            .mesh);
    const auto held =
        flags(mesh, [](const dvec3& x) { return x.x < 1e-9 ? int{tissue::kHeld} : 0; });
    const auto model =
        tissue::make_reference(mesh, bodies::elastic(6e3, 0.45), tissue::Law::neo_hooke, held);
    const auto pressed = [&](double step_share) {
        auto system = tissue::make_system(model);
        auto state = tissue::rest_state(model);
        tissue::Press p{.place_m = place_m,
                        .into = {0.0, -std::sin(0.5), -std::cos(0.5)},
                        .radius_m = kRadius_m,
                        .depth_m = {0.4 * kRadius_m},
                        .friction = std::numeric_limits<double>::infinity(),
                        .step_m = step_share * kRadius_m};
        p.place_m += tissue::touch_depth_m(mesh, p) * p.into;
        const auto report = tissue::press(model, p, system, state);
        REQUIRE(report.point.size() == 1);
        return report.point[0].force_n;
    };
    const dvec3 coarse = pressed(0.4), fine = pressed(0.04);
    CAPTURE(coarse.y);
    CAPTURE(coarse.z);
    CAPTURE(fine.y);
    CAPTURE(fine.z);
    CHECK(std::abs(fine.y) > 0.7 * std::abs(fine.z));
    CHECK(glm::length(coarse - fine) < 0.1 * glm::length(fine)); // in one step 0.9 of it
}

TEST_CASE("indenter: contact's slope and tangent are those of its energy") {
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh(dvec3{4e-3}, {2, 2, 2}, 0.1));
    const auto model =
        tissue::make_reference(mesh, bodies::elastic(6e3, 0.45), tissue::Law::neo_hooke, {});
    // the tip is in the top, beside its middle; some points are bound, of which some slip
    tissue::TipContact contact{tissue::contact_points(mesh, {2e-3, 2e-3, 4e-3}, 3e-3),
                               {{1.7e-3, 2.2e-3, 4.6e-3}, {0, 0, 1}, 1.5e-3},
                               5e6};
    REQUIRE(contact.points.size() >= 48);
    const auto at = [&](double along) {
        std::vector<dvec3> u;
        for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
            const double s = static_cast<double>(i);
            u.push_back(2e-5 * dvec3{std::sin(3 * s), std::sin(5 * s), std::sin(7 * s)} +
                        along * dvec3{std::cos(s), std::cos(2 * s), std::sin(11 * s)});
        }
        return u;
    };
    tissue::learn_contact(model, std::vector<dvec3>(mesh.rest_m.size(), dvec3{0.0}), 0.05, contact);
    for (std::size_t i = 0; i < contact.points.size(); i += 3)
        contact.points[i].limit_pa *= 100;
    const double h = 1e-10;
    std::vector<double> slope(model.unknown.size()), up(slope.size()), down(slope.size());
    std::vector<double> stiffness(model.all.row.size()), scratch(stiffness.size()), d,
        product(slope.size());
    tissue::linearize_contact(model, contact, at(0), false, slope, stiffness);
    tissue::linearize_contact(model, contact, at(h), false, up, scratch);
    tissue::linearize_contact(model, contact, at(-h), false, down, scratch);
    double promised = 0.0, error = 0.0, whole = 0.0;
    const auto plus = at(h), minus = at(-h);
    for (std::size_t i = 0; i < slope.size(); ++i) {
        const int k = static_cast<int>(i % 3);
        d.push_back((plus[i / 3][k] - minus[i / 3][k]) / (2 * h));
        promised += slope[i] * d[i];
    }
    REQUIRE(std::abs(promised) > 0.0);
    CHECK((contact_energy_j(model, contact, plus) - contact_energy_j(model, contact, minus)) /
              (2 * h) ==
          doctest::Approx(promised).epsilon(1e-5).scale(0));
    tissue::multiply(model.all, stiffness, d, product);
    for (std::size_t i = 0; i < slope.size(); ++i) {
        const double e = (up[i] - down[i]) / (2 * h) - product[i];
        error += e * e;
        whole += product[i] * product[i];
    }
    CHECK(std::sqrt(error / whole) < 1e-4);
}

TEST_CASE("indenter: what cannot be pressed is refused with the value") {
    Quarter q(dvec3(12 * kRadius_m), {2, 2, 2}, {.edge_m = 6 * kRadius_m}, 6e3, 0.45,
              tissue::Law::neo_hooke);
    CHECK_THROWS_WITH(q.press({.radius_m = 0.0, .depth_m = {1e-3}}),
                      doctest::Contains("radius_m = 0"));
    CHECK_THROWS_WITH(q.press({.radius_m = kRadius_m, .depth_m = {1e-3, 1e-3}}),
                      doctest::Contains("must ascend"));
    CHECK_THROWS_WITH(q.press({.radius_m = kRadius_m, .depth_m = {1e-3}, .friction = -1.0}),
                      doctest::Contains("friction = -1"));
    CHECK_THROWS_WITH(q.press({.into = {0, 0, -2}, .radius_m = kRadius_m, .depth_m = {1e-3}}),
                      doctest::Contains("length 1"));
}
