#include "haptics/device/virtual_device.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

namespace {

using haptics::DeviceFault;
using haptics::DeviceSample;
using haptics::VirtualDevice;
using haptics::VirtualDeviceModel;

constexpr double kTick_s = 1e-3;
constexpr double kFine_m = 1e-11; // encoder so fine that it does not count

VirtualDeviceModel bare(double mass_kg, double damping_nspm, double coulomb_n) {
    VirtualDeviceModel model;
    model.info.mass_kg = mass_kg;
    model.info.damping_nspm = damping_nspm;
    model.info.coulomb_n = coulomb_n;
    model.info.metres_per_count = kFine_m;
    model.info.max_force_n = 1e9;
    model.grip.held = false;
    return model;
}

// Closed loop with a bilateral wall F = -K x from rest at x0: amplitude in the last 0.2 s over
// the amplitude in the first 0.2 s.
double wall_growth(const VirtualDeviceModel& model, double stiffness_npm, double x0_m,
                   double tick_s, double seconds) {
    VirtualDevice device(model, {x0_m, 0, 0});
    DeviceSample sample;
    double first_m = 0.0;
    double last_m = 0.0;
    const int ticks = static_cast<int>(seconds / tick_s);
    const int window = static_cast<int>(0.2 / tick_s);
    for (int tick = 0; tick < ticks; ++tick) {
        device.read(sample);
        device.write({-stiffness_npm * sample.counts[0] * model.info.metres_per_count, 0, 0});
        device.step(tick_s);
        const double reach_m = std::abs(device.handle_m().x);
        if (tick < window)
            first_m = std::max(first_m, reach_m);
        if (tick >= ticks - window)
            last_m = std::max(last_m, reach_m);
        if (reach_m > 0.02) // the fine encoder's counts end at 21 mm
            return 1e9;
    }
    return last_m / first_m;
}

void run(VirtualDevice& device, const glm::dvec3& force_n, int ticks) {
    for (int tick = 0; tick < ticks; ++tick) {
        device.write(force_n);
        device.step(kTick_s);
    }
}

} // namespace

TEST_CASE("virtual device: the sampled wall rings exactly beyond its critical stiffness") {
    struct Case {
        double damping_nspm, tick_s;
        int delay_ticks;
        double critical_npm;
    };
    // poles of the exactly discretised loop on the unit circle (m = 0.1 kg)
    for (const Case& c : {Case{0.5, 1e-3, 0, 1000.83}, Case{0.1, 1e-3, 0, 200.03},
                          Case{0.5, 0.5e-3, 0, 2000.83}, Case{0.5, 1e-3, 1, 333.80}}) {
        VirtualDeviceModel model = bare(0.1, c.damping_nspm, 0.0);
        model.delay_ticks = c.delay_ticks;
        CHECK(wall_growth(model, 0.98 * c.critical_npm, 1e-3, c.tick_s, 30.0) < 1.0);
        CHECK(wall_growth(model, 1.02 * c.critical_npm, 1e-3, c.tick_s, 30.0) > 1.0);
    }
}

TEST_CASE("virtual device: Coulomb friction holds a wall up to the amplitude of theory") {
    struct Case {
        double stiffness_npm, damping_nspm, coulomb_n;
    };
    for (const Case& c :
         {Case{500, 0, 0.05}, Case{2000, 0, 0.05}, Case{820, 0.1, 0.02}, Case{1500, 0.5, 0.05}}) {
        // describing function: A* = 4 c / (pi w (K T/2 - b)), w = sqrt(K/m)
        const double limit_m = 4.0 * c.coulomb_n /
                               (M_PI * std::sqrt(c.stiffness_npm / 0.1) *
                                (c.stiffness_npm * kTick_s / 2 - c.damping_nspm));
        const VirtualDeviceModel model = bare(0.1, c.damping_nspm, c.coulomb_n);
        CHECK(wall_growth(model, c.stiffness_npm, 0.97 * limit_m, kTick_s, 20.0) < 0.9);
        CHECK(wall_growth(model, c.stiffness_npm, 1.03 * limit_m, kTick_s, 20.0) > 1.1);
    }
}

TEST_CASE("virtual device: it comes to the speed at which friction takes the whole force") {
    VirtualDevice device(bare(0.1, 0.5, 0.2), glm::dvec3{0.0});
    run(device, {1.0, 0, 0}, 3000); // 15 time constants
    CHECK(device.velocity_mps().x == doctest::Approx((1.0 - 0.2) / 0.5).scale(0.0).epsilon(1e-6));
    CHECK(device.velocity_mps().y == 0.0);
}

TEST_CASE("virtual device: less than Coulomb friction moves nothing, a little more does") {
    VirtualDevice device(bare(0.1, 0.5, 0.2), glm::dvec3{1e-3});
    run(device, {0.2, -0.19, 0.0}, 1000);
    CHECK(device.handle_m() == glm::dvec3{1e-3});
    run(device, {0.2001, -0.19, 0.0}, 100);
    CHECK(device.handle_m().x > 1e-3);
    CHECK(device.handle_m().y == 1e-3);
}

TEST_CASE("virtual device: let go, it slides to a stop where the friction has eaten its energy") {
    // b = 0: speed v = (F - c) t/m after the push, then v^2 m / (2 c) further
    VirtualDevice device(bare(0.1, 0.0, 0.05), glm::dvec3{0.0});
    run(device, {0.55, 0, 0}, 20);
    run(device, {0, 0, 0}, 1000);
    const double v = 0.5 * 0.020 / 0.1;
    CHECK(device.velocity_mps().x == 0.0);
    CHECK(device.handle_m().x ==
          doctest::Approx(0.5 * v * 0.020 + v * v * 0.1 / (2 * 0.05)).scale(0.0));
    // b > 0: x = (m/b)(v - (c/b) log(1 + v b/c)) from speed v
    VirtualDevice viscous(bare(0.1, 0.5, 0.05), glm::dvec3{0.0});
    run(viscous, {1.05, 0, 0}, 20);
    const double start_m = viscous.handle_m().x;
    const double w = viscous.velocity_mps().x;
    run(viscous, {0, 0, 0}, 2000);
    CHECK(viscous.handle_m().x - start_m ==
          doctest::Approx(0.1 / 0.5 * (w - 0.05 / 0.5 * std::log(1 + w * 0.5 / 0.05))).scale(0.0));
}

TEST_CASE("virtual device: the grip pulls the handle to its goal as a damped spring does") {
    VirtualDeviceModel model = bare(0.1, 0.5, 0.0);
    model.grip = {.held = true, .mass_kg = 0.1, .stiffness_npm = 400.0, .damping_nspm = 1.5};
    VirtualDevice device(model, glm::dvec3{0.0});
    device.set_goal({0, 0, 0.01});
    const double decay = 2.0 / (2 * 0.2); // (b + b_grip) / 2m
    const double omega = std::sqrt(400.0 / 0.2 - decay * decay);
    for (int tick = 1; tick <= 300; ++tick) {
        run(device, glm::dvec3{0.0}, 1);
        const double t = tick * kTick_s;
        const double left =
            std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
        CHECK(std::abs(device.handle_m().z - 0.01 * (1.0 - left)) < 1e-7);
    }
    // and gives way to a force by F/k
    run(device, {0, 0, -0.8}, 5000);
    CHECK(device.handle_m().z == doctest::Approx(0.01 - 0.8 / 400.0).scale(0.0));
}

TEST_CASE("virtual device: read() rounds to the nearest count") {
    VirtualDeviceModel model = bare(0.1, 0.5, 0.0);
    model.info.metres_per_count = 20e-6;
    VirtualDevice device(model, {49.0e-6, 51.0e-6, -69.9e-6});
    DeviceSample sample;
    CHECK(device.read(sample) == DeviceFault::none);
    CHECK(sample.counts == std::array<std::int32_t, 3>{2, 3, -3});
    VirtualDevice far(model, {1e9, -1e9, 0});
    far.read(sample);
    CHECK(sample.counts[0] == 2147483647);
    CHECK(sample.counts[1] == -2147483647);
}

TEST_CASE("virtual device: read() sees the past by exactly the delay") {
    for (const int delay : {0, 1, 5, 8}) {
        VirtualDeviceModel model = bare(0.1, 0.5, 0.0);
        model.delay_ticks = delay;
        VirtualDevice device(model, glm::dvec3{0.0});
        std::array<double, 101> x{};
        for (int tick = 1; tick <= 100; ++tick) {
            run(device, {0.3, 0, 0}, 1);
            x[tick] = device.handle_m().x;
            DeviceSample sample;
            device.read(sample);
            CHECK(sample.counts[0] == std::lround(x[std::max(0, tick - delay)] / kFine_m));
            CHECK(sample.sequence == static_cast<std::uint32_t>(tick));
        }
    }
}

TEST_CASE("virtual device: the motors give no more than they can, in the direction asked") {
    VirtualDeviceModel model = bare(0.1, 0.5, 0.0);
    model.info.max_force_n = 5.0;
    VirtualDevice device(model, glm::dvec3{0.0});
    run(device, {300, 400, 0}, 5000);
    CHECK(device.velocity_mps().x == doctest::Approx(3.0 / 0.5).scale(0.0));
    CHECK(device.velocity_mps().y == doctest::Approx(4.0 / 0.5).scale(0.0));
    VirtualDevice refused(model, glm::dvec3{0.0});
    run(refused, {std::nan(""), 1, 0}, 10);
    CHECK(refused.handle_m() == glm::dvec3{0.0});
}

TEST_CASE("virtual device: not written for 20 ticks it goes limp") {
    VirtualDevice device(bare(0.1, 0.0, 0.0), glm::dvec3{0.0});
    device.write({1, 0, 0});
    for (int tick = 0; tick < 100; ++tick)
        device.step(kTick_s);
    CHECK(device.velocity_mps().x == doctest::Approx(1.0 * 0.020 / 0.1).scale(0.0));
}

TEST_CASE("virtual device: an injected fault is reported, changes nothing, and can be cured") {
    VirtualDevice device(bare(0.1, 0.5, 0.0), {1e-3, 0, 0});
    DeviceSample sample;
    sample.counts = {7, 7, 7};
    device.inject(DeviceFault::unplugged);
    CHECK(device.read(sample) == DeviceFault::unplugged);
    CHECK(sample.counts == std::array<std::int32_t, 3>{7, 7, 7});
    CHECK(device.write({1, 0, 0}) == DeviceFault::unplugged);
    device.step(kTick_s);
    CHECK(device.handle_m().x == 1e-3);
    device.inject(DeviceFault::none);
    CHECK(device.read(sample) == DeviceFault::none);
    CHECK(sample.counts[0] == 100000000);
}

TEST_CASE("virtual device: the jaw closes from 0 to 1000 counts") {
    VirtualDevice device(bare(0.1, 0.5, 0.0), glm::dvec3{0.0});
    DeviceSample sample;
    device.set_jaw(0.2504);
    device.read(sample);
    CHECK(sample.jaw_counts == 250);
    device.set_jaw(7.0);
    device.read(sample);
    CHECK(sample.jaw_counts == 1000);
}
