// tests/sim/tissue_loop_test.cpp
// One FEM step with tools, on the shipped liver: what touches pushes, what does not costs nothing.
#include "sim/loop/tissue_loop.h"

#include "sim/session/scene.h"
#include "tissue/solver/stress.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace {

constexpr double kRadius_m = 3e-3;

// Force of a rigid sphere on a half-space, by bisection on the contact radius (Sneddon 1965).
double sneddon_force_n(double depth_m, const tissue::Material& m) {
    double low = 0.0, high = kRadius_m * (1.0 - 1e-12);
    for (int i = 0; i < 100; ++i) {
        const double a = 0.5 * (low + high);
        (0.5 * a * std::log((kRadius_m + a) / (kRadius_m - a)) < depth_m ? low : high) = a;
    }
    const double log_term = std::log((kRadius_m + low) / (kRadius_m - low));
    return m.young_pa / (1.0 - m.poisson * m.poisson) *
           (0.5 * (low * low + kRadius_m * kRadius_m) * log_term - kRadius_m * low);
}

struct Bench {
    sim::LoadedScene loaded = sim::load_scene("basic");
    sim::TissueRig rig;
    std::unique_ptr<sim::TissueAnswer> answer = std::make_unique<sim::TissueAnswer>();
    sim::ToolsNow tools;
    haptics::SurfacePoint at;
    glm::dvec3 place, normal;

    explicit Bench(tissue::Tier tier = tissue::Tier::corotated) {
        sim::TissueConfig config;
        config.tier.assign(8, tier);
        rig = sim::make_tissue(loaded, {}, config);
        // the skin point nearest to the camera
        const sim::Body& liver = rig.bodies[0];
        at = sim::nearest_on(liver, {0.0, 0.0, 0.2}).at;
        place = sim::place_on(liver, at);
        normal = sim::normal_on(liver, at);
        for (int i = 0; i < sim::kTools; ++i)
            tools.tip[i] = {{0.0, 0.0, 1.0}, kRadius_m};
    }
    void put(int tool, double depth_m) {
        tools.tip[tool].centre_m = place + (kRadius_m - depth_m) * normal;
    }
    sim::StepOutcome step() {
        ++tools.tick;
        return sim::tissue_step(rig, tools, *answer);
    }
};

} // namespace

TEST_CASE("tissue loop: tools far away leave the organ at rest and no patch") {
    Bench bench;
    for (int i = 0; i < 3; ++i)
        bench.step();
    CHECK(bench.rig.bodies[0].soft->resting);
    for (const haptics::ToolPatch& tool : bench.answer->local.tool)
        CHECK_FALSE(tool.near);
}

TEST_CASE("tissue loop: a rest model exists before the first touch") {
    Bench bench;
    bench.put(0, -3e-3);
    bench.step();
    const haptics::ToolPatch& patch = bench.answer->local.tool[0];
    CHECK(patch.near);
    CHECK(patch.modes >= 5);
    CHECK(patch.vertices > 10);
    CHECK(bench.rig.contact[0].force_n == glm::dvec3{0.0});
    CHECK(bench.rig.bodies[0].soft->resting);
}

TEST_CASE("tissue loop: a pressed tool is pushed out along the normal, deeper means harder") {
    Bench bench;
    double last = 0.0;
    for (const double depth_m : {1e-3, 2e-3, 4e-3, 8e-3}) {
        bench.put(0, depth_m);
        sim::StepOutcome outcome;
        for (int i = 0; i < 100; ++i)
            outcome = bench.step();
        const glm::dvec3 f = bench.rig.contact[0].force_n;
        CHECK(glm::dot(f, bench.normal) > 0.95 * glm::length(f));
        CHECK(glm::length(f) > last);
        CHECK(outcome.linear_residual < 1e-9);
        CHECK(outcome.contact_residual_m < 1e-9);
        last = glm::length(f);
    }
    // an organ that can give way as a whole is softer than a half-space of its tissue, and not a
    // tenth of it
    const double half_space_n = sneddon_force_n(8e-3, bench.rig.bodies[0].material);
    CHECK(last < half_space_n);
    CHECK(last > 0.1 * half_space_n);
}

TEST_CASE("tissue loop: the peak stress is the pressed organ's, none of what rests") {
    Bench bench;
    CHECK(bench.step().peak_stress_pa == 0.0);
    bench.put(0, 5e-3);
    sim::StepOutcome outcome;
    for (int i = 0; i < 60; ++i)
        outcome = bench.step();
    const sim::SoftBody& soft = *bench.rig.bodies[0].soft;
    const auto& liver = std::get<tissue::CorotatedSolid>(soft.solid);
    std::vector<double> stress(liver.model.mesh.tets.size());
    tissue::von_mises_pa(liver.model, liver.state.position_m, stress);
    const double peak_pa = *std::max_element(stress.begin(), stress.end());
    CHECK(peak_pa > 0.01 * liver.model.material.young_pa);
    // a linearisation may be 20 um old: 0.2 % of strain
    CHECK(std::abs(outcome.peak_stress_pa - peak_pa) < 2e-3 * liver.model.material.young_pa);

    bench.tools.tip[0].centre_m = {0.0, 0.0, 1.0};
    for (int i = 0; i < 2000 && !soft.resting; ++i)
        outcome = bench.step();
    REQUIRE(soft.resting);
    CHECK(outcome.peak_stress_pa == 0.0);
}

TEST_CASE("tissue loop: after release the organ comes back to rest exactly where it was") {
    Bench bench;
    bench.put(0, 5e-3);
    for (int i = 0; i < 20; ++i)
        bench.step();
    CHECK_FALSE(bench.rig.bodies[0].soft->resting);
    bench.tools.tip[0].centre_m = {0.0, 0.0, 1.0};
    for (int i = 0; i < 2000 && !bench.rig.bodies[0].soft->resting; ++i)
        bench.step();
    CHECK(bench.rig.bodies[0].soft->resting);
    CHECK(glm::distance(sim::place_on(bench.rig.bodies[0], bench.at), bench.place) < 1e-6);
}

TEST_CASE("tissue loop: whatever the lever, no contact feels stiffer than the device can hold") {
    // J^T Kc J with Kc = 1 / floor: its largest eigenvalue, by power iteration, is at most 2b/T x
    // 0.8
    const haptics::Trocar trocar{.fulcrum_m = {0.02, -0.01, 0.15}};
    double most = 0.0;
    for (const glm::dvec3& handle : {glm::dvec3{0.05, 0.02, 0.45}, glm::dvec3{0.02, -0.01, 0.25},
                                     glm::dvec3{-0.1, 0.15, 0.2}, glm::dvec3{0.03, 0, 0.2}}) {
        const haptics::ShaftPose pose = haptics::shaft_pose(trocar, handle);
        const double stiffness_npm = 1.0 / sim::coupling_floor_mpn(pose, 800.0);
        const glm::dmat3 felt = stiffness_npm * glm::transpose(pose.jacobian) * pose.jacobian;
        glm::dvec3 v{0.3, 0.5, 0.8};
        for (int i = 0; i < 200; ++i)
            v = glm::normalize(felt * v);
        const double largest_npm = glm::length(felt * v);
        CHECK(largest_npm <= 800.0 * (1.0 + 1e-9));
        most = std::max(most, largest_npm);
    }
    CHECK(most > 0.99 * 800.0); // and it is not simply soft
}

TEST_CASE("tissue loop: two tools on one organ share its modes and feel each other") {
    Bench alone, both;
    alone.put(0, 4e-3);
    both.put(0, 4e-3);
    both.put(1, 4e-3);
    const sim::Body& liver = both.rig.bodies[0];
    const auto beside = sim::nearest_on(liver, both.place + glm::dvec3{15e-3, 0.0, 0.0}).at;
    both.tools.tip[1].centre_m =
        sim::place_on(liver, beside) + (kRadius_m - 4e-3) * sim::normal_on(liver, beside);
    for (int i = 0; i < 60; ++i) {
        alone.step();
        both.step();
    }
    const auto& local = both.answer->local;
    CHECK(local.tool[0].first_mode == local.tool[1].first_mode);
    CHECK(local.tool[0].modes == local.tool[1].modes);
    CHECK(local.modes > alone.answer->local.modes);
    // the neighbour's dimple takes load off the first tool
    CHECK(glm::length(both.rig.contact[0].force_n) < glm::length(alone.rig.contact[0].force_n));
}

TEST_CASE("tissue loop: of tools that slide over tissue, one in a step gets new columns") {
    struct Hand {
        tissue::Tier tier;
        double deeper_m;
    };
    for (const Hand& hand :
         {Hand{tissue::Tier::corotated, 0.0}, Hand{tissue::Tier::corotated, 0.01},
          Hand{tissue::Tier::quadratic, 0.0}}) {
        Bench bench(hand.tier);
        const glm::dvec3 across = glm::normalize(glm::cross(bench.normal, {1.0, 0.3, 0.2}));
        const glm::dvec3 along = glm::cross(bench.normal, across);
        const sim::SoftBody& soft = *bench.rig.bodies[0].soft;
        std::array<int, 34> steps{}; // by columns solved for
        for (int step = 0; step < 60; ++step) {
            for (int tool = 0; tool < sim::kTools; ++tool) {
                bench.put(tool, 2e-3 + 0.5 * hand.deeper_m * (1.0 - std::cos(0.3 * step)));
                bench.tools.tip[tool].centre_m +=
                    (0.012 * tool - 0.012) * across + 3e-4 * step * along;
            }
            bench.step();
            ++steps[soft.basis.solved];
            CHECK(soft.basis.modes == 33);
        }
        CAPTURE(hand.tier);
        CHECK(steps[33] == 1); // the first, without any known
        CHECK(steps[11] > 10);
        CHECK(steps[0] > 10);
        CHECK(steps[33] + steps[11] + steps[0] == 60);
    }
}
