// tests/tissue/finite_sphere_test.cpp
// The sphere's law at finite strain against Hertz, against the solver that made its table on
// another mesh, against ten-node tetrahedra, and on a layer.
#include "tests/tissue/bodies.h"
#include "tissue/mesh/refine.h"
#include "tissue/reference/half_space_press.h"
#include "tissue/reference/indenter.h"
#include "tissue/response/finite_sphere.h"
#include "tissue/response/finite_sphere_table.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>

namespace {

constexpr double kStuck = std::numeric_limits<double>::infinity();

double hertz(double poisson, double depth) {
    return 4.0 / 3.0 / (1.0 - poisson * poisson) * std::pow(depth, 1.5);
}

// Depth at x on a level of a law, tip radius 1.
double depth_at(const tissue::SphereLaw& law, std::size_t level, double x) {
    const auto& row = law.depth_over_x_m[level];
    const std::size_t i = std::min(static_cast<std::size_t>(x / law.x_step), row.size() - 2);
    const double part = x / law.x_step - static_cast<double>(i);
    return x * ((1.0 - part) * row[i] + part * row[i + 1]);
}

double force_at(const tissue::SphereLaw& law, std::size_t level, double depth) {
    double low = 0.0, high = 8.0;
    for (int pass = 0; pass < 60; ++pass)
        (depth_at(law, level, 0.5 * (low + high)) < depth ? low : high) = 0.5 * (low + high);
    return law.force_scale_n * low * low * low;
}

// A quarter of a block of 40 radii, so deep that its bottom adds P (1-nu^2)/(pi E L) = 1 % at one
// radius of depth and 2 % at seven.
tissue::PressReport press_block(double poisson, const tissue::RefineSize& fine,
                                const std::vector<double>& depth_m, double step_m) {
    constexpr double kSize = 40.0;
    const auto box = tissue::box_mesh(glm::dvec3(kSize), {3, 3, 3});
    const auto mesh =
        tissue::quadratic_mesh(tissue::refined(box, {}, {}, {0, 0, kSize}, fine).mesh);
    std::vector<std::uint8_t> held;
    for (const glm::dvec3& x : mesh.rest_m) {
        int flag = x.z < 1e-9 ? tissue::kHeld : 0;
        flag |= x.x < 1e-9 || x.x > kSize - 1e-9 ? tissue::kHeldX : 0;
        flag |= x.y < 1e-9 || x.y > kSize - 1e-9 ? tissue::kHeldY : 0;
        held.push_back(static_cast<std::uint8_t>(flag));
    }
    const auto model =
        tissue::make_reference(mesh, bodies::elastic(1.0, poisson), tissue::Law::neo_hooke, held);
    auto system = tissue::make_system(model);
    auto state = tissue::rest_state(model);
    tissue::Press p{.place_m = {0, 0, kSize},
                    .radius_m = 1.0,
                    .depth_m = depth_m,
                    .friction = kStuck,
                    .step_m = step_m};
    p.newton.products = 30;
    return tissue::press(model, p, system, state);
}

} // namespace

TEST_CASE("half-space press: shallow and free to slide, a sphere feels Hertz within 3 %") {
    for (const double nu : {0.3, 0.45}) {
        const auto report =
            tissue::press_half_space({.poisson = nu, .depth = {0.05}, .cell = 0.08});
        REQUIRE(report.point.size() == 1);
        CHECK(report.point[0].force == doctest::Approx(hertz(nu, 0.05)).scale(0.0).epsilon(0.03));
        CHECK(report.point[0].contact_radius == doctest::Approx(std::sqrt(0.05)).epsilon(0.1));
    }
}

TEST_CASE("finite sphere: at its shallow end the table is Hertz within 4 %") {
    // a sphere is 2 % softer there than Hertz's paraboloid; stuck, compressible tissue is stiffer,
    // by 3 % under a punch at 0.3 (Spence 1968)
    for (const double nu : {0.3, 0.4, 0.45, 0.49})
        CHECK(tissue::finite_sphere_force(0.2, nu) ==
              doctest::Approx(hertz(nu, 0.2)).scale(0.0).epsilon(0.04));
}

TEST_CASE("finite sphere: coarser cells give the table's forces within 1 %") {
    const auto report = tissue::press_half_space(
        {.poisson = 0.4, .friction = kStuck, .depth = {0.5, 1.5, 3.0}, .cell = 0.2});
    REQUIRE(report.point.size() == 3);
    for (const auto& p : report.point)
        CHECK(p.force ==
              doctest::Approx(tissue::finite_sphere_force(p.depth, 0.4)).scale(0.0).epsilon(0.01));
}

TEST_CASE("finite sphere: ten-node tetrahedra feel the table's force within 4 %") {
    const double nu = 0.45;
    const auto report =
        press_block(nu, {.edge_m = 0.5, .core_m = 0.8, .growth = 1.0}, {1.0, 2.0}, 0.5);
    REQUIRE(report.point.size() == 2);
    for (const auto& p : report.point)
        CHECK(4 * p.force_n.z ==
              doctest::Approx(tissue::finite_sphere_force(p.depth_m, nu)).scale(0.0).epsilon(0.04));
}

TEST_CASE("finite sphere: how stiff ten-node tetrahedra are at seven radii, and deep ones less" *
          doctest::test_suite("slow")) {
    // what presses of organs to 10 mm are measured by is itself no better than the latter; 2 % of
    // the stiffness is the block's size
    struct Mesh {
        tissue::RefineSize size;
        double force, stiffness; // most above the table's
    };
    const double nu = 0.45, table = tissue::finite_sphere_force(20.0 / 3.0, nu),
                 slope = (table - tissue::finite_sphere_force(19.0 / 3.0, nu)) / (1.0 / 3.0);
    double last_force = 1.0, last_stiffness = 1.0;
    for (const Mesh& m :
         {Mesh{{0.5, 1.5, 1.0}, 0.065, 0.18}, {{0.5, 0.7, 1.0, {0.0, 0.0, -4.0}}, 0.052, 0.09}}) {
        const auto report = press_block(nu, m.size, {3.0, 19.0 / 3.0, 20.0 / 3.0}, 1.0 / 3.0);
        REQUIRE(report.point.size() == 3);
        const double at = 4 * report.point[2].force_n.z, before = 4 * report.point[1].force_n.z;
        const double force = at / table - 1.0, stiffness = (at - before) * 3.0 / slope - 1.0;
        CHECK(4 * report.point[0].force_n.z ==
              doctest::Approx(tissue::finite_sphere_force(3.0, nu)).scale(0.0).epsilon(0.025));
        CHECK(force > 0.0);
        CHECK(force < m.force);
        CHECK(stiffness < m.stiffness);
        CHECK(force < 0.85 * last_force);
        CHECK(stiffness < 0.6 * last_stiffness);
        last_force = force, last_stiffness = stiffness;
    }
}

TEST_CASE("finite sphere: the law on a half-space has the table's forces within 0.2 %") {
    for (const double nu : {0.3, 0.43, 0.49}) {
        const auto law = tissue::make_finite_sphere_law(1.0, 1.0, nu, 10, 257);
        for (const double depth : tissue::kFiniteDepth)
            CHECK(force_at(law, 0, depth) ==
                  doctest::Approx(tissue::finite_sphere_force(depth, nu)).scale(0.0).epsilon(2e-3));
    }
}

TEST_CASE("finite sphere: depth grows strictly with force at every level, beyond the table too") {
    for (const double nu : {0.0, 0.3, 0.44, 0.49, 0.5}) {
        const auto law = tissue::make_finite_sphere_law(1.0, 1.0, nu, 10, 257);
        for (std::size_t level = 0; level < 10; ++level) {
            double last = 0.0;
            for (int i = 1; i < 2560; ++i) {
                const double depth = depth_at(law, level, 0.1 * i * law.x_step);
                CHECK(depth > last);
                last = depth;
            }
        }
    }
}

TEST_CASE("finite sphere: the ratio to small strain has a continuous slope at every joint") {
    const double nu = 0.45;
    for (const double depth : tissue::kFiniteDepth) {
        const double x = std::cbrt(tissue::finite_sphere_force(depth, nu) * (1.0 - nu * nu));
        const double h = 1e-4;
        const auto rho = [&](double at) { return tissue::finite_depth_ratio(at, nu); };
        CHECK(rho(x - 1e-9) == doctest::Approx(rho(x + 1e-9)).scale(0.0).epsilon(1e-7));
        const double before = (rho(x) - rho(x - h)) / h, after = (rho(x + h) - rho(x)) / h;
        CHECK(std::abs(after - before) < 2e-3);
    }
}

TEST_CASE("finite sphere: pressed to a quarter of a layer the law is within 4 %") {
    // level 3 of 10: a third of the thickness
    const auto law = tissue::make_finite_sphere_law(1.0, 1.0, 0.45, 10, 257);
    REQUIRE(law.radius_over_thickness[3] == doctest::Approx(1.0 / 3.0));
    const auto report = tissue::press_half_space(
        {.poisson = 0.45, .friction = kStuck, .depth = {0.3, 0.75}, .thickness = 3.0});
    REQUIRE(report.point.size() == 2);
    for (const auto& p : report.point)
        CHECK(force_at(law, 3, p.depth) == doctest::Approx(p.force).scale(0.0).epsilon(0.04));
    // and nobody could take it for a half-space
    CHECK(report.point[1].force > 1.3 * tissue::finite_sphere_force(0.75, 0.45));
}

TEST_CASE("half-space press: what cannot be pressed is refused with the value") {
    CHECK_THROWS_WITH(tissue::press_half_space({.depth = {1.0, 0.5}}),
                      doctest::Contains("depth = 0.5"));
    CHECK_THROWS_WITH(tissue::press_half_space({.depth = {1.0}, .cell = 2.0}),
                      doctest::Contains("cell = 2.0"));
}
