#include "assets/bake/shape.h"

#include "tests/bake/shapes_for_tests.h"

#include <cmath>
#include <doctest/doctest.h>
#include <map>
#include <numbers>
#include <rapidcheck.h>

TEST_CASE("lobed shape: one lobe is an ellipsoid of volume 4/3 pi a b c, tilted or not") {
    for (const glm::dvec3 tilt : {glm::dvec3{0.0}, glm::dvec3{30.0, -20.0, 50.0}}) {
        const bake::LobedShape shape{
            .lobes = {{.centre_mm = {5, -3, 8}, .radius_mm = {40, 25, 15}, .tilt_deg = tilt}},
            .hollows = {}};
        const auto bounds = bake::lobed_bounds_m(shape);
        const auto s = bake::polygonise(bake::lobed_field(shape), bounds[0], bounds[1], 0.0015);
        const double exact = 4.0 / 3.0 * std::numbers::pi * 0.040 * 0.025 * 0.015;
        CHECK(bake::volume_m3(s) == bake_tests::near(exact, 0.005));
    }
}

TEST_CASE("lobed shape: a tilt about z turns the long axis from x towards y") {
    const bake::LobedShape shape{.lobes = {{.radius_mm = {40, 10, 10}, .tilt_deg = {0, 0, 90}}},
                                 .hollows = {}};
    const auto field = bake::lobed_field(shape);
    CHECK(field({0.0, 0.039, 0.0}) < 0.0);
    CHECK(field({0.039, 0.0, 0.0}) > 0.0);
}

TEST_CASE("lobed shape: a hollow takes its volume away") {
    const bake::LobedShape shape{.lobes = {{.radius_mm = {30, 30, 30}}},
                                 .hollows = {{.radius_mm = {15, 15, 15}}}};
    const auto bounds = bake::lobed_bounds_m(shape);
    const auto s = bake::polygonise(bake::lobed_field(shape), bounds[0], bounds[1], 0.0015);
    const double exact = 4.0 / 3.0 * std::numbers::pi * (std::pow(0.030, 3) - std::pow(0.015, 3));
    CHECK(bake::volume_m3(s) == bake_tests::near(exact, 0.005));
}

TEST_CASE("lobed shape: rounding where two balls meet only adds, and only near the seam") {
    bake::LobedShape sharp{.lobes = {{.centre_mm = {-20, 0, 0}, .radius_mm = {25, 25, 25}},
                                     {.centre_mm = {20, 0, 0}, .radius_mm = {25, 25, 25}}},
                           .hollows = {}};
    bake::LobedShape smooth = sharp;
    smooth.lobes[1].blend_mm = 10.0;
    const auto a = bake::lobed_field(sharp), b = bake::lobed_field(smooth);
    CHECK(b({0.0, 0.017, 0.0}) < a({0.0, 0.017, 0.0}) - 0.002);
    CHECK(b({-0.045, 0.0, 0.0}) == a({-0.045, 0.0, 0.0}));
}

TEST_CASE("noise: stays within -1 and 1, is continuous, and follows its seed") {
    CHECK(rc::check([] {
        const auto c = [] { return *rc::gen::inRange(-5000, 5000) * 0.1; };
        const double x = c(), y = c(), z = c();
        const glm::dvec3 p{x, y, z};
        const double here = bake::smooth_noise(p, 30.0, 7);
        RC_ASSERT(std::abs(here) <= 1.0);
        // slope at most 15/8 (quintic) times 2 (values) per 15 mm and axis
        const double there = bake::smooth_noise(p + glm::dvec3{0.01, 0.0, 0.0}, 30.0, 7);
        RC_ASSERT(std::abs(there - here) <= 0.01 * 2.0 * 1.875 / 15.0 + 1e-12);
    }));
    CHECK(bake::smooth_noise({1, 2, 3}, 30.0, 7) != bake::smooth_noise({1, 2, 3}, 30.0, 8));
}

TEST_CASE("vault: one open sheet whose triangles face the middle") {
    const bake::VaultShape shape{.radius_mm = {150, 125, 75}, .opening_deg = 100.0};
    const auto s = bake::vault_surface(shape, 0.015);
    const auto problems = bake::check_surface(s);
    CHECK(problems.refused_triangles == 0);
    CHECK(problems.pinched_vertices == 0);
    CHECK(problems.shells == 1);
    for (const auto& t : s.triangles) {
        const auto a = s.point_m[t[0]], b = s.point_m[t[1]], c = s.point_m[t[2]];
        CHECK(glm::dot(glm::cross(b - a, c - a), a) < 0.0);
    }
    for (const auto& p : s.point_m) { // on the ellipsoid
        CHECK(glm::length(p / glm::dvec3{0.150, 0.125, 0.075}) == bake_tests::near(1.0));
    }
}

TEST_CASE("box: closed, with its volume; the top alone is one flat face") {
    const glm::dvec3 size{0.08, 0.06, 0.04};
    const auto s = bake::box_surface(size, 0.01);
    CHECK(bake::describe(bake::check_surface(s)).empty());
    CHECK(bake::volume_m3(s) == bake_tests::near(size.x * size.y * size.z));
    const auto top = bake::box_top(size, 0.01);
    CHECK(bake::area_m2(top) == bake_tests::near(size.x * size.y));
    for (const auto& n : bake::vertex_normals(top)) {
        CHECK(n.z == bake_tests::near(1.0));
    }
}
