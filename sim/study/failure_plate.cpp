// sim/study/failure_plate.cpp
// F1, pop-through: a free device is pushed at a plate of 2 mm, slowly, at once, or flies into it.
// Penalty holds a slow push up to K h/2, a sudden one up to half of that (the overshoot of an
// undamped spring), and a mass of sqrt(K/m) h/2: beyond the middle the nearest face is the far one.
// The impact flies 1 mm first, which costs b x/m; on the way in damping takes, and the hold of the
// force gives back, pi/4 (b - K T/2) / sqrt(K m) of the speed.
#include "sim/study/failure_bench.h"

#include <cmath>

namespace sim::failure {
namespace {

constexpr double kThick_m = 2e-3, kStiff_npm = 800.0, kRadius_m = 1e-3;
constexpr double kMass_kg = 0.1, kDamping_nspm = 0.5, kFlight_m = 1e-3;
constexpr double kMost_n = 8.0, kMost_mps = 0.5; // a strong device, a fast hand

struct Push {
    double force_n = 0.0, ramp_s = 0.0, speed_mps = 0.0;
    double seconds = 1.0;
};

struct Outcome {
    bool through = false;
    double error_n = 0.0; // largest difference from K d while it holds
};

/// The plate's upper face is z = 0; the ball starts touching it.
Outcome push(const ContactMethod& method, const Push& p) {
    Scene scene;
    scene.box({-0.05, -0.05, -kThick_m}, {0.05, 0.05, 0.0});
    scene.ready();
    scene.input.radius_m = ball_m(method, kRadius_m);
    scene.input.stiffness_npm = kStiff_npm;
    FreeAxis device{.place_m = scene.input.radius_m + (p.speed_mps > 0.0 ? kFlight_m : 0.0),
                    .speed_mps = -p.speed_mps,
                    .mass_kg = kMass_kg,
                    .damping_nspm = kDamping_nspm};
    scene.tick(method, {0.01, 0.005, device.place_m + 1e-4}); // where it comes from
    Outcome out;
    for (int i = 0; !out.through && i < static_cast<int>(p.seconds / kTick_s); ++i) {
        const double depth_m = scene.input.radius_m - device.place_m;
        const double push_n = scene.tick(method, {0.01, 0.005, device.place_m}).force_n.z;
        out.through = depth_m > 0.5 * kThick_m && push_n <= 0.0;
        out.error_n = std::max(out.error_n, std::abs(push_n - std::max(0.0, kStiff_npm * depth_m)));
        const double time_s = kTick_s * i;
        device.step(push_n - (time_s < p.ramp_s ? p.force_n * time_s / p.ramp_s : p.force_n));
    }
    return out;
}

} // namespace

void plate(const ContactMethod& method, std::uint64_t, Rows& rows) {
    const bool wrong = method.name == "penalty";
    const auto slow = [](double n) { return Push{.force_n = n, .ramp_s = 10.0, .seconds = 10.2}; };
    const auto sudden = [](double n) { return Push{.force_n = n}; };
    const auto impact = [](double mps) { return Push{.speed_mps = mps}; };
    const auto threshold = [&](double holds, double fails, const auto& kind) {
        return bisect(holds, fails, [&](double x) { return !push(method, kind(x)).through; });
    };
    if (wrong) {
        const double half_n = 0.5 * kStiff_npm * kThick_m;
        rows.near("F1", method.name, "slow push that passes, N", threshold(0.1, kMost_n, slow),
                  half_n, 0.02, true);
        rows.near("F1", method.name, "sudden push that passes, N", threshold(0.1, kMost_n, sudden),
                  0.5 * half_n, 0.02, true);
        const double root = std::sqrt(kStiff_npm * kMass_kg);
        const double speed_mps =
            0.5 * kThick_m * root / kMass_kg *
                (1.0 + 0.25 * kPi * (kDamping_nspm - 0.5 * kStiff_npm * kTick_s) / root) +
            kDamping_nspm * kFlight_m / kMass_kg;
        rows.near("F1", method.name, "impact that passes, mm/s",
                  1e3 * threshold(0.01, kMost_mps, impact), 1e3 * speed_mps, 0.02, true);
    }
    for (const auto& [name, outcome] : {std::pair{"8 N slowly", push(method, slow(kMost_n))},
                                        {"8 N at once", push(method, sudden(kMost_n))},
                                        {"impact at 500 mm/s", push(method, impact(kMost_mps))}}) {
        rows.at_most("F1", method.name, std::string(name) + ": passes", outcome.through, 0, wrong);
        rows.at_most("F1", method.name, std::string(name) + ": error of F = K d, N",
                     outcome.error_n, 1e-3, wrong);
    }
}

} // namespace sim::failure
