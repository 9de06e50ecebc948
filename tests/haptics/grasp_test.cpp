#include "haptics/contact/grasp.h"

#include "haptics/contact/coupling.h"
#include "haptics/contact/model_step.h"
#include "tests/haptics/hand_made_models.h"
#include "tests/haptics/sneddon_table.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

namespace {

using haptics::ContactMemory;
using haptics::JawConfig;
using haptics::JawGrip;
using haptics::kTools;
using haptics::LocalModels;
using haptics::RunningModel;
using haptics::ToolTip;
using Tips = std::array<ToolTip, kTools>;

constexpr double kTick_s = 1e-3;
constexpr double kTipRadius_m = 3e-3;
constexpr double kFloor_mpn = 1.0 / 800.0;
constexpr double kSpring_npm = 200.0; // of the slab, in each direction
constexpr double kMass_kg = 0.02;

const haptics::IndenterTable& table() {
    static const haptics::IndenterTable t = sneddon_table(SneddonSphere{});
    return t;
}

// A flat slab that moves as a whole, on equal springs in all directions, well damped.
struct Slab {
    std::unique_ptr<LocalModels> models = empty_models();
    RunningModel run;
    JawGrip grip;
    JawConfig jaws;
    double jaw = 0.0;
    std::int64_t tick = 0;

    explicit Slab(bool rigid = false) {
        models->sample_tick = -1;
        models->modes = 3;
        haptics::ToolPatch& patch = models->tool[0];
        make_flat_patch(patch, {0, 0, 0}, 0.04, 8);
        patch.modes = 3;
        patch.friction = 0.3;
        patch.table = rigid ? nullptr : &table();
        patch.floor_mpn = kFloor_mpn;
        for (int m = 0; m < 3; ++m) {
            models->lambda[m] = kSpring_npm / kMass_kg;
            models->damping[m] = 80.0;
            glm::dvec3 axis{0.0};
            axis[m] = 1.0 / std::sqrt(kMass_kg);
            set_uniform_mode(patch, m, axis);
        }
        run = {.answer = models.get(), .tick = -1};
        run.contact[0] = patch.contact;
    }
    haptics::StepResult step(const glm::dvec3& tip_m) {
        grip = haptics::next_grip(jaws, grip, jaw, tip_m);
        Tips tips;
        tips[0] = {tip_m, kTipRadius_m, grip};
        return haptics::step_model(run, kTick_s, tips);
    }
    haptics::StepResult rest(const glm::dvec3& tip_m, int ticks) {
        haptics::StepResult last;
        for (int i = 0; i < ticks; ++i)
            last = step(tip_m);
        return last;
    }
    glm::dvec3 force_n() const { return run.force_n[0]; }
    glm::dvec3 moved_m() const {
        return glm::dvec3{run.q[0], run.q[1], run.q[2]} / std::sqrt(kMass_kg);
    }
    glm::dvec3 rest_place_m() const { // of the material point
        const haptics::ToolPatch& patch = models->tool[0];
        glm::dvec3 p{0.0};
        for (int k = 0; k < 3; ++k)
            p += run.contact[0].weight[k] *
                 patch.vertex[patch.triangle[run.contact[0].triangle].vertex[k]].anchor_m;
        return p;
    }
    // kinetic, of the springs, and of the grasp
    double energy_j() const {
        double e = 0.0;
        for (int m = 0; m < 3; ++m)
            e += 0.5 * run.rate[m] * run.rate[m] + 0.5 * models->lambda[m] * run.q[m] * run.q[m];
        return e;
    }
};

const glm::dvec3 kTouching{0, 0, kTipRadius_m - 1e-3};

// Pressed 1 mm, closed, then drawn `reach_m` along `direction`.
Slab pulled(double jaw, const glm::dvec3& direction, double reach_m, int ticks) {
    Slab slab;
    slab.rest(kTouching, 100);
    slab.jaw = jaw;
    slab.rest(kTouching, 1);
    for (int i = 1; i <= ticks; ++i)
        slab.step(kTouching + direction * (reach_m * i / ticks));
    return slab;
}

} // namespace

TEST_CASE("grasp: jaws hold above 0.7, let go below 0.4, and their grip follows the closure") {
    const JawConfig config;
    JawGrip grip;
    const auto at = [&](double jaw) {
        grip = haptics::next_grip(config, grip, jaw, {jaw, 0, 0});
        return grip.hold_n;
    };
    CHECK(at(0.69) == 0.0);
    CHECK(at(0.71) == doctest::Approx(0.6 * 4.0 * (0.71 - 0.4) / 0.6).scale(0.0));
    CHECK(grip.closing == 1);
    CHECK(at(1.0) == doctest::Approx(2.4).scale(0.0));
    CHECK(at(7.0) == doctest::Approx(2.4).scale(0.0));
    CHECK(at(0.41) > 0.0);
    CHECK(grip.closing == 1);
    CHECK(grip.closed_at_m.x == 0.71);
    CHECK(at(0.4) == 0.0);
    CHECK(at(0.69) == 0.0);
    CHECK(at(0.8) > 0.0);
    CHECK(grip.closing == 2);
    CHECK(at(std::numeric_limits<double>::quiet_NaN()) == 0.0);
    CHECK(at(-std::numeric_limits<double>::infinity()) == 0.0);
    CHECK(at(std::numeric_limits<double>::infinity()) == doctest::Approx(2.4).scale(0.0));
    const JawConfig probe{.grip_n = 0.0};
    CHECK(haptics::next_grip(probe, {}, 1.0, {}).closing == 0);
}

TEST_CASE("grasp: pull_minimum satisfies its optimality conditions") {
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    int slips = 0, holds = 0, faces = 0;
    for (int round = 0; round < 2000; ++round) {
        glm::dmat3 B;
        glm::dvec3 b;
        for (int i = 0; i < 3; ++i) {
            b[i] = 3e-3 * uniform(rng);
            for (int j = 0; j < 3; ++j)
                B[i][j] = uniform(rng);
        }
        const glm::dmat3 A = 1e-3 * (B * glm::transpose(B) + glm::dmat3{0.5});
        const auto [f, m] = haptics::pull_minimum(A, b, 1.3);
        REQUIRE(glm::length(f) <= 1.3 * (1 + 1e-12));
        REQUIRE(f.z <= 0.0);
        REQUIRE(m >= 0.0);
        const glm::dvec3 residual = A * f - b + m * f;
        REQUIRE(glm::length(glm::dvec2{residual}) < 1e-12);
        if (f.z < 0.0)
            REQUIRE(std::abs(residual.z) < 1e-12);
        if (m > 0.0)
            REQUIRE(glm::length(f) == doctest::Approx(1.3).scale(0.0).epsilon(1e-12));
        slips += m > 0.0;
        holds += m == 0.0;
        faces += f.z == 0.0;
    }
    CHECK(slips > 100);
    CHECK(holds > 100);
    CHECK(faces > 100);
}

TEST_CASE("grasp: closing on pressed skin changes no force, and no more does opening on it") {
    Slab held, open;
    for (Slab* slab : {&held, &open}) {
        slab->rest(kTouching, 100);
        slab->rest(kTouching + glm::dvec3{1e-4, 0, 0}, 1000); // some friction
    }
    const glm::dvec3 place = kTouching + glm::dvec3{1e-4, 0, 0};
    CHECK(glm::length(glm::dvec2{open.force_n()}) > 5e-4);
    held.jaw = 1.0;
    for (int i = 0; i < 50; ++i) {
        CHECK(held.step(place).grasping[0]);
        open.step(place);
        CHECK(glm::distance(held.force_n(), open.force_n()) < 1e-6);
    }
    held.jaw = 0.0;
    CHECK_FALSE(held.step(place).grasping[0]);
    open.step(place);
    CHECK(glm::distance(held.force_n(), open.force_n()) < 1e-6);
}

TEST_CASE("grasp: it holds up to a pull of grip times friction and slips there, in any direction") {
    double worst = 0.0;
    for (const double jaw : {0.75, 0.9, 1.0})
        for (const glm::dvec3& direction :
             {glm::dvec3{1, 0, 0}, glm::dvec3{0, -1, 0}, glm::dvec3{0.6, 0.8, 0},
              glm::dvec3{0, 0, 1}, glm::dvec3{0.6, 0, 0.8}, glm::dvec3{0, 0.8, 0.6},
              glm::dvec3{-0.48, 0.64, 0.6}, glm::dvec3{0.8, 0, -0.6}}) {
            CAPTURE(jaw);
            CAPTURE(direction.x);
            CAPTURE(direction.z);
            const double limit_n = 0.6 * 4.0 * (jaw - 0.4) / 0.6;
            Slab slab = pulled(jaw, direction, 0.0, 1);
            const glm::dvec3 place = slab.rest_place_m();
            int slipping = 0;
            for (int i = 0; slipping < 30 && i < 8000; ++i) {
                slab.step(kTouching + 2e-5 * i * direction);
                const glm::dvec3 f = slab.force_n();
                const double pull_n = glm::length(glm::dvec3{f.x, f.y, std::min(f.z, 0.0)});
                REQUIRE(slab.run.memory[0].grasped);
                REQUIRE(pull_n <= limit_n * (1 + 1e-9));
                if (slab.rest_place_m() == place && slab.run.memory[0].out_m == 0.0)
                    continue;
                ++slipping;
                worst = std::max(worst, std::abs(pull_n / limit_n - 1.0));
                REQUIRE(pull_n == doctest::Approx(limit_n).scale(0.0).epsilon(0.02));
            }
            CHECK(slipping == 30);
            if (direction.z < 1.0) // the point is drawn over the slab, along with the pull
                CHECK(glm::dot(slab.rest_place_m(), direction) > 1e-5);
            if (direction.z > 0.0)
                CHECK(slab.run.memory[0].out_m > 1e-5);
        }
    MESSAGE("worst deviation of the slip force: ", 100.0 * worst, " %");
}

TEST_CASE("grasp: below the limit a constant pull of a minute does not creep") {
    for (const glm::dvec3& direction :
         {glm::dvec3{0, 0, 1}, glm::dvec3{1, 0, 0}, glm::dvec3{0.6, 0, 0.8}}) {
        Slab slab = pulled(1.0, direction, 8e-3, 400);
        const glm::dvec3 tip = kTouching + 8e-3 * direction;
        slab.rest(tip, 1000);
        const glm::dvec3 place = slab.rest_place_m();
        const glm::dvec3 force = slab.force_n();
        const double energy = slab.energy_j();
        slab.rest(tip, 60000);
        CHECK(slab.rest_place_m() == place);
        CHECK(slab.run.memory[0].out_m == 0.0);
        CHECK(glm::distance(slab.force_n(), force) < 1e-9);
        CHECK(slab.energy_j() == doctest::Approx(energy).scale(0.0).epsilon(1e-9));
        CHECK(glm::length(force) > 0.2);
    }
}

TEST_CASE("grasp: a lifted slab follows the tip with the static compliance of the two springs") {
    Slab slab = pulled(1.0, {0, 0, 1}, 8e-3, 400);
    const glm::dvec3 tip = kTouching + glm::dvec3{0, 0, 8e-3};
    slab.rest(tip, 1000);
    const double soft =
        haptics::grasp_compliance({.table = &table(), .floor_mpn = kFloor_mpn}).normal_mpn;
    const double lift_m = tip.z - kTipRadius_m; // above where the contact carries nothing
    CHECK(-slab.force_n().z ==
          doctest::Approx(lift_m / (1.0 / kSpring_npm + soft)).scale(0.0).epsilon(1e-6));
    CHECK(slab.moved_m().z > 2e-3);
}

TEST_CASE("grasp: opening leaves no force in that very tick and puts no energy in") {
    for (const glm::dvec3& direction : {glm::dvec3{0, 0, 1}, glm::dvec3{0.8, 0, 0.6}}) {
        Slab slab = pulled(1.0, direction, 8e-3, 400);
        const glm::dvec3 tip = kTouching + 8e-3 * direction;
        slab.rest(tip, 200);
        REQUIRE(glm::length(slab.force_n()) > 0.2);
        double energy = slab.energy_j(); // the grasp's own spring is dropped: not counted
        slab.jaw = 0.0;
        for (int i = 0; i < 300; ++i) {
            const haptics::StepResult step = slab.step(tip);
            CHECK_FALSE(step.grasping[0]);
            CHECK(slab.force_n() == glm::dvec3{0.0});
            CHECK(slab.energy_j() <= energy);
            energy = slab.energy_j();
        }
        CHECK(energy < 1e-9);
    }
}

TEST_CASE("grasp: jaws closed in the air, on something rigid, or before the touch take nothing") {
    Slab air;
    air.jaw = 1.0;
    CHECK_FALSE(air.step({0, 0, kTipRadius_m + 1.6e-3}).grasping[0]);
    CHECK_FALSE(air.rest(kTouching, 20).grasping[0]); // closed already: pushes, does not bite
    CHECK(air.force_n().z > 0.0);
    air.rest({0, 0, 2e-2}, 100);
    CHECK(air.force_n() == glm::dvec3{0.0});

    Slab close;
    close.jaw = 1.0;
    CHECK(close.step({0, 0, kTipRadius_m + 1.4e-3}).grasping[0]);
    CHECK(glm::length(close.force_n()) < 1e-12);
    close.rest({0, 0, kTipRadius_m + 3e-3}, 300);
    CHECK(close.force_n().z < -0.08);

    Slab rigid(true);
    rigid.rest(kTouching, 20);
    rigid.jaw = 1.0;
    CHECK_FALSE(rigid.step(kTouching).grasping[0]);
    rigid.rest({0, 0, 2e-2}, 20);
    CHECK(rigid.force_n() == glm::dvec3{0.0});
}

TEST_CASE("grasp: skin pulled out of the jaws by more than a bite is lost") {
    Slab slab = pulled(1.0, {0, 0, 1}, 60e-3, 3000);
    CHECK_FALSE(slab.run.memory[0].grasped);
    CHECK(slab.force_n() == glm::dvec3{0.0});
}

TEST_CASE("grasp: jaws that jump at random never give a force that is not a number") {
    Slab slab;
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    glm::dvec3 tip = kTouching;
    int grasps = 0, begins = 0;
    bool was = false;
    for (int i = 0; i < 20000; ++i) {
        if (rng() % 7 == 0)
            slab.jaw = rng() % 5 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                      : 0.6 + 0.7 * uniform(rng);
        tip += 2e-4 * glm::dvec3{uniform(rng), uniform(rng), uniform(rng)};
        tip -= 0.01 * (tip - kTouching);
        const haptics::StepResult step = slab.step(tip);
        const glm::dvec3 f = slab.force_n();
        REQUIRE(std::isfinite(f.x + f.y + f.z));
        REQUIRE(glm::length(f) < 20.0);
        REQUIRE(step.solve_residual_m < 1e-9);
        grasps += step.grasping[0];
        begins += step.grasping[0] && !was;
        was = step.grasping[0];
    }
    CHECK(grasps > 1000);
    CHECK(begins > 100);
}
