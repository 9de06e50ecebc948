#include "haptics/contact/safe_proxy.h"

#include "tests/haptics/effort.h"
#include "tests/haptics/proxy_bench.h"

#include <doctest/doctest.h>
#include <limits>
#include <string>

using haptics::step_safe_proxy;
using proxy_bench::Bench;
using proxy_bench::dvec3;

namespace {

Bench with(Bench b, const char* index, double radius_m, double friction = 0.0) {
    b.index = haptics::make_index(index, b.mesh());
    b.input.radius_m = radius_m;
    b.input.static_friction = b.input.dynamic_friction = friction;
    return b;
}

// A square skin across z, 0.4 m wide, of many triangles.
Bench membrane(int cells) {
    Bench b;
    const auto side = static_cast<std::uint32_t>(cells + 1);
    for (std::uint32_t i = 0; i < side; ++i)
        for (std::uint32_t j = 0; j < side; ++j)
            b.vertex.push_back({0.4 * i / cells - 0.2, 0.4 * j / cells - 0.2, 0.0});
    for (std::uint32_t i = 0; i + 1 < side; ++i)
        for (std::uint32_t j = 0; j + 1 < side; ++j) {
            const std::uint32_t a = i * side + j, up = a + side;
            b.triangle.push_back({a, up, a + 1});
            b.triangle.push_back({a + 1, up, up + 1});
        }
    b.index = haptics::make_index("ours", b.mesh());
    return b;
}

} // namespace

TEST_CASE("safe proxy: pressed on a floor it pushes back with stiffness times depth") {
    for (const double radius_m : {0.0, 1e-5, 1e-3, 5e-3}) {
        CAPTURE(radius_m);
        Bench b = with(proxy_bench::floor(), "ours", radius_m);
        b.lead(step_safe_proxy, {0.003, 0.001, radius_m + 1e-4});
        CHECK(b.state.force_n == dvec3{0.0});
        for (int i = 0; i < 40; ++i)
            b.lead(step_safe_proxy, {0.003, 0.001, radius_m - 1e-4 * i});
        CHECK(b.state.touching);
        CHECK(b.state.force_n.z == doctest::Approx(500.0 * 39e-4).scale(0.0).epsilon(1e-4));
        CHECK(std::abs(b.state.force_n.x) + std::abs(b.state.force_n.y) < 1e-9);
        // and off it is free at once
        b.lead(step_safe_proxy, {0.003, 0.001, radius_m + 1e-4});
        CHECK(b.state.force_n == dvec3{0.0});
    }
}

TEST_CASE("safe proxy: never inside a crumpled ball, whatever the radius and the index") {
    for (const char* index : {"brute-force", "hash-grid", "obb-tree", "hybrid", "ours"})
        for (const double radius_m : {0.0, 2e-4, 1e-3}) {
            CAPTURE(std::string(index));
            CAPTURE(radius_m);
            Bench b = with(proxy_bench::crumpled_ball(5), index, radius_m, 0.2);
            proxy_bench::Hand hand{std::mt19937_64(5)};
            double inside_m = -1.0;
            int touched = 0;
            for (int i = 0; i < 3000; ++i) {
                touched += b.lead(step_safe_proxy, hand.next()).touching;
                inside_m = std::max(inside_m, proxy_bench::inside_m(b, b.state.proxy_m));
            }
            CHECK(touched > 500);
            CHECK(inside_m < 0.0);
        }
}

TEST_CASE("safe proxy: metres or millimetres, here or a kilometre away, it does the same") {
    const auto run = [](double unit, const dvec3& offset) {
        Bench b = proxy_bench::crumpled_ball(3);
        for (dvec3& v : b.vertex)
            v = unit * v + offset;
        b = with(b, "ours", 1e-3 * unit);
        b.input.stiffness_npm = 500.0 / unit;
        proxy_bench::Hand hand{std::mt19937_64(3)};
        std::vector<dvec3> force;
        for (int i = 0; i < 1000; ++i)
            force.push_back(b.lead(step_safe_proxy, unit * hand.next() + offset).force_n);
        return force;
    };
    const std::vector<dvec3> here = run(1.0, {0, 0, 0});
    const auto differs = [&](const std::vector<dvec3>& other, double tolerance_n) {
        int out = 0;
        for (std::size_t i = 0; i < here.size(); ++i)
            out += glm::length(here[i] - other[i]) > tolerance_n;
        return out;
    };
    CHECK(differs(run(1e3, {0, 0, 0}), 1e-4) == 0);
    // a kilometre leaves coordinates 1e-13 m and it hovers 2e-10 m off: 1e-7 N, but on a ridge it
    // may fall to the other side
    CHECK(differs(run(1.0, {1000, -1000, 1000}), 1e-4) <= 10);
}

TEST_CASE("safe proxy: 10^4 crossings of a membrane at up to 2 m/s pass none") {
    std::mt19937_64 engine(2);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    for (const double radius_m : {0.0, 5e-5}) {
        Bench b = with(membrane(20), "ours", radius_m);
        const std::vector<dvec3> rest = b.vertex;
        std::vector<dvec3> before;
        int passed = 0;
        for (int crossing = 0; crossing < effort::cases(5000); ++crossing) {
            const double speed_mps = 1.0 + u(engine) * 0.99;
            const dvec3 way =
                glm::normalize(dvec3{u(engine), u(engine), -0.3 - std::abs(u(engine))});
            const dvec3 at{0.1 * u(engine), 0.1 * u(engine), 0.0};
            b.state = {};
            const bool moves = speed_mps > 0.5 && crossing % 2 == 1; // towards the tool, at 100 Hz
            b.vertex = rest;
            haptics::refit(b.index, b.mesh());
            const int ticks = static_cast<int>(0.04 / speed_mps / 1e-3);
            for (int i = -ticks; i < ticks; ++i) {
                haptics::MeshView mesh = b.mesh();
                if (moves && i % 10 == 0) {
                    before = b.vertex;
                    for (dvec3& v : b.vertex)
                        v.z += 0.002 * (0.5 + v.x);
                    mesh = {b.vertex, b.triangle, before};
                    haptics::refit(b.index, mesh);
                }
                b.input.device_m = at + 1e-3 * i * speed_mps * way;
                step_safe_proxy(b.index, mesh, b.input, b.state);
            }
            double skin_z = 0.0; // under the proxy: the skin stays a plane along y
            if (moves)
                skin_z = haptics::closest_within(
                             b.index, b.mesh(),
                             {b.state.proxy_m.x, b.state.proxy_m.y, b.state.proxy_m.z}, 1.0)
                             .place_m.z;
            passed += b.state.proxy_m.z < skin_z;
        }
        CHECK(passed == 0);
    }
}

TEST_CASE("safe proxy: squeezed from both sides it stays finite, and comes free again") {
    Bench b = membrane(10);
    const std::size_t half = b.vertex.size();
    for (std::size_t v = 0; v < half; ++v)
        b.vertex.push_back(b.vertex[v] + dvec3{0, 0, 0.02});
    const std::size_t triangles = b.triangle.size();
    for (std::size_t t = 0; t < triangles; ++t) {
        auto c = b.triangle[t];
        for (auto& v : c)
            v += static_cast<std::uint32_t>(half);
        b.triangle.push_back(c);
    }
    b = with(b, "ours", 2e-3);
    const std::vector<dvec3> rest = b.vertex;
    for (int i = 0; i <= 60; ++i) {
        const std::vector<dvec3> before = b.vertex;
        const double closed = 0.019 * std::sin(3.14159265358979 * i / 60.0); // gap 1 mm, ball 4 mm
        for (std::size_t v = 0; v < b.vertex.size(); ++v)
            b.vertex[v].z = rest[v].z + (v < half ? 0.5 : -0.5) * closed;
        const haptics::MeshView mesh{b.vertex, b.triangle, before};
        haptics::refit(b.index, mesh);
        b.input.device_m = {0.01, 0.02, 0.01};
        step_safe_proxy(b.index, mesh, b.input, b.state);
        REQUIRE(std::isfinite(glm::length(b.state.force_n)));
        CHECK(glm::length(b.state.proxy_m - b.input.device_m) < 0.02);
    }
    for (int i = 0; i < 100; ++i)
        b.lead(step_safe_proxy, {0.01, 0.02, 0.01});
    CHECK(b.state.force_n == dvec3{0.0});
}

TEST_CASE("safe proxy: input that is not finite gives no force and changes nothing else") {
    Bench b = with(proxy_bench::floor(), "ours", 1e-3);
    b.lead(step_safe_proxy, {0, 0, 2e-3});
    for (int i = 0; i < 20; ++i)
        b.lead(step_safe_proxy, {0, 0, 1e-3 - 1e-4 * i});
    const dvec3 proxy_m = b.state.proxy_m, force_n = b.state.force_n;
    CHECK(force_n.z > 0.5);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(b.lead(step_safe_proxy, {0, nan, 0}).force_n == dvec3{0.0});
    CHECK(b.state.proxy_m == proxy_m);
    CHECK(glm::length(b.lead(step_safe_proxy, {0, 0, 1e-3 - 19e-4}).force_n - force_n) < 1e-9);
}
