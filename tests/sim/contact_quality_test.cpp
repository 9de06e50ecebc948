// tests/sim/contact_quality_test.cpp
// Each failure of a contact method, made by hand over a slab 1 mm thick, is counted as what it is
// and as nothing else.
#include "haptics/collision/index.h"
#include "sim/study/contact_quality.h"
#include "sim/study/contact_workload.h"
#include "sim/study/mesh_sides.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace {

using glm::dvec3;
using haptics::Corners;

constexpr double kRadius_m = 0.002;

/// A slab from z = -1 mm to 0, 200 mm wide, without its rim.
struct Slab {
    std::vector<dvec3> vertex_m;
    std::vector<Corners> triangle{{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
    haptics::MeshView mesh;
    haptics::CollisionIndex index;
    sim::NearestSkin nearest = [this](const dvec3& p) {
        return haptics::closest_within(index, mesh, p, 0.05);
    };

    Slab() {
        for (const double z : {0.0, -0.001})
            for (const auto& [x, y] : {std::pair{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}})
                vertex_m.push_back({x, y, z});
        mesh = {vertex_m, triangle, {}};
        index = haptics::make_index("brute-force", mesh);
    }
    static int side(const dvec3& p) { return p.z > 0.0 ? 1 : p.z < -0.001 ? -1 : 0; }
};

struct Moment {
    dvec3 device_m, proxy_m, force_n;
};

/// What a perfect method does: rests a radius above, pulls with 500 N/m.
Moment perfect(const dvec3& device_m) {
    Moment m{device_m, device_m, {}};
    m.proxy_m.z = std::max(device_m.z, kRadius_m);
    m.force_n = 500.0 * (m.proxy_m - device_m);
    return m;
}

sim::ContactQuality judged(const std::vector<Moment>& run,
                           const sim::QualityLimits& limits = {.radius_m = kRadius_m}) {
    const Slab slab;
    sim::ContactJudge judge(limits);
    for (const Moment& m : run)
        judge.add({m.device_m, m.proxy_m, Slab::side(m.device_m), Slab::side(m.proxy_m), m.force_n},
                  slab.nearest);
    return judge.quality();
}

/// 100 ticks down from 5 mm above touch to 4 mm below it, 0.09 mm each.
std::vector<Moment> press() {
    std::vector<Moment> run;
    for (int i = 0; i <= 100; ++i)
        run.push_back(perfect({0.0, 0.0, kRadius_m + 0.005 - 0.00009 * i}));
    return run;
}

struct Counts {
    int lost, sunk, wrong_side, stuck, bad;
};

void check(const sim::ContactQuality& q, const Counts& expected) {
    CHECK(q.lost == expected.lost);
    CHECK(q.sunk == expected.sunk);
    CHECK(q.wrong_side == expected.wrong_side);
    CHECK(q.stuck == expected.stuck);
    CHECK(q.bad == expected.bad);
}

} // namespace

TEST_CASE("quality: a perfect press through a thin slab is flawless, its ticks are counted") {
    const auto q = judged(press());
    check(q, {0, 0, 0, 0, 0});
    CHECK(q.ticks == 101);
    CHECK(q.contact_ticks == 45); // from 5.00 / 0.09 = 55.6 on
    CHECK(q.max_force_n == doctest::Approx(500.0 * 0.004).scale(0.0));
    CHECK(q.max_force_step_n == doctest::Approx(500.0 * 0.00009).scale(0.0));
    CHECK(q.deepest_m == doctest::Approx(0.0).scale(1e-3));
    // behind the slab its far skin is the nearest: the free place is taken for up to 1 mm nearer
    CHECK(q.largest_lag_m < 0.00101);
}

TEST_CASE("quality: forces are told as if the stiffness were 500 N/m") {
    auto run = press();
    for (Moment& m : run)
        m.force_n *= 4.0;
    const auto q = judged(run, {.radius_m = kRadius_m, .stiffness_npm = 2000.0});
    CHECK(q.max_force_n == doctest::Approx(500.0 * 0.004).scale(0.0));
    CHECK(q.max_force_step_n == doctest::Approx(500.0 * 0.00009).scale(0.0));
    CHECK(q.lost == 0);
}

TEST_CASE("quality: pressed in without a force is lost") {
    auto run = press();
    for (Moment& m : run)
        m.force_n = {};
    const auto q = judged(run);
    check(q, {44, 0, 0, 0, 44}); // deeper than 0.1 mm: from 5.1 / 0.09 = 56.7 on, to 100
}

TEST_CASE("quality: a proxy below where the ball rests is sunk, beyond the limit only") {
    for (const auto& [deep_m, sunk] : {std::pair{0.00009, 0}, {0.00011, 1}, {0.0019, 1}}) {
        Moment m = perfect({0.0, 0.0, -0.0005});
        m.proxy_m.z -= deep_m;
        m.force_n = 500.0 * (m.proxy_m - m.device_m);
        const auto q = judged({m});
        check(q, {0, sunk, 0, 0, sunk});
        CHECK(q.deepest_m == doctest::Approx(deep_m).scale(0.0));
    }
}

TEST_CASE(
    "quality: a proxy that dips while the device is free is not sunk: nothing is felt there") {
    Moment m = perfect({0.0, 0.0, 0.003});
    m.proxy_m.z = kRadius_m - 0.0005;
    check(judged({m}), {0, 0, 0, 0, 0});
}

TEST_CASE("quality: a proxy within or below the slab is on the wrong side, pressed or not") {
    Moment under = perfect({0.0, 0.0, -0.0008});
    under.proxy_m.z = -0.001 - kRadius_m; // where the nearest-point method puts it
    under.force_n = 500.0 * (under.proxy_m - under.device_m);
    check(judged({under}), {0, 0, 1, 0, 1});
    Moment within = perfect({0.0, 0.0, -0.0008});
    within.proxy_m.z = -0.0005;
    check(judged({within}), {0, 0, 1, 0, 1});
    Moment forgotten = perfect({0.0, 0.0, 0.010}); // the device is free again
    forgotten.proxy_m.z = -0.001 - kRadius_m;
    check(judged({forgotten}), {0, 0, 1, 0, 1});
    // the proxy of a point lies on the skin, give or take a rounding
    Moment point = perfect({0.0, 0.0, -0.0004});
    point.proxy_m.z = -1e-9;
    point.force_n = 500.0 * (point.proxy_m - point.device_m);
    check(judged({point}, {.radius_m = 0.0}), {0, 0, 0, 0, 0});
}

TEST_CASE("quality: a device that fell through with its proxy is lost and on the wrong side") {
    const dvec3 through{0.0, 0.0, -0.0045};
    check(judged({{through, through, {}}}), {1, 0, 1, 0, 1});
}

TEST_CASE("quality: a proxy that stays behind for longer than 50 ms is stuck") {
    const auto behind = [](int ticks, double by_m) {
        std::vector<Moment> run;
        for (int i = 0; i < ticks; ++i) {
            Moment m = perfect({0.02, 0.0, 0.0});
            m.proxy_m.x -= by_m;
            m.force_n = 500.0 * (m.proxy_m - m.device_m);
            run.push_back(m);
        }
        return run;
    };
    check(judged(behind(50, 0.02)), {0, 0, 0, 0, 0});
    check(judged(behind(80, 0.02)), {0, 0, 0, 30, 30});
    CHECK(judged(behind(80, 0.02)).longest_stuck_ticks == 80);
    // 2 mm deep: sqrt(4.5^2 + 2^2) is 2.92 mm further off than 2 mm, sqrt(4.7^2 + 2^2) 3.1
    check(judged(behind(80, 0.0045)), {0, 0, 0, 0, 0});
    check(judged(behind(80, 0.0047)), {0, 0, 0, 30, 30});
    // a moment in which it follows begins the count again
    auto run = behind(40, 0.02);
    run.push_back(perfect({0.02, 0.0, 0.0}));
    for (const Moment& m : behind(40, 0.02))
        run.push_back(m);
    check(judged(run), {0, 0, 0, 0, 0});
    // free, and the proxy still hangs at the skin
    std::vector<Moment> hanging(60, perfect({0.0, 0.0, 0.012}));
    for (Moment& m : hanging)
        m.proxy_m.z = kRadius_m;
    check(judged(hanging), {0, 0, 0, 10, 10});
}

TEST_CASE("quality: a jump of the force is told in full, whichever way it points") {
    std::vector<Moment> run(3, perfect({0.0, 0.0, 0.001}));
    run[1].force_n = {0.3, -0.4, 0.5};
    const auto q = judged(run);
    CHECK(q.max_force_step_n == doctest::Approx(0.5).scale(0.0)); // (0.3, -0.4, 0) and back
}

TEST_CASE("quality: limits that mean nothing are refused") {
    CHECK_THROWS_AS(sim::ContactJudge({.radius_m = -1.0}), std::invalid_argument);
    CHECK_THROWS_AS(sim::ContactJudge({.stiffness_npm = 0.0}), std::invalid_argument);
}

TEST_CASE("mesh sides: the nearest point's pseudonormal agrees with how the meshes are made") {
    for (const char* name : {"organ:1k", "sheet:1k"}) {
        CAPTURE(name);
        const auto work = sim::make_contact_workload(name, 2);
        const haptics::MeshView mesh{work.rest_m, work.triangle, {}};
        const auto index = haptics::make_index("brute-force", mesh);
        const sim::MeshSides sides(work.triangle, work.rest_m.size());
        sim::Dice dice(3);
        int on_edges = 0;
        for (int i = 0; i < 2000; ++i) {
            dvec3 place = (0.060 + dice.between(-0.01, 0.01)) * dice.direction();
            if (!work.organ)
                place = {dice.between(-0.055, 0.055), dice.between(-0.055, 0.055),
                         dice.between(-0.01, 0.01)};
            const auto hit = haptics::closest_within(index, mesh, place, 1.0);
            on_edges += std::min({hit.weight.x, hit.weight.y, hit.weight.z}) < 1e-9;
            REQUIRE((sides.side_of(mesh, hit, place) == 0) ==
                    (side_of(work, work.rest_m, place) == 0));
        }
        CHECK(on_edges > 50); // the case that a face's normal alone gets wrong
    }
}

TEST_CASE("mesh sides: a vertex is not turned by how finely one of its faces is cut") {
    // a needle along z; the face to +x is cut into ten, which pull a plain mean of normals over
    std::vector<dvec3> vertex{{0.0, 0.0, 1.0}, {-0.1, 0.1, 0.0}, {-0.1, -0.1, 0.0}};
    for (int i = 0; i <= 10; ++i)
        vertex.push_back({0.1, -0.1 + 0.02 * i, 0.0});
    std::vector<Corners> triangle{{0, 1, 2}, {0, 2, 3}, {0, 13, 1}};
    for (std::uint32_t i = 3; i < 13; ++i)
        triangle.push_back({0, i, i + 1});
    const haptics::MeshView mesh{vertex, triangle, {}};
    const sim::MeshSides sides(triangle, vertex.size());
    for (const dvec3& out : {dvec3{-0.5, 0.0, 1.0}, {0.5, 0.0, 1.0}, {0.0, 0.5, 1.0}}) {
        const dvec3 place = vertex[0] + out;
        haptics::SurfaceHit apex{.triangle = 5, .weight = {1.0, 0.0, 0.0}, .place_m = vertex[0]};
        CHECK(sides.side_of(mesh, apex, place) == 1);
        CHECK(sides.side_of(mesh, apex, vertex[0] - out) == 0);
    }
}
