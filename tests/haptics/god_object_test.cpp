#include "haptics/contact/god_object.h"

#include "haptics/contact/plane_qp.h"
#include "tests/haptics/proxy_bench.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

namespace {

using glm::dvec3;
using haptics::step_god_object;
using proxy_bench::Bench;

} // namespace

TEST_CASE("god-object: on a plane F = k d, from either side, and it stays for any depth") {
    for (const double side : {1.0, -1.0}) {
        Bench b = proxy_bench::floor();
        b.input.stiffness_npm = 800.0;
        b.lead(step_god_object, {0.01, 0.02, side * 0.001});
        CHECK_FALSE(b.state.touching);
        for (int i = 1; i <= 30; ++i) {
            const double depth_m = 1e-3 * i;
            b.lead(step_god_object, {0.01, 0.02 + 1e-4 * i, -side * depth_m});
            CHECK(b.state.touching);
            CHECK(glm::length(b.state.force_n - dvec3{0, 0, side * 800.0 * depth_m}) <
                  1e-4 * 800.0 * depth_m);
        }
        b.lead(step_god_object, {0.01, 0.02, side * 0.001});
        CHECK(b.state.force_n == dvec3{0.0});
    }
}

TEST_CASE("god-object: slides over a plane for a long time without falling through") {
    Bench b = proxy_bench::floor();
    b.lead(step_god_object, {0, 0, 1e-3});
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> step(-1e-3, 1e-3);
    dvec3 device_m{0, 0, -2e-3};
    for (int i = 0; i < 20000; ++i) {
        device_m.x = std::clamp(device_m.x + step(engine), -0.09, 0.09);
        device_m.y = std::clamp(device_m.y + step(engine), -0.09, 0.09);
        device_m.z = std::clamp(device_m.z + step(engine), -5e-3, -1e-6);
        b.lead(step_god_object, device_m);
        REQUIRE(b.state.proxy_m.z > 0.0);
        REQUIRE(glm::length(b.state.proxy_m - dvec3{device_m.x, device_m.y, 0.0}) < 1e-7);
    }
}

TEST_CASE("god-object: in a corner of two and of three planes it is where the exact point is") {
    Bench b = proxy_bench::cube_corner();
    std::mt19937_64 engine(2);
    std::uniform_real_distribution<double> place(-5e-3, 5e-3);
    const std::vector<haptics::Plane> walls{{{1, 0, 0}, 0}, {{0, 1, 0}, 0}, {{0, 0, 1}, 0}};
    int held[4]{};
    b.lead(step_god_object, {0.01, 0.01, 0.01});
    for (int i = 0; i < 2000; ++i) {
        const dvec3 device_m{place(engine), place(engine), place(engine)};
        // a second tick from there: the facets that hold it now are the ones in the way
        b.lead(step_god_object, device_m);
        b.lead(step_god_object, device_m);
        const auto exact = haptics::nearest_in_planes(walls, device_m);
        CHECK(glm::length(b.state.proxy_m - exact.place_m) < 2e-7);
        ++held[b.state.contacts];
    }
    for (const int n : held)
        CHECK(n > 100);
}

TEST_CASE("god-object: in an acute corner both planes hold it at the exact point") {
    Bench b; // walls 60 degrees apart that meet in the y axis
    const double c = 0.5, s = std::sqrt(0.75);
    b.quad({0, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {0, 0.1, 0});
    b.quad({0, -0.1, 0}, {0, 0.1, 0}, {0.1 * c, 0.1, 0.1 * s}, {0.1 * c, -0.1, 0.1 * s});
    const std::vector<haptics::Plane> walls{{{0, 0, 1}, 0}, {{s, 0, -c}, 0}};
    for (int i = 0; i < 50; ++i) {
        b.state = {};
        b.lead(step_god_object, {0.02, 0, 0.01});
        const dvec3 device_m{1e-4 * i, 1e-3, -3e-3};
        b.lead(step_god_object, device_m);
        const dvec3 exact_m = haptics::nearest_in_planes(walls, device_m).place_m;
        CHECK(glm::length(b.state.proxy_m - exact_m) < 1e-6);
    }
    CHECK(b.state.contacts == 1); // the last ones only lean on the floor
    b.lead(step_god_object, {-5e-3, 0, 1e-3});
    CHECK(b.state.contacts == 2);
}

TEST_CASE("god-object: never gets into a crumpled ball") {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Bench b = proxy_bench::crumpled_ball(seed);
        proxy_bench::Hand hand{std::mt19937_64(seed)};
        int touched = 0;
        double inside_m = -1.0;
        for (int i = 0; i < 4000; ++i) {
            touched += b.lead(step_god_object, hand.next()).touching;
            inside_m = std::max(inside_m, proxy_bench::inside_m(b, b.state.proxy_m));
        }
        CHECK(touched > 1000);
        CHECK(inside_m < 1e-7);
    }
}

TEST_CASE("god-object: a line that meets a crack passes") {
    Bench b;
    b.quad({-0.1, -0.1, 0}, {-1e-6, -0.1, 0}, {-1e-6, 0.1, 0}, {-0.1, 0.1, 0});
    b.quad({1e-6, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {1e-6, 0.1, 0});
    b.lead(step_god_object, {0, 0, 1e-3});
    CHECK_FALSE(b.lead(step_god_object, {0, 0, -1e-3}).touching);
}

TEST_CASE("god-object: what is not finite gives no force and changes nothing else") {
    Bench b = proxy_bench::floor();
    b.lead(step_god_object, {0, 0, 1e-3});
    b.lead(step_god_object, {0, 0, -1e-3});
    const dvec3 kept_m = b.state.proxy_m;
    b.lead(step_god_object, {std::numeric_limits<double>::quiet_NaN(), 0, -1e-3});
    CHECK(b.state.force_n == dvec3{0.0});
    CHECK(b.state.proxy_m == kept_m);
    CHECK(b.lead(step_god_object, {0, 0, -1e-3}).force_n.z == doctest::Approx(0.5).scale(0.0));
}
