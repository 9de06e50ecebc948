// tests/sim/haptic_loop_test.cpp
// Three instruments against a hand-made answer: a stiff flat floor without modes.
#include "sim/loop/haptic_loop.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>

namespace {

constexpr double kStiffness_npm = 400.0;

// Stands still `depth_m` below z = 0 under the trocar; unplugs itself after `alive_ticks` reads.
struct PressingDevice final : haptics::Device {
    haptics::DeviceInfo about;
    haptics::DeviceSample sample;
    int reads = 0, alive_ticks = 1 << 30;
    glm::dvec3 felt_n{0.0};

    const haptics::DeviceInfo& info() const noexcept override { return about; }
    haptics::DeviceFault read(haptics::DeviceSample& out) noexcept override {
        if (reads >= alive_ticks)
            return haptics::DeviceFault::unplugged;
        ++reads;
        out = sample;
        return haptics::DeviceFault::none;
    }
    haptics::DeviceFault write(const glm::dvec3& force_n) noexcept override {
        felt_n = force_n;
        return haptics::DeviceFault::none;
    }
};

// A floor z = 0 under every tool, two triangles, springs of kStiffness.
void fill_floor(haptics::LocalModels& local) {
    local.step = 0;
    local.sample_tick = 0;
    local.modes = 0;
    for (haptics::ToolPatch& tool : local.tool) {
        tool.near = true;
        tool.friction = 0.0;
        tool.table = nullptr;
        tool.floor_mpn = 1.0 / kStiffness_npm;
        tool.first_mode = tool.modes = 0;
        tool.vertices = 4;
        tool.triangles = 2;
        const glm::dvec3 corner[4]{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        for (int v = 0; v < 4; ++v)
            tool.vertex[v] = {.anchor_m = corner[v], .normal = {0, 0, 1}};
        tool.triangle[0] = {.vertex = {0, 1, 2}, .neighbour = {-1, 1, -1}, .id = 0};
        tool.triangle[1] = {.vertex = {0, 2, 3}, .neighbour = {-1, -1, 0}, .id = 1};
        tool.contact = {0, {0.5, 0.0, 0.5}};
        tool.memory = {};
        tool.force_n = glm::dvec3{0.0};
    }
}

struct Bench {
    std::array<PressingDevice, sim::kTools> device;
    sim::HapticRig rig;
    std::unique_ptr<sim::Exchange> exchange = std::make_unique<sim::Exchange>();
    tasks::TickTrace trace;

    explicit Bench(double depth_m) {
        for (int i = 0; i < sim::kTools; ++i) {
            sim::Instrument& instrument = rig.instrument[i];
            instrument.trocar.fulcrum_m = {0.0, 0.0, 0.15};
            instrument.trocar.shaft_m = 0.30;
            const glm::dvec3 tip{0.0, 0.0, instrument.tip_radius_m - depth_m};
            instrument.origin_m = haptics::handle_for_tip(instrument.trocar, tip);
            instrument.device = &device[i];
        }
        fill_floor(exchange->answers.back().local);
        exchange->answers.publish();
    }
    void run(int ticks) {
        for (int t = 0; t < ticks; ++t)
            sim::haptic_tick(rig, *exchange, trace);
    }
};

} // namespace

TEST_CASE("haptic loop: after the ramp the handle feels stiffness times depth along the shaft") {
    Bench bench(1e-3);
    bench.run(1000); // ramp of 0.75 s
    // straight shaft: J along it is 1
    for (const PressingDevice& device : bench.device) {
        CHECK(device.felt_n.z == doctest::Approx(kStiffness_npm * 1e-3).scale(0.0).epsilon(1e-6));
    }
}

TEST_CASE("haptic loop: the force after start comes on a ramp") {
    Bench bench(1e-3);
    bench.run(100);
    CHECK(bench.device[0].felt_n.z < 0.2 * kStiffness_npm * 1e-3);
    CHECK(bench.device[0].felt_n.z > 0.0);
}

TEST_CASE("haptic loop: an unplugged device goes limp in the same tick, the others still push") {
    Bench bench(1e-3);
    bench.device[1].alive_ticks = 1000;
    bench.run(1000);
    const double before = bench.device[0].felt_n.z;
    CHECK(bench.device[1].felt_n.z > 0.0);
    bench.run(1);
    CHECK(bench.device[1].felt_n == glm::dvec3{0.0});
    CHECK(bench.device[0].felt_n.z == doctest::Approx(before).scale(0.0));
    CHECK(bench.device[2].felt_n.z == doctest::Approx(before).scale(0.0));
    CHECK((bench.trace.tool[1].flags & 4) != 0);
}

TEST_CASE("haptic loop: Esc zeroes every force in the next tick") {
    Bench bench(1e-3);
    bench.run(1000);
    bench.exchange->zero_forces = true;
    bench.run(1);
    for (const PressingDevice& device : bench.device)
        CHECK(device.felt_n == glm::dvec3{0.0});
}

TEST_CASE("haptic loop: an answer that is not a number never reaches a hand or the log") {
    Bench bench(1e-3);
    bench.run(900);
    sim::TissueAnswer& bad = bench.exchange->answers.back();
    fill_floor(bad.local);
    bad.local.step = 1;
    bad.local.sample_tick = 890;
    for (haptics::ToolPatch& tool : bad.local.tool) {
        tool.vertex[0].anchor_m.z = std::numeric_limits<double>::quiet_NaN();
    }
    bench.exchange->answers.publish();
    bench.run(50);
    for (int i = 0; i < sim::kTools; ++i) {
        const glm::dvec3 f = bench.device[i].felt_n;
        CHECK(std::isfinite(f.x + f.y + f.z));
        CHECK(glm::length(f) <= bench.rig.instrument[i].limits.max_force_n);
    }
}

TEST_CASE("haptic loop: the trace records counts, schedule and force in millinewtons") {
    Bench bench(1e-3);
    bench.device[0].sample.counts = {10, 0, 0};
    bench.run(1);
    CHECK(bench.trace.tick == 0);
    CHECK(bench.trace.adopted_step == 0);
    CHECK(bench.trace.tool[0].counts[0] == 10);
    bench.run(1);
    CHECK(bench.trace.adopted_step == -1);
    CHECK(bench.trace.tool[1].force_mn[2] == 400);
}
