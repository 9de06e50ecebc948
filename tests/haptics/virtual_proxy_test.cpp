#include "haptics/contact/virtual_proxy.h"

#include "haptics/contact/plane_qp.h"
#include "tests/haptics/proxy_bench.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

namespace {

using glm::dvec3;
using haptics::step_virtual_proxy;
using proxy_bench::Bench;

constexpr double kRadius_m = 1e-3;

Bench with_ball(Bench b) {
    b.input.radius_m = kRadius_m;
    return b;
}

/// The edge of a table: its top z = 0 for x < 0, its side x = 0 for z < 0.
Bench table() {
    Bench b;
    b.quad({-0.1, -0.1, 0}, {0, -0.1, 0}, {0, 0.1, 0}, {-0.1, 0.1, 0});
    b.quad({0, -0.1, 0}, {0, -0.1, -0.1}, {0, 0.1, -0.1}, {0, 0.1, 0});
    return b;
}

/// Whatever keeps the proxy from the device, the force is the spring between them, and nothing if
/// it is there.
bool force_is_the_spring(const Bench& b) {
    const dvec3 lag_m = b.state.proxy_m - b.input.device_m;
    return b.state.force_n == b.input.stiffness_npm * lag_m &&
           b.state.touching == (lag_m != dvec3{0.0}) &&
           (b.state.touching || (!b.state.sliding && b.state.contacts == 0));
}

} // namespace

TEST_CASE("virtual proxy: on a plane F = k d, d from the ball's lowest point") {
    Bench b = with_ball(proxy_bench::floor());
    b.input.stiffness_npm = 800.0;
    CHECK_FALSE(b.lead(step_virtual_proxy, {0.01, 0.02, 1.5e-3}).touching);
    for (int i = 1; i <= 30; ++i) {
        const double depth_m = 1e-3 * i;
        b.lead(step_virtual_proxy, {0.01, 0.02, kRadius_m - depth_m});
        CHECK(b.state.touching);
        CHECK(glm::length(b.state.force_n - dvec3{0, 0, 800.0 * depth_m}) < 1e-5);
    }
    CHECK(b.lead(step_virtual_proxy, {0.01, 0.02, 1.5e-3}).force_n == dvec3{0.0});
}

TEST_CASE("virtual proxy: in a cube corner it is the exact nearest point, in one tick") {
    Bench b = with_ball(proxy_bench::cube_corner());
    std::mt19937_64 engine(2);
    std::uniform_real_distribution<double> place(-4e-3, 6e-3);
    const std::vector<haptics::Plane> walls{
        {{1, 0, 0}, kRadius_m}, {{0, 1, 0}, kRadius_m}, {{0, 0, 1}, kRadius_m}};
    int held[4]{};
    b.lead(step_virtual_proxy, {0.01, 0.01, 0.01});
    for (int i = 0; i < 2000; ++i) {
        const dvec3 device_m{place(engine), place(engine), place(engine)};
        b.lead(step_virtual_proxy, device_m);
        const auto exact = haptics::nearest_in_planes(walls, device_m);
        CHECK(glm::length(b.state.proxy_m - exact.place_m) < 2e-8);
        ++held[exact.actives];
    }
    for (const int n : held)
        CHECK(n > 100);
}

TEST_CASE("virtual proxy: pressed on an edge the ball rests on it, and rolls round it") {
    Bench b = with_ball(table());
    b.lead(step_virtual_proxy, {-1e-2, 0, 2e-3});
    for (int i = 0; i <= 400; ++i) { // past the edge, 0.3 mm deep, down the side
        const double s = -5e-3 + 25e-6 * i;
        const dvec3 device_m =
            s < 0 ? dvec3{s, 0, 0.7e-3} : dvec3{0.7e-3, 0, std::max(0.7e-3 - s, -5e-3)};
        b.lead(step_virtual_proxy, device_m);
        const dvec3 p = b.state.proxy_m;
        const double off_m = p.x < 0 ? p.z : p.z < 0 ? p.x : glm::length(dvec3{p.x, 0, p.z});
        REQUIRE(std::abs(off_m - kRadius_m) < 2e-8);
        // nothing but what the surface pushes
        const dvec3 out = p - dvec3{std::min(p.x, 0.0), 0, std::min(p.z, 0.0)};
        CHECK(force_is_the_spring(b));
        if (b.state.touching)
            CHECK(glm::length(glm::cross(b.state.force_n, out / kRadius_m)) < 2e-3);
    }
}

TEST_CASE("virtual proxy: dragged over an edge the force never lets go, however far it lags") {
    for (const double deep_m : {0.3e-3, 0.7e-3, 0.9e-3, 1.5e-3})
        for (const double step_m : {1e-5, 5e-5, 2e-4}) {
            CAPTURE(deep_m);
            CAPTURE(step_m);
            Bench b = with_ball(table());
            b.lead(step_virtual_proxy, {-1e-2, 0, 2e-3});
            for (int i = 0; i < static_cast<int>(7e-3 / step_m); ++i) {
                const dvec3 device_m{-5e-3 + step_m * i, 0, kRadius_m - deep_m};
                b.lead(step_virtual_proxy, device_m);
                CHECK(force_is_the_spring(b));
                if (b.state.touching)
                    CHECK(b.state.contacts > 0);
                // the ball cannot be nearer to the device than the device's own depth
                const dvec3 out_m{std::max(device_m.x, 0.0), 0, std::max(device_m.z, 0.0)};
                const double in_m = std::min(-device_m.z, -device_m.x);
                const double depth_m = kRadius_m - (in_m > 0.0 ? -in_m : glm::length(out_m));
                CHECK(glm::length(b.state.force_n) >=
                      b.input.stiffness_npm * depth_m * (1.0 - 1e-9));
            }
        }
}

TEST_CASE("virtual proxy: held from all sides it stays, and pulls") {
    // two walls that have closed in on the ball: no place is a radius off both
    Bench b;
    b.quad({0.9e-3, -0.1, -0.1}, {0.9e-3, 0.1, -0.1}, {0.9e-3, 0.1, 0.1}, {0.9e-3, -0.1, 0.1});
    b.quad({-0.9e-3, -0.1, -0.1}, {-0.9e-3, -0.1, 0.1}, {-0.9e-3, 0.1, 0.1}, {-0.9e-3, 0.1, -0.1});
    b = with_ball(b);
    b.lead(step_virtual_proxy, {0, 0, 0});
    const dvec3 kept_m = b.state.proxy_m;
    b.lead(step_virtual_proxy, {1e-3, 0, 2e-3});
    CHECK(b.state.proxy_m == kept_m);
    CHECK(b.state.touching);
    CHECK(force_is_the_spring(b));
}

TEST_CASE("virtual proxy: never gets into a crumpled ball, nor nearer than its radius") {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Bench b = with_ball(proxy_bench::crumpled_ball(seed));
        proxy_bench::Hand hand{std::mt19937_64(seed)};
        int touched = 0;
        double inside_m = -1.0;
        double nearest_m = kRadius_m;
        for (int i = 0; i < 4000; ++i) {
            touched += b.lead(step_virtual_proxy, hand.next()).touching;
            CHECK(force_is_the_spring(b));
            inside_m = std::max(inside_m, proxy_bench::inside_m(b, b.state.proxy_m));
            const auto skin =
                haptics::closest_within(b.index, b.mesh(), b.state.proxy_m, kRadius_m);
            if (skin.hit())
                nearest_m = std::min(nearest_m, skin.distance_m);
        }
        CHECK(touched > 1000);
        CHECK(inside_m < 0.0);
        CHECK(nearest_m > kRadius_m * (1.0 - 1e-9));
    }
}

TEST_CASE("virtual proxy: a stuck ball does not creep, a sliding one drags mu times the push") {
    Bench b = with_ball(proxy_bench::floor());
    b.input.static_friction = 0.4;
    b.input.dynamic_friction = 0.3;
    const double push_m = 2e-3; // 1 N
    b.lead(step_virtual_proxy, {0, 0, 2e-3});
    b.lead(step_virtual_proxy, {0, 0, kRadius_m - push_m});
    const dvec3 stuck_m = b.state.proxy_m;
    for (int i = 0; i < 10000; ++i)
        b.lead(step_virtual_proxy, {0.39 * push_m, 0, kRadius_m - push_m});
    CHECK(glm::length(b.state.proxy_m - stuck_m) < 1e-8);
    CHECK_FALSE(b.state.sliding);
    for (int i = 1; i < 1000; ++i) {
        b.lead(step_virtual_proxy, {0.41 * push_m + 1e-5 * i, 0, kRadius_m - push_m});
        CHECK(b.state.sliding);
        CHECK(b.state.force_n.x == doctest::Approx(-0.3).scale(0.0).epsilon(1e-3));
        CHECK(b.state.force_n.z == doctest::Approx(1.0).scale(0.0).epsilon(1e-3));
    }
    CHECK(b.lead(step_virtual_proxy, {0.02, 0, 2e-3}).force_n == dvec3{0.0});
}

TEST_CASE("virtual proxy: what is not finite, or no radius, gives no force") {
    Bench b = with_ball(proxy_bench::floor());
    b.lead(step_virtual_proxy, {0, 0, 2e-3});
    b.lead(step_virtual_proxy, {0, 0, 0});
    const dvec3 kept_m = b.state.proxy_m;
    b.lead(step_virtual_proxy, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
    CHECK(b.state.force_n == dvec3{0.0});
    CHECK(b.state.proxy_m == kept_m);
    b.input.radius_m = 0.0;
    CHECK(b.lead(step_virtual_proxy, {0, 0, -1e-3}).force_n == dvec3{0.0});
}
