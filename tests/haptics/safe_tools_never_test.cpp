// tests/haptics/safe_tools_never_test.cpp
// What must never happen to tools: inside a triangle, through a membrane, through each other.
#include "tests/haptics/effort.h"
#include "tests/haptics/tool_bench.h"

#include <doctest/doctest.h>
#include <limits>

// What whole instruments must never do: pass a triangle or each other, jump, fall with another.

namespace {

using glm::dvec3;
using tool_bench::Scene;
using tool_bench::Wander;

// Breathing by 5 mm, in frames of a 60th of a second.
void breathe(Scene& s, const std::vector<dvec3>& rest, int tick) {
    s.before.clear();
    if (tick * 60 / 1000 == (tick - 1) * 60 / 1000)
        return;
    s.before = s.vertex;
    const double lift_m = 5e-3 * std::sin(6.2831853 * 0.3 * 1e-3 * tick);
    for (std::size_t i = 0; i < rest.size(); ++i)
        s.vertex[i].z =
            rest[i].z + lift_m * std::cos(30.0 * rest[i].x) * std::cos(20.0 * rest[i].y);
    haptics::refit(s.index, s.mesh());
}

struct Dragged {
    double least_m = HUGE_VAL; // clearance
    double most_step_n = 0.0;  // beyond the hand's own
    int touched = 0;
};

Dragged drag(double radius_m, double tip_radius_m, bool breathing, int ticks, std::uint64_t seed) {
    Scene s = tool_bench::bumpy(seed, 16, 0.04, 8e-3);
    const std::vector<dvec3> rest = s.vertex;
    s.add({-0.06, 0, 0.035}, {0.03, 0, 0.035}, tip_radius_m, radius_m);
    Wander hand{
        std::mt19937_64(seed), {-0.02, -0.035, -0.02}, {0.05, 0.035, 0.02}, {0.03, 0, 0.035}};
    Dragged out;
    dvec3 last_n{0.0}, last_m = s.in[0].device_m;
    for (int i = 0; i < ticks; ++i) {
        if (breathing)
            breathe(s, rest, i);
        s.in[0].device_m = hand.next();
        s.step();
        out.least_m = std::min(out.least_m, tool_bench::clear_m(s, 0));
        out.touched += s.tool(0).touching;
        const double own_n = 500.0 * glm::length(s.in[0].device_m - last_m);
        out.most_step_n =
            std::max(out.most_step_n, glm::length(s.tool(0).force_n - last_n) - 2.0 * own_n);
        last_n = s.tool(0).force_n;
        last_m = s.in[0].device_m;
    }
    return out;
}

Scene crossed(double radius_m) {
    Scene s = tool_bench::empty();
    s.add({-0.1, 0, 0}, {0.08, 0, 0}, 0.0, radius_m);
    s.add({0, -0.1, 0.01}, {0, 0.08, 0.01}, 0.0, radius_m);
    return s;
}

double tools_apart_m(const Scene& s, int a, int b) {
    const haptics::ToolState &i = s.tool(a), &j = s.tool(b);
    return tool_bench::segments_apart_m(i.shape.pivot_m, i.tip_m, j.shape.pivot_m, j.tip_m) -
           i.shape.shaft_radius_m - j.shape.shaft_radius_m;
}

} // namespace

TEST_CASE("safe tools: a shaft dragged over bumps never has a triangle inside") {
    for (const double radius_m : {5e-4, 2.5e-3})
        for (const double tip_radius_m : {0.0, 3e-3}) {
            const Dragged d = drag(radius_m, tip_radius_m, false, effort::cases(6000), 7);
            CHECK(d.least_m > 0.0);
            CHECK(d.touched > effort::cases(1000));
            CHECK(d.most_step_n < 0.3);
        }
}

TEST_CASE("safe tools: nor if the bumps breathe") {
    for (const double radius_m : {5e-4, 2.5e-3})
        for (const double tip_radius_m : {0.0, 3e-3}) {
            const Dragged d = drag(radius_m, tip_radius_m, true, effort::cases(6000), 8);
            CHECK(d.least_m > 0.0);
            CHECK(d.touched > effort::cases(1000));
        }
}

TEST_CASE("safe tools: a shaft does not pass a membrane in ten thousand crossings") {
    Scene s;
    s.quad({-0.3, -0.3, 0}, {0.3, -0.3, 0}, {0.3, 0.3, 0}, {-0.3, 0.3, 0});
    s.add({-0.1, 0, 0.02}, {0.05, 0, 0.02}, 0.0, 1e-3);
    Wander random{std::mt19937_64(9), dvec3{0.0}, dvec3{0.0}, dvec3{0.0}};
    s.step();
    int passed = 0, below = 0;
    for (int i = 0; i < effort::cases(10000); ++i) {
        // from anywhere to anywhere on the other side, in one tick
        s.in[0].device_m = {random.between(-0.05, 0.1), random.between(-0.1, 0.1),
                            (i % 2 ? 1.0 : -1.0) * random.between(0.0, 0.05)};
        s.step();
        passed += !(s.tool(0).tip_m.z > 1e-3);
        below += s.tool(0).touching;
    }
    CHECK(passed == 0);
    CHECK(below > effort::cases(4000));
}

TEST_CASE("safe tools: crossed shafts pressed together rest with forces equal and opposite") {
    for (const double stiffer : {1.0, 3.0}) {
        Scene s = crossed(2.5e-3);
        s.in[1].stiffness_npm = stiffer * 500.0;
        s.step();
        s.in[0].device_m = {0.08, 0.01, 0.02};
        s.in[1].device_m = {0.01, 0.05, -0.01};
        s.step(2000);
        REQUIRE(s.tool(0).contacts == 1);
        REQUIRE(s.tool(1).contacts == 1);
        const auto contact_n = [&](int i) {
            const haptics::ToolTouch& c = s.tool(i).contact[0];
            return glm::dot(s.tool(i).force_n, c.normal) / c.lever;
        };
        CHECK(glm::length(s.tool(0).contact[0].normal + s.tool(1).contact[0].normal) < 1e-3);
        CHECK(contact_n(0) > 1.0);
        CHECK(std::abs(contact_n(0) / contact_n(1) - 1.0) < 0.02);
    }
}

TEST_CASE("safe tools: shafts pressed together never pass through each other") {
    for (const double radius_m : {1e-3, 2.5e-3}) {
        Scene s = crossed(radius_m);
        Wander a{std::mt19937_64(10), {0.06, -0.03, -0.02}, {0.09, 0.03, 0.04}, {0.08, 0, 0}};
        Wander b{std::mt19937_64(11), {-0.03, 0.06, -0.04}, {0.03, 0.09, 0.02}, {0, 0.08, 0.01}};
        double least_m = HUGE_VAL;
        int pressed = 0;
        for (int i = 0; i < effort::cases(10000); ++i) {
            s.in[0].device_m = a.next();
            s.in[1].device_m = b.next();
            s.step();
            least_m = std::min(least_m, tools_apart_m(s, 0, 1));
            pressed += s.tool(0).touching && s.tool(1).touching;
        }
        CHECK(least_m > 0.0);
        CHECK(pressed > effort::cases(1000));
    }
}

TEST_CASE("safe tools: three tools in one corner stay apart, out of the walls, and do not jump") {
    Scene s;
    s.quad({0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0});
    s.quad({0, 0, 0}, {0, 0.1, 0}, {0, 0.1, 0.1}, {0, 0, 0.1});
    s.quad({0, 0, 0}, {0, 0, 0.1}, {0.1, 0, 0.1}, {0.1, 0, 0});
    s.add({0.09, 0.03, 0.09}, {0.04, 0.02, 0.04}, 3e-3, 2e-3);
    s.add({0.03, 0.09, 0.09}, {0.02, 0.04, 0.05}, 3e-3, 2e-3);
    s.add({0.09, 0.09, 0.03}, {0.04, 0.04, 0.02}, 3e-3, 2e-3);
    std::vector<Wander> hand;
    for (std::uint64_t i = 0; i < 3; ++i)
        hand.push_back({std::mt19937_64(20 + i), dvec3{-0.01}, dvec3{0.03}, s.in[i].device_m});
    double least_m = HUGE_VAL, most_n = 0.0;
    bool finite = true;
    for (int i = 0; i < 6000; ++i) {
        std::array<dvec3, 3> last_n, own_m;
        double hands_m = 0.0;
        for (int t = 0; t < 3; ++t) {
            last_n[t] = s.tool(t).force_n;
            own_m[t] = s.in[t].device_m;
            s.in[t].device_m = hand[t].next();
            hands_m += glm::length(s.in[t].device_m - own_m[t]);
        }
        s.step();
        for (int t = 0; t < 3; ++t) {
            const dvec3 force_n = s.tool(t).force_n;
            finite = finite && std::isfinite(force_n.x + force_n.y + force_n.z);
            most_n = std::max(most_n, glm::length(force_n - last_n[t]) - 500.0 * 6.0 * hands_m);
            least_m =
                std::min({least_m, tool_bench::clear_m(s, t), tools_apart_m(s, t, (t + 1) % 3)});
        }
    }
    CHECK(finite);
    CHECK(least_m > 0.0);
    CHECK(most_n < 0.3);
}

TEST_CASE("safe tools: a tool that is not finite feels nothing and the others go on") {
    const auto run = [](bool broken) {
        Scene s = tool_bench::bumpy(12, 12, 0.04, 8e-3);
        s.add({-0.06, 0, 0.035}, {0.03, 0, 0.035}, 0.0, 1e-3);
        s.add({-0.06, 0, 0.2}, {0.03, 0, 0.2}, 0.0, 1e-3);
        s.step(2);
        s.in[0].device_m = {0.03, 0.0, -0.01};
        if (broken) {
            s.in[1].device_m.y = std::numeric_limits<double>::quiet_NaN();
            s.in[1].shape.pivot_m.x = std::numeric_limits<double>::infinity();
        }
        s.step(200);
        CHECK(s.tool(1).force_n == dvec3{0.0});
        CHECK(s.tool(1).tip_m == dvec3{0.03, 0, 0.2});
        return s.tool(0).force_n;
    };
    CHECK(glm::length(run(false)) > 1.0);
    CHECK(run(true) == run(false));
}
