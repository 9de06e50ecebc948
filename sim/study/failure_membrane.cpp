// sim/study/failure_membrane.cpp
// F8, tunnelling: a ball of 0.05 mm crosses a membrane of 0.5 mm, 10000 times at each speed. A
// test of where the ball is now misses it in a share 1 - (h + 2r)/(v T) of the crossings, at 1 kHz
// from 0.6 m/s, at 50 Hz from 0.03 m/s. A proxy that is swept has to be left on the near side.
#include "sim/study/failure_bench.h"

#include <cmath>
#include <fmt/format.h>

namespace sim::failure {
namespace {

constexpr double kThick_m = 5e-4, kRadius_m = 5e-5;
constexpr int kCrossings = 10000;

struct Missed {
    int unfelt = 0; // no force in any tick
    int passed = 0; // no force out of it at the end
};

Missed cross(const ContactMethod& method, double step_m, bool upright, Random& random) {
    Scene scene;
    scene.box({-0.2, -0.2, -kThick_m}, {0.2, 0.2, 0.0});
    scene.ready();
    scene.input.radius_m = kRadius_m; // a god-object knows better
    Missed out;
    for (int i = 0; i < kCrossings; ++i) {
        // any direction within 60 degrees of straight down
        const double down = upright ? 1.0 : random.between(0.5, 1.0);
        const double turn = random.between(0.0, 2.0 * kPi), across = std::sqrt(1.0 - down * down);
        const dvec3 way{across * std::cos(turn), across * std::sin(turn), -down};
        const double above_m = kRadius_m + random.between(1e-9, 1.0) * step_m * down;
        const dvec3 start_m{random.between(-0.05, 0.05), random.between(-0.05, 0.05), above_m};
        scene.state = {};
        bool felt = false;
        double z = above_m;
        for (int k = 0; z > -kThick_m - 2.0 * kRadius_m; ++k) {
            const dvec3 device_m = start_m + k * step_m * way;
            z = device_m.z;
            felt = scene.tick(method, device_m).force_n != dvec3{0.0} || felt;
        }
        out.unfelt += !felt;
        out.passed += !(scene.state.force_n.z > 0.0);
    }
    return out;
}

} // namespace

void membrane(const ContactMethod& method, std::uint64_t seed, Rows& rows) {
    Random random{std::mt19937_64(seed)};
    const bool penalty = method.name == "penalty";
    constexpr double kFelt_m = kThick_m + 2.0 * kRadius_m;
    struct Rate {
        double tick_s;
        std::vector<double> speed_mps;
    };
    for (const Rate& rate : {Rate{1e-3, {0.1, 0.5, 1.0, 2.0}}, Rate{0.02, {0.02, 0.1, 0.5}}})
        for (const double speed_mps : rate.speed_mps) {
            const double step_m = speed_mps * rate.tick_s;
            const std::string at =
                fmt::format("{:.2f} m/s at {:.0f} Hz: ", speed_mps, 1.0 / rate.tick_s);
            const Missed any = cross(method, step_m, false, random);
            rows.at_most("F8", method.name, at + "unfelt, of 10000", any.unfelt, 0,
                         penalty && step_m > kFelt_m);
            rows.at_most("F8", method.name, at + "passed, of 10000", any.passed, 0, penalty);
            if (penalty && step_m > kFelt_m) // four standard deviations of the count
                rows.near("F8", method.name, at + "straight down, unfelt",
                          cross(method, step_m, true, random).unfelt,
                          kCrossings * (1.0 - kFelt_m / step_m), 4.0 / std::sqrt(kCrossings), true);
        }
}

} // namespace sim::failure
