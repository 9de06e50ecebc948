#include "haptics/contact/safe_tools.h"

#include "haptics/contact/plane_qp.h"
#include "haptics/contact/safe_proxy.h"
#include "tests/haptics/proxy_bench.h"
#include "tests/haptics/tool_bench.h"

#include <doctest/doctest.h>
#include <limits>

// One tool against closed forms. What must never happen is in safe_tools_never_test.cpp.

namespace {

using glm::dvec3;
using tool_bench::Scene;

constexpr double kStiffness_npm = 500.0;

// A roof whose ridge is a straight line through (0, 0, h), turned in the plane z = h.
Scene ridge(double height_m, double turn_rad) {
    const dvec3 along{std::sin(turn_rad), std::cos(turn_rad), 0.0};
    const dvec3 across{along.y, -along.x, 0.0};
    const dvec3 top{0.0, 0.0, height_m}, eave = 0.01 * across - dvec3{0, 0, 0.02};
    Scene s;
    s.quad(top - 0.05 * along, top + 0.05 * along, top + 0.05 * along + eave,
           top - 0.05 * along + eave);
    s.quad(top - 0.05 * along, top + 0.05 * along, top + 0.05 * along - eave - dvec3{0, 0, 0.04},
           top - 0.05 * along - eave - dvec3{0, 0, 0.04});
    return s;
}

// The plane through a pivot over a line, off it by a radius: what a shaft that leans on it keeps.
haptics::Plane over_line(const dvec3& pivot_m, const dvec3& on_m, const dvec3& along,
                         double radius_m) {
    const dvec3 u = glm::normalize(along);
    const dvec3 to_m = on_m - pivot_m - glm::dot(on_m - pivot_m, u) * u;
    const double far_m = glm::length(to_m), sine = radius_m / far_m;
    dvec3 up = glm::normalize(glm::cross(to_m, u));
    up *= up.z < 0.0 ? -1.0 : 1.0;
    const dvec3 n = std::sqrt(1.0 - sine * sine) * up - sine * to_m / far_m;
    return {n, glm::dot(n, pivot_m)};
}

// The nearest point in front of two planes: all sets of them that may hold it.
dvec3 brute_nearest(const haptics::Plane& a, const haptics::Plane& b, const dvec3& d) {
    const auto wants = [](const haptics::Plane& p, const dvec3& x) {
        return p.offset_m - glm::dot(p.normal, x);
    };
    const double cosine = glm::dot(a.normal, b.normal), det = 1.0 - cosine * cosine;
    const double wa = wants(a, d), wb = wants(b, d);
    dvec3 best{0.0};
    double best_m = HUGE_VAL;
    for (const dvec3& x :
         {d, d + wa * a.normal, d + wb * b.normal,
          d + (wa - cosine * wb) / det * a.normal + (wb - cosine * wa) / det * b.normal})
        if (wants(a, x) < 1e-12 && wants(b, x) < 1e-12 && glm::length(x - d) < best_m) {
            best = x;
            best_m = glm::length(x - d);
        }
    return best;
}

} // namespace

TEST_CASE("safe tools: a shaft laid over a ridge is held there, the tip's force by the lever") {
    for (const double radius_m : {5e-4, 2.5e-3})
        for (const double turn_rad : {0.0, 0.4}) {
            Scene s = ridge(0.01, turn_rad);
            const dvec3 pivot_m{-0.1, 0, 0.03}, device_m{0.08, 0.0, -0.02};
            s.add(pivot_m, {0.08, 0, 0.03}, 0.0, radius_m);
            s.step();
            s.in[0].device_m = device_m;
            s.step(3000);
            const haptics::ToolState& t = s.tool(0);
            const dvec3 along{std::sin(turn_rad), std::cos(turn_rad), 0.0};
            const haptics::Plane plane =
                over_line(pivot_m, {0, 0, 0.01}, along, radius_m + t.hover_m);
            const double push_m = plane.offset_m - glm::dot(plane.normal, device_m);
            const dvec3 force_n = kStiffness_npm * push_m * plane.normal;
            CHECK(glm::length(t.force_n - force_n) < 1e-6 * glm::length(force_n));
            REQUIRE(t.contacts > 0);
            CHECK(t.contact[0].part == haptics::ToolPart::shaft);
            // moments about the pivot: the ridge's force at its lever, the hand's at the tip
            const double ridge_n = glm::length(t.force_n) / t.contact[0].lever;
            const dvec3 axis = t.tip_m - pivot_m;
            const dvec3 moment =
                glm::cross(t.contact[0].lever * axis, ridge_n * t.contact[0].normal) -
                glm::cross(axis, t.force_n);
            CHECK(glm::length(moment) < 1e-6 * glm::length(axis) * glm::length(t.force_n));
        }
}

TEST_CASE("safe tools: tip against a wall and shaft on a ridge at once are where both planes say") {
    std::mt19937_64 engine(2);
    std::uniform_real_distribution<double> random(-1.0, 1.0);
    double worst_m = 0.0;
    int both = 0;
    for (int run = 0; run < 50; ++run) {
        const double turn_rad = 0.5 * random(engine), wall_m = 0.05;
        Scene s = ridge(0.01, turn_rad);
        s.quad({wall_m, -0.3, -0.3}, {wall_m, 0.3, -0.3}, {wall_m, 0.3, 0.3}, {wall_m, -0.3, 0.3});
        const dvec3 pivot_m{-0.1, 0, 0.03};
        s.add(pivot_m, {0.03, 0, 0.03}, 3e-3, 1e-3);
        s.step();
        const dvec3 device_m{0.05 + 0.01 * random(engine), 0.01 * random(engine),
                             -0.01 + 0.01 * random(engine)};
        s.in[0].device_m = device_m;
        s.step(1500);
        const haptics::ToolState& t = s.tool(0);
        const haptics::Plane shaft = over_line(
            pivot_m, {0, 0, 0.01}, {std::sin(turn_rad), std::cos(turn_rad), 0.0}, 1e-3 + t.hover_m);
        const haptics::Plane wall{{-1, 0, 0}, -wall_m + 3e-3 + t.hover_m};
        worst_m = std::max(worst_m, glm::length(t.tip_m - brute_nearest(shaft, wall, device_m)));
        both += t.contacts >= 2;
    }
    CHECK(worst_m < 1e-6); // a hover is 2.6 um on triangles of 650 mm
    CHECK(both > 10);
}

TEST_CASE(
    "safe tools: without a shaft the tip rests where the ball proxy does, or in the next pit") {
    // their ways differ by what the ball proxy guesses; of two pits that decides now and then
    int same = 0;
    for (const double radius_m : {0.0, 1e-3}) {
        proxy_bench::Bench ball = proxy_bench::crumpled_ball(3);
        ball.input.radius_m = radius_m;
        Scene s;
        s.vertex = ball.vertex;
        s.triangle = ball.triangle;
        s.make("brute-force");
        s.add({0.3, 0, 0}, {0.03, 0, 0}, radius_m, 0.0);
        proxy_bench::Hand hand{std::mt19937_64(4)};
        for (int hold = 0; hold < 40; ++hold) {
            dvec3 device_m{};
            for (int i = 0; i < 300; ++i) {
                if (i < 100)
                    device_m = hand.next();
                ball.lead(haptics::step_safe_proxy, device_m);
                s.in[0].device_m = device_m;
                s.step();
            }
            same += glm::length(s.tool(0).tip_m - ball.state.proxy_m) < 1e-9;
        }
    }
    CHECK(same >= 76); // of 80
}

TEST_CASE("safe tools: a shaft dragged along itself keeps the friction cone") {
    Scene s = ridge(0.01, 0.0);
    s.add({-0.1, 0, 0.03}, {0.08, 0, 0.03}, 0.0, 1e-3);
    s.in[0].static_friction = 0.3;
    s.in[0].dynamic_friction = 0.3;
    double worst = 0.0, most = 0.0;
    for (int i = 0; i < 2000; ++i) {
        s.in[0].device_m = {0.08 + 0.02 * std::sin(4e-3 * i), 0.01 * std::sin(7e-3 * i),
                            std::max(0.03 - 1e-4 * i, -0.02)};
        s.step();
        const haptics::ToolState& t = s.tool(0);
        if (i < 600 || t.contacts == 0)
            continue;
        const dvec3 n = t.contact[0].normal;
        const double push_n = glm::dot(t.force_n, n);
        const double ratio = glm::length(t.force_n - push_n * n) / push_n;
        worst = std::max(worst, ratio - 0.3);
        most = std::max(most, ratio);
    }
    CHECK(worst < 0.01); // the normal turns within a tick
    CHECK(most > 0.29);
}

TEST_CASE("safe tools: metres or millimetres, here or a kilometre away: the same motion") {
    const auto run = [](double unit, double far) {
        Scene s = tool_bench::bumpy(5, 12, 0.04, 8e-3, "brute-force");
        const auto place = [&](const dvec3& p) { return unit * (p + dvec3{far, -far, far}); };
        for (dvec3& v : s.vertex)
            v = place(v);
        s.add(place({-0.06, 0, 0.03}), place({0.05, 0, 0.03}), 2e-3 * unit, 1e-3 * unit);
        s.in[0].stiffness_npm = kStiffness_npm / unit;
        tool_bench::Wander hand{
            std::mt19937_64(6), {0, -0.03, -0.01}, {0.05, 0.03, 0.02}, {0.05, 0, 0.03}};
        std::vector<dvec3> way;
        for (int i = 0; i < 1500; ++i) {
            s.in[0].device_m = place(hand.next());
            s.step();
            way.push_back(s.tool(0).force_n);
        }
        return way;
    };
    const std::vector<dvec3> here = run(1.0, 0.0), milli = run(1000.0, 0.0), far = run(1.0, 1000.0);
    double unit_n = 0.0, most_n = 0.0;
    int far_off = 0; // over a ridge a kilometre's rounding may make it slip a tick earlier or later
    for (std::size_t i = 0; i < here.size(); ++i) {
        unit_n = std::max(unit_n, glm::length(milli[i] - here[i]));
        far_off += glm::length(far[i] - here[i]) > 1e-3;
        most_n = std::max(most_n, glm::length(here[i]));
    }
    CHECK(most_n > 1.0);
    CHECK(unit_n < 1e-6);
    CHECK(far_off <= 15); // of 1500
}
