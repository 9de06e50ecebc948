#include "haptics/rigid/step_rigid.h"

#include "tests/haptics/effort.h"
#include "tests/haptics/rigid_scenes.h"

#include <chrono>
#include <doctest/doctest.h>
#include <limits>
#include <stdexcept>

namespace {

using glm::dvec3;
using haptics::RigidParams;
using haptics::RigidPose;
using haptics::Wrench;

// A block whose top is z = 0.
std::vector<haptics::RigidBody> table(const RigidPose& pose = {}) {
    return {body("table", {box({0.1, 0.1, 0.05}, {0, 0, -0.05})}, pose)};
}

// A box with its origin 10 mm above its bottom.
std::vector<haptics::RigidBody> block_tool() {
    return {body("block", {box({0.01, 0.015, 0.01})})};
}

double series(double k, double l) {
    return k * l / (k + l);
}

} // namespace

TEST_CASE("step rigid: a box pressed on a plane feels the two stiffnesses in series") {
    for (const dvec3 far_m : {dvec3{0.0}, dvec3{1000, -1000, 1000}}) {
        RigidRig rig(table({glm::dmat3(1.0), far_m}), block_tool());
        const double k = series(rig.model.spring[0].stiffness_npm, rig.model.params.contact_npm);
        for (const double press_m : {0.1e-3, 1e-3, 3e-3}) {
            const Wrench& w = rig.settle({glm::dmat3(1.0), far_m + dvec3{0, 0, 0.01 - press_m}});
            CHECK(w.force_n.z == doctest::Approx(k * press_m).scale(0.0).epsilon(1e-6));
            CHECK(glm::length(dvec3{w.force_n.x, w.force_n.y, 0}) < 1e-6 * w.force_n.z);
            CHECK(glm::length(w.torque_nm) < 1e-6);
            CHECK(rig.tick.solved);
            CHECK(rig.tick.dropped == 0);
            CHECK(rig.tick.passivity_share <= 0.8);
        }
        CHECK(rig.settle({glm::dmat3(1.0), far_m + dvec3{0, 0, 0.011}}, 5).force_n == dvec3{0.0});
    }
}

// m x'' + b x' = -weight + F, exact between ticks.
TEST_CASE("step rigid: a bare device laid on a plane comes to rest, its weight held") {
    RigidRig rig(table(), block_tool());
    const double mass_kg = 0.1, weight_n = 0.981, rate = 0.5 / mass_kg,
                 decay = std::exp(-rate * 1e-3);
    double z_m = 0.012, v_mps = 0.0, force_n = 0.0;
    for (int tick = 0; tick < 20000; ++tick) {
        force_n = rig.step({glm::dmat3(1.0), {0, 0, z_m}}).force_n.z;
        const double drift_mps = (force_n - weight_n) / 0.5;
        z_m += drift_mps * 1e-3 + (v_mps - drift_mps) * (1.0 - decay) / rate;
        v_mps = drift_mps + (v_mps - drift_mps) * decay;
    }
    const double k = series(rig.model.spring[0].stiffness_npm, rig.model.params.contact_npm);
    CHECK(std::abs(v_mps) < 1e-5);
    CHECK(force_n == doctest::Approx(weight_n).scale(0.0).epsilon(1e-3));
    CHECK(z_m == doctest::Approx(0.01 - weight_n / k).scale(0.0).epsilon(1e-4));
}

TEST_CASE("step rigid: sliding over seams of the scenery is without friction and without bumps") {
    // the same table in 8 blocks, each of which has its own sides
    std::vector<haptics::ConvexHull> blocks;
    for (int i = 0; i < 8; ++i)
        blocks.push_back(box({0.0125, 0.1, 0.05}, {-0.0875 + 0.025 * i, 0, -0.05}));
    for (haptics::ConvexHull& b : blocks) // sides are inside of the table
        for (std::size_t f = 0; f < b.normal.size(); ++f)
            b.inner[f] = std::abs(b.normal[f].x) > 0.9;
    RigidRig rig({body("blocks", blocks)}, block_tool());
    const double k = series(rig.model.spring[0].stiffness_npm, rig.model.params.contact_npm);
    rig.settle({glm::dmat3(1.0), {-0.05, 0, 0.009}});
    dvec3 last = rig.tick.wrench[0].force_n;
    for (double x_m = -0.05; x_m < 0.05; x_m += 1e-4) { // 100 mm/s
        const Wrench& w = rig.step({glm::dmat3(1.0), {x_m, 0, 0.009}});
        CHECK(w.force_n.z == doctest::Approx(k * 1e-3).scale(0.0).epsilon(0.02));
        CHECK(std::abs(w.force_n.x) < 1e-3);
        CHECK(glm::length(w.force_n - last) < 0.02);
        last = w.force_n;
    }
}

// Half of the box hangs over: the middle of the contact is 5 mm from the device, and the box turns
// until the torsion spring holds what is left of the lever.
TEST_CASE("step rigid: over an edge the torque is force times the lever of what lies on") {
    RigidRig rig(table(), block_tool());
    const Wrench& w = rig.settle({glm::dmat3(1.0), {0.1, 0, 0.0099}}, 3000);
    dvec3 lever_nm{0.0}, middle_m{0.0};
    for (const haptics::ToolContact& c : rig.tick.contacts) {
        const dvec3 arm_m = c.contact.place_m - rig.state.tool[0].position_m;
        const double force_n = rig.model.params.contact_npm * c.contact.share * c.contact.depth_m;
        lever_nm += glm::cross(arm_m, force_n * c.contact.normal);
        middle_m += arm_m * c.contact.share;
    }
    CHECK(w.force_n.z > 0.0);
    CHECK(w.torque_nm.y > 0.0); // turns its free side down
    CHECK(w.torque_nm.y == doctest::Approx(lever_nm.y).scale(0.0).epsilon(1e-3));
    CHECK(middle_m.x < -1e-4);
    CHECK(middle_m.x > -0.0101);
}

TEST_CASE("step rigid: two tools push each other by the same force and torque") {
    RigidRig rig({}, {body("one", {box({0.01, 0.015, 0.01})}), body("two", {box(dvec3{0.008})})});
    const std::array<RigidPose, 2> device{RigidPose{turn({1, 1, 0}, 0.02), {0, 0, 0}},
                                          RigidPose{turn({0, 1, 1}, 0.3), {0.004, -0.003, 0.0185}}};
    for (int tick = 0; tick < 500; ++tick)
        haptics::step_rigid(rig.model, device, rig.state, rig.scratch, rig.tick);
    const auto& [a, b, unused] = rig.tick.wrench;
    CHECK(glm::length(a.force_n) > 0.01);
    CHECK(glm::length(a.force_n + b.force_n) < 1e-6 * glm::length(a.force_n));
    const dvec3 about_a = a.torque_nm + glm::cross(device[0].position_m, a.force_n);
    const dvec3 about_b = b.torque_nm + glm::cross(device[1].position_m, b.force_n);
    CHECK(glm::length(about_a + about_b) < 1e-5 * glm::length(a.force_n) * 0.01);
    CHECK(glm::length(unused.force_n) == 0.0);
}

TEST_CASE("step rigid: a spring stiffer than the damping allows is felt only as far as it does") {
    RigidRig rig(table(), block_tool());
    rig.model.spring[0] = {4000.0, 1.0};
    const Wrench& w = rig.settle({glm::dmat3(1.0), {0, 0, 0.009}});
    CHECK(rig.tick.passivity_share > 1.0);
    CHECK(w.force_n.z <= 1e-3 * 0.8 * 1000.0 * 1.0001); // 80 % of 2 b / T
    CHECK(w.force_n.z > 0.0);
}

TEST_CASE("step rigid: the same motion gives the same bits, and bad poses no force") {
    RigidRig one(table(), {body(l_surface())}), two(table(), {body(l_surface())});
    for (int i = 0; i < 300; ++i) {
        const RigidPose device{turn({1, 2, 3}, 0.01 * i), {0, 1e-4 * i, 0.04 - 2e-4 * i}};
        one.step(device);
        two.step(device);
        CHECK(one.tick.wrench[0].force_n == two.tick.wrench[0].force_n);
        CHECK(one.tick.wrench[0].torque_nm == two.tick.wrench[0].torque_nm);
    }
    const RigidPose bad{glm::dmat3(1.0), dvec3{std::numeric_limits<double>::quiet_NaN()}};
    CHECK(one.step(bad).force_n == dvec3{0.0});
    CHECK(!one.tick.solved);
    haptics::step_rigid(one.model, {}, one.state, one.scratch, one.tick);
    CHECK(!one.tick.solved);
    CHECK_THROWS_AS(RigidRig({}, {}), std::invalid_argument);
}

TEST_CASE("step rigid: ticks are short") {
    struct Scene {
        std::string name;
        RigidRig rig;
        RigidPose device;
    };
    const RigidPose askew{turn({1, 2, 3}, 0.3), {0, 0, 0.009}};
    std::vector<Scene> scenes;
    scenes.push_back(
        {"box on a plane", RigidRig(table(), block_tool()), {glm::dmat3(1.0), {0, 0, 0.0095}}});
    scenes.push_back({"box in a U", RigidRig({body(u_surface())}, block_tool()), askew});
    scenes.push_back({"L in a U", RigidRig({body(u_surface())}, {body(l_surface())}), askew});
    scenes.push_back({"box in a torus of 30 pieces",
                      RigidRig({body(torus_surface(0.02, 0.006, 16, 10))}, block_tool()),
                      {turn({1, 2, 3}, 0.3), {0.012, 0, 0.009}}});
    for (Scene& scene : scenes) {
        std::vector<double> us;
        for (int i = 0; i < 2000; ++i) {
            RigidPose device = scene.device;
            device.position_m.x += 1e-3 * std::sin(0.05 * i);
            const auto begin = std::chrono::steady_clock::now();
            scene.rig.step(device);
            const std::chrono::duration<double, std::micro> took =
                std::chrono::steady_clock::now() - begin;
            us.push_back(took.count());
        }
        std::sort(us.begin(), us.end());
        MESSAGE(scene.name << ": median " << us[us.size() / 2] << " us, p99 "
                           << us[us.size() * 99 / 100] << " us, " << scene.rig.state.known.count
                           << " pairs");
        // of the quicker tenth: others use this machine too, and a sanitizer is no machine at all
        if (effort::kShare == 1)
            CHECK(us[us.size() / 10] < 500.0);
    }
}
