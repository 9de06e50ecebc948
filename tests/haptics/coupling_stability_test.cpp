// tests/haptics/coupling_stability_test.cpp
// Above which stiffness a coupling rings, against the closed forms for a held spring.
#include "haptics/contact/coupling.h"

#include "tests/haptics/mass_spring.h"

#include <doctest/doctest.h>
#include <functional>
#include <vector>

namespace {

using haptics::CouplingResult;
using haptics::CouplingState;
using haptics::LocalModels;
using haptics::PoseHistory;
using CouplingTick = std::function<CouplingResult(CouplingState&, const PoseHistory&, int)>;

constexpr double kTick_s = 1e-3;
constexpr double kTipRadius_m = 3e-3;
constexpr double kPush_n = 1.0;

const CouplingTick kAnchored = [](CouplingState& state, const PoseHistory& history, int tick) {
    return haptics::anchored_tick(state, {}, history, tick);
};
const CouplingTick kHold = [](CouplingState& state, const PoseHistory& history, int tick) {
    return haptics::hold_tick(state, {}, history, tick);
};

// m x'' + b x' = F between ticks, solved exactly. No hand.
struct BareDevice {
    double mass_kg = 0.1;
    double damping_nspm = 0.5;
    double x_m = 0.0;
    double v_mps = 0.0;

    void step(double force_n) {
        const double rate = damping_nspm / mass_kg;
        const double decay = std::exp(-rate * kTick_s);
        const double drift_mps = force_n / damping_nspm;
        x_m += drift_mps * kTick_s + (v_mps - drift_mps) * (1.0 - decay) / rate;
        v_mps = drift_mps + (v_mps - drift_mps) * decay;
    }
};

// Closed loop of a bare device pressed onto tissue by a constant force; every answer is one FEM
// period late. Returns the device's distance from where it started, per tick.
std::vector<double> closed_loop(const CouplingTick& coupling, int period, double seconds,
                                double start_m, double nudge_m, LocalModels& rest,
                                const std::function<void(LocalModels&, int, double)>& fem) {
    std::array<std::unique_ptr<LocalModels>, 3> slot{empty_models(), empty_models(),
                                                     empty_models()};
    CouplingState state;
    PoseHistory history;
    BareDevice device;
    device.x_m = start_m + nudge_m;
    haptics::adopt(state, rest);
    LocalModels* answer = nullptr;
    std::vector<double> motion;
    for (int tick = 0; tick < seconds / kTick_s; ++tick) {
        history.push(tick, {haptics::ToolTip{{0, 0, device.x_m}, kTipRadius_m}});
        if (tick % period == 0) {
            if (answer)
                haptics::adopt(state, *answer);
            answer = slot[(tick / period) % 3].get();
            fem(*answer, tick, device.x_m);
        }
        device.step(coupling(state, history, tick).force_n[0].z - kPush_n);
        motion.push_back(device.x_m - start_m);
    }
    return motion;
}

double amplitude(const std::vector<double>& motion, double from_s, double to_s) {
    double most = 0.0;
    for (int tick = static_cast<int>(from_s / kTick_s); tick < to_s / kTick_s; ++tick)
        most = std::max(most, std::abs(motion[tick]));
    return most;
}

// A massless spring: all of it in the local law, so the local model is exact. 40 s.
bool spring_is_stable(const CouplingTick& coupling, int period, double stiffness_npm) {
    const auto publish = [&](LocalModels& out, int tick, double tip_m) {
        out.sample_tick = tick;
        haptics::ToolPatch& patch = out.tool[0];
        make_flat_patch(patch, {0, 0, 0}, 0.04, 2);
        for (haptics::PatchVertex& v : patch.vertex)
            v.normal_mpn = 1.0 / stiffness_npm;
        patch.force_n = {0, 0, stiffness_npm * (kTipRadius_m - tip_m)};
    };
    const double start_m = kTipRadius_m - kPush_n / stiffness_npm;
    const auto rest = empty_models();
    publish(*rest, -1, start_m);
    const auto motion = closed_loop(coupling, period, 40.0, start_m, 1e-6, *rest, publish);
    return amplitude(motion, 37.0, 40.0) < amplitude(motion, 0.0, 3.0);
}

// HR-10: 200 N/m with a light mass, FEM at 50 Hz stepping by its own 20 ms.
std::vector<double> soft_wall(const CouplingTick& coupling) {
    MassSpring tissue;
    tissue.mass_kg = 1e-3;
    tissue.stiffness_npm = 200.0;
    tissue.damping_nspm = std::sqrt(200.0 * 1e-3); // half of critical
    const double start_m =
        kTipRadius_m - kPush_n * (1.0 / tissue.stiffness_npm + tissue.series_mpn);
    tissue.z_m = -kPush_n / tissue.stiffness_npm;
    const auto rest = empty_models();
    tissue.publish(*rest, 0, -1, kPush_n);
    return closed_loop(coupling, 20, 20.0, start_m, 1e-3, *rest,
                       [&](LocalModels& out, int tick, double tip_m) {
                           const double force_n = tissue.step(0.020, tip_m);
                           tissue.publish(out, tick / 20, tick, force_n);
                       });
}

} // namespace

TEST_CASE("stability: held at 50 Hz a spring rings above 17.1 N/m") {
    // critical stiffness of the lifted map, bare device, latency one period (first order: 16.7)
    CHECK(spring_is_stable(kHold, 20, 0.98 * 17.1));
    CHECK_FALSE(spring_is_stable(kHold, 20, 1.02 * 17.1));
}

TEST_CASE("stability: held at 200 Hz a spring rings above 67.1 N/m") {
    CHECK(spring_is_stable(kHold, 5, 0.98 * 67.1));
    CHECK_FALSE(spring_is_stable(kHold, 5, 1.02 * 67.1));
}

TEST_CASE("stability: anchored carries a spring to the limit of the 1 kHz loop at any FEM rate") {
    // K = b (1-a) / (m (1-a)/b - a T), a = exp(-b T/m): pole of the sampled loop on the circle
    const BareDevice d;
    const double a = std::exp(-d.damping_nspm * kTick_s / d.mass_kg);
    const double limit_npm =
        d.damping_nspm * (1.0 - a) / (d.mass_kg * (1.0 - a) / d.damping_nspm - a * kTick_s);
    CHECK(limit_npm == doctest::Approx(1000.83).scale(0.0).epsilon(1e-5));
    for (const int period : {20, 5}) {
        CHECK(spring_is_stable(kAnchored, period, 0.98 * limit_npm));
        CHECK_FALSE(spring_is_stable(kAnchored, period, 1.02 * limit_npm));
    }
}

TEST_CASE("stability: a soft wall behind a 50 Hz FEM settles under anchored, rings under hold") {
    CHECK(amplitude(soft_wall(kAnchored), 19.0, 20.0) < 1e-9);
    CHECK(amplitude(soft_wall(kHold), 19.0, 20.0) > 5e-3);
}
