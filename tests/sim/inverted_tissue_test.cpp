// tests/sim/inverted_tissue_test.cpp
// The tissue loop with inverted tetrahedra under a pressing tool: it recovers, and says how.
#include "sim/loop/tissue_loop.h"

#include "sim/session/scene.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>

namespace {

constexpr double kRadius_m = 3e-3, kDepth_m = 2e-3;

// The shipped liver, pressed by one tool.
struct Pressed {
    sim::LoadedScene loaded = sim::load_scene("basic");
    sim::TissueRig rig = sim::make_tissue(loaded, {}, {});
    std::unique_ptr<sim::TissueAnswer> answer = std::make_unique<sim::TissueAnswer>();
    sim::ToolsNow tools;
    glm::dvec3 place, normal;

    Pressed() {
        const haptics::SurfacePoint at = sim::nearest_on(rig.bodies[0], {0.0, 0.0, 0.2}).at;
        place = sim::place_on(rig.bodies[0], at);
        normal = sim::normal_on(rig.bodies[0], at);
        rig.bodies[0].material.friction = 0.0; // with it, the rest would depend on the way there
        for (haptics::ToolTip& tip : tools.tip)
            tip = {{0.0, 0.0, 1.0}, kRadius_m};
        tools.tip[0].centre_m = place + (kRadius_m - kDepth_m) * normal;
        for (int i = 0; i < 100; ++i)
            step();
    }
    tissue::CorotatedSolid& liver() {
        return std::get<tissue::CorotatedSolid>(rig.bodies[0].soft->solid);
    }
    sim::StepOutcome step() {
        ++tools.tick;
        return sim::tissue_step(rig, tools, *answer);
    }
    glm::dvec3 force_n() const { return rig.contact[0].force_n; }
};

// Throws the nodes below the tool about. Returns how many tets that inverts.
int tangle(Pressed& bench) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> coordinate(-2e-2, 2e-2);
    tissue::CorotatedSolid& soft = bench.liver();
    const glm::dvec3 middle_m = bench.place - 15e-3 * bench.normal;
    for (std::size_t i = 0; i < soft.state.position_m.size(); ++i) {
        if (soft.model.dof[i] < 0 || glm::distance(soft.model.mesh.rest_m[i], middle_m) > 14e-3)
            continue;
        const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
        soft.state.position_m[i] = middle_m + glm::dvec3{x, y, z};
    }
    tissue::linearize(soft.model, soft.state, bench.rig.config.step_s, soft.system);
    bench.rig.bodies[0].soft->resting = false;
    return soft.system.inverted;
}

} // namespace

TEST_CASE("tissue loop: inverted under a pressing tool, the liver comes back to the same rest") {
    Pressed calm, torn;
    REQUIRE(glm::length(calm.force_n()) > 0.0);
    REQUIRE(tangle(torn) > 10);
    int most = 0;
    for (int i = 0; i < 300; ++i) { // 3 s: the liver sways at 4 Hz on its bed
        CHECK(calm.step().iterations == 0);
        const sim::StepOutcome outcome = torn.step();
        most = std::max(most, outcome.iterations);
        CHECK(outcome.contact_residual_m < 1e-9);
    }
    CHECK(most > 0);
    CHECK(most <= tissue::kMaxDescent);
    CHECK(torn.liver().system.inverted == 0);
    // both solve the same contact on the same mesh: what is left is the swaying
    CHECK(glm::length(torn.force_n() - calm.force_n()) < 0.01 * glm::length(calm.force_n()));
    double apart_m = 0.0;
    for (std::size_t i = 0; i < calm.liver().state.position_m.size(); ++i)
        apart_m = std::max(apart_m, glm::distance(calm.liver().state.position_m[i],
                                                  torn.liver().state.position_m[i]));
    CHECK(apart_m < 0.05 * kDepth_m);
}

TEST_CASE("tissue loop: a body that recovers is watched until it rests, then no more") {
    Pressed bench;
    bench.tools.tip[0].centre_m = {0.0, 0.0, 1.0};
    REQUIRE(tangle(bench) > 10);
    bench.step();
    CHECK(bench.liver().state.recovering);
    int steps = 0;
    while (!bench.rig.bodies[0].soft->resting && ++steps < 3000)
        bench.step();
    CHECK(bench.rig.bodies[0].soft->resting);
    CHECK(bench.liver().system.inverted == 0);
    CHECK_FALSE(bench.liver().state.recovering);
    for (std::size_t i = 0; i < bench.liver().state.position_m.size(); ++i)
        CHECK(glm::distance(bench.liver().state.position_m[i], bench.liver().model.mesh.rest_m[i]) <
              1e-4);
}
