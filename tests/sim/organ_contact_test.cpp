// tests/sim/organ_contact_test.cpp
// Organs that meet: what lies on what pushes with its weight, nothing sinks in, and what is pressed
// passes on what it is pressed with.
#include "tests/sim/organ_bench.h"

namespace {

using namespace organ_tests;

constexpr double kDeepest_m = 0.5e-3;

// Steps until everything soft rests; the deepest that anything was on the way.
double until_rest(Bench& bench, int most) {
    double deepest_m = 0.0;
    for (int i = 0; i < most; ++i) {
        bench.step();
        deepest_m = std::max(deepest_m, bench.depth_m());
        bool rest = true;
        for (const sim::Body& body : bench.rig.bodies)
            rest &= !body.soft || body.soft->resting;
        if (rest)
            return deepest_m;
    }
    FAIL("it does not come to rest");
    return deepest_m;
}

double steps_deepest_m(Bench& bench, int steps) {
    double deepest_m = 0.0;
    for (int i = 0; i < steps; ++i) {
        bench.step();
        deepest_m = std::max(deepest_m, bench.depth_m());
    }
    return deepest_m;
}

// The first tool goes down in the middle of what is there at 40 mm/s, then stays.
double press(Bench& bench, double top_m, double depth_m, int then) {
    const double step_m = 0.04 * bench.rig.config.step_s;
    double deepest_m = 0.0;
    for (double down_m = -1e-3; down_m < depth_m; down_m += step_m) {
        bench.tools.tip[0].centre_m = {0.0, 0.0, top_m + kRadius_m - down_m};
        deepest_m = std::max(deepest_m, steps_deepest_m(bench, 1));
    }
    return std::max(deepest_m, steps_deepest_m(bench, then));
}

} // namespace

TEST_CASE("organs: a block that falls on a floor comes to rest there and weighs what it weighs") {
    for (const tissue::Tier tier : kSoft) {
        CAPTURE(tissue::name_of(tier));
        const Block block{.low_m = {-0.02, -0.02, 5e-3}};
        Bench bench(on_floor({block}, tier));
        // linear elasticity is for what is held: what turns on a floor without friction never rests
        CHECK((tier == tissue::Tier::linear ? steps_deepest_m(bench, 100)
                                            : until_rest(bench, 600)) < kDeepest_m);
        CHECK(bench.push_n(0).z == doctest::Approx(weight_n(block)).epsilon(0.01));
        CHECK(std::abs(bench.push_n(0).x) < 1e-3 * weight_n(block));
    }
}

TEST_CASE("organs: what rests on a floor costs nothing and stays where it is, to the bit") {
    const Block block{.low_m = {-0.02, -0.02, 1e-3}};
    Bench bench(on_floor({block}, tissue::Tier::corotated));
    until_rest(bench, 600);
    bench.step(2); // its skin's last motion is looked at once more
    const std::int64_t solves = bench.rig.organs->solves;
    const std::size_t looked = bench.rig.organs->rows.looked;
    const std::vector<glm::dvec3> was = bench.rig.bodies[0].skin_m;
    bench.step(100);
    CHECK(bench.rig.organs->solves == solves);
    CHECK(bench.rig.organs->rows.looked == looked);
    CHECK(bench.rig.bodies[0].skin_m == was);
    CHECK(bench.push_n(0).z == doctest::Approx(weight_n(block)).epsilon(0.01));
}

TEST_CASE("organs: of two blocks on each other each carries what is above it") {
    for (const tissue::Tier tier : kSoft) {
        CAPTURE(tissue::name_of(tier));
        const Block below{.low_m = {-0.02, -0.02, 1e-3}};
        const Block above{.low_m = {-0.015, -0.015, 43e-3}, .size_m = {0.03, 0.03, 0.03}};
        Bench bench(on_floor({below, above}, tier));
        CHECK(steps_deepest_m(bench, 60) < kDeepest_m);
        // without friction the upper one slides on, slowly: its weight is there all the same
        CHECK(bench.push_n(1).z == doctest::Approx(weight_n(above)).epsilon(0.01));
        CHECK(bench.push_n(0).z == doctest::Approx(weight_n(below)).epsilon(0.01));
    }
}

TEST_CASE("organs: a block that lies over an edge topples off it, and is in nothing on the way") {
    for (const tissue::Tier tier : {tissue::Tier::corotated, tissue::Tier::quadratic}) {
        CAPTURE(tissue::name_of(tier));
        const Block step{.low_m = {-0.04, -0.02, 1e-3}, .held_below = true};
        const Block upper{
            .low_m = {-0.014, -0.01, 42e-3}, .size_m = {0.045, 0.02, 0.02}, .cells = {5, 2, 2}};
        Bench bench(on_floor({step, upper}, tier));
        // an edge lands at 0.6 m/s, and quadratic shapes take Newton's steps once contact has
        // placed it
        const double most_m = tier == tissue::Tier::quadratic ? 0.6e-3 : 0.1e-3;
        CHECK(steps_deepest_m(bench, 60) < most_m);
        double low_m = 1.0;
        for (const glm::dvec3& x : bench.rig.bodies[1].skin_m)
            low_m = std::min(low_m, x.z);
        CHECK(low_m < 20e-3); // it has fallen over
    }
}

TEST_CASE("organs: a tool presses through a block on the floor, which carries tool and weight") {
    for (const tissue::Tier tier : kSoft) {
        CAPTURE(tissue::name_of(tier));
        const Block block{.low_m = {-0.02, -0.02, 0.2e-3}};
        Bench bench(on_floor({block}, tier));
        bench.step(100);
        const double top_m = bench.top_m(0);
        const double deepest_m = press(bench, top_m, 4e-3, 60);
        CHECK(deepest_m < kDeepest_m);
        const double tool_n = bench.rig.contact[0].force_n.z;
        CHECK(tool_n > 0.05);
        CHECK(bench.push_n(0).z == doctest::Approx(tool_n + weight_n(block)).epsilon(0.02));
    }
}

TEST_CASE("organs: pressed on another organ, one passes on tool and weight, at 10 and at 20 ms") {
    for (const tissue::Tier tier : kSoft) {
        for (const double step_s : {0.01, 0.02}) {
            CAPTURE(tissue::name_of(tier));
            CAPTURE(step_s);
            const Block bed{.low_m = {-0.03, -0.03, 1e-3},
                            .size_m = {0.06, 0.06, 0.03},
                            .cells = {5, 5, 3},
                            .held_below = true,
                            .heavy = false};
            const Block upper{
                .low_m = {-0.02, -0.02, 31.2e-3}, .size_m = {0.04, 0.04, 0.03}, .cells = {4, 4, 3}};
            Bench bench(on_floor({bed, upper}, tier, step_s), step_s);
            bench.step(60);
            const double deepest_m = press(bench, bench.top_m(1), 4e-3, 60);
            CHECK(deepest_m < kDeepest_m);
            const double tool_n = bench.rig.contact[0].force_n.z;
            CHECK(tool_n > 0.05);
            CHECK(bench.push_n(1).z == doctest::Approx(tool_n + weight_n(upper)).epsilon(0.02));
        }
    }
}

TEST_CASE("organs: two that fly into each other keep their momentum") {
    const Block one{.low_m = {-0.021, 0.0, 0.3}, .size_m = {0.02, 0.03, 0.03}, .heavy = false};
    Block other = one;
    other.low_m.x = 1e-3;
    std::vector<sim::Body> bodies;
    for (const Block& block : {one, other})
        bodies.push_back(make_block(block, tissue::Tier::corotated, 0.01, 0.0));
    Bench bench(std::move(bodies));
    const auto state_of = [&](std::size_t b) -> tissue::CorotatedSolid& {
        return std::get<tissue::CorotatedSolid>(bench.rig.bodies[b].soft->solid);
    };
    const auto momentum_ns = [&](std::size_t b) {
        double sum = 0.0;
        const tissue::CorotatedSolid& solid = state_of(b);
        for (std::size_t i = 0; i < solid.model.mass_kg.size(); ++i)
            sum += solid.model.mass_kg[i] * solid.state.velocity_mps[i].x;
        return sum;
    };
    for (glm::dvec3& v : state_of(0).state.velocity_mps)
        v.x = 0.1;
    for (sim::Body& body : bench.rig.bodies)
        body.soft->resting = false;
    const double before_ns = momentum_ns(0) + momentum_ns(1);
    CHECK(steps_deepest_m(bench, 20) < kDeepest_m);
    // end_step leaves a thousandth of its forces at most
    CHECK(momentum_ns(0) + momentum_ns(1) == doctest::Approx(before_ns).epsilon(5e-3));
    CHECK(momentum_ns(1) > 0.3 * before_ns);
}

TEST_CASE("organs: what was baked into another pushes nothing at rest, and no deeper than that") {
    const Block bed{.low_m = {-0.03, -0.03, 1e-3},
                    .size_m = {0.06, 0.06, 0.03},
                    .cells = {5, 5, 3},
                    .held_below = true,
                    .heavy = false};
    const Block sunk{.low_m = {-0.02, -0.02, 30e-3}, // 1 mm deep
                     .size_m = {0.04, 0.04, 0.03},
                     .cells = {4, 4, 3},
                     .heavy = false};
    Bench bench(on_floor({bed, sunk}, tissue::Tier::corotated));
    bench.rig.bodies[1].soft->resting = false; // it may move if it wants to
    bench.step(80);
    CHECK(bench.rests(1));
    CHECK(bench.push_n(1) == glm::dvec3{0.0});
    CHECK(bench.depth_m(1, 0) == doctest::Approx(1e-3).epsilon(1e-6));
    press(bench, bench.top_m(1), 4e-3, 60);
    CHECK(bench.push_n(1).z == doctest::Approx(bench.rig.contact[0].force_n.z).epsilon(0.02));
    CHECK(bench.depth_m(1, 0) < 1e-3 + kDeepest_m);
}

TEST_CASE("organs: far from each other they cost no solve and change no bit") {
    const Block one{.low_m = {-0.05, -0.02, 0.1}, .held_below = true};
    Block other = one;
    other.low_m.x = 0.02;
    Bench meet(on_floor({one, other}, tissue::Tier::corotated));
    Bench pass(on_floor({one, other}, tissue::Tier::corotated), 0.01, false);
    for (int i = 0; i < 40; ++i) {
        for (Bench* bench : {&meet, &pass}) {
            bench->tools.tip[0].centre_m = {-0.03, 0.0, 0.1415 - 1e-4 * i};
            bench->step();
        }
    }
    CHECK(meet.rig.contact[0].force_n != glm::dvec3{0.0});
    CHECK(meet.rig.organs->solves == 0);
    for (std::size_t b = 0; b < 2; ++b)
        CHECK(meet.rig.bodies[b].skin_m == pass.rig.bodies[b].skin_m);
}

TEST_CASE("organs: the same again is the same to the bit") {
    for (const tissue::Tier tier : kSoft) {
        CAPTURE(tissue::name_of(tier));
        std::vector<std::vector<glm::dvec3>> skin;
        for (int run = 0; run < 2; ++run) {
            const Block below{.low_m = {-0.02, -0.02, 1e-3}};
            const Block above{.low_m = {-0.01, -0.01, 42e-3}, .size_m = {0.03, 0.03, 0.03}};
            Bench bench(on_floor({below, above}, tier));
            bench.step(15);
            press(bench, bench.top_m(1), 2e-3, 5);
            skin.push_back(bench.rig.bodies[1].skin_m);
        }
        CHECK(skin[0] == skin[1]);
    }
}

TEST_CASE("organs: a tool on one of two that rest on each other wakes both") {
    const Block bed{.low_m = {-0.03, -0.03, 1e-3},
                    .size_m = {0.06, 0.06, 0.03},
                    .cells = {5, 5, 3},
                    .held_below = true};
    const Block upper{.low_m = {-0.04, -0.02, 31.1e-3},
                      .size_m = {0.05, 0.04, 0.02},
                      .cells = {5, 4, 2},
                      .held_left = true};
    Bench bench(on_floor({bed, upper}, tissue::Tier::corotated));
    until_rest(bench, 600);
    REQUIRE(bench.push_n(1).z > 0.0);
    press(bench, bench.top_m(1), 2e-3, 1);
    CHECK_FALSE(bench.rests(0));
    CHECK_FALSE(bench.rests(1));
}
