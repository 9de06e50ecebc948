// sim/study/failure_wedge.cpp
// F6, an acute ridge: over a wedge of 20 degrees the normal of a plane turns by 160 degrees within
// nothing. A ball turns it no faster than it rounds the ridge: v T over the distance of the device
// from it. A point is held until it comes off and then has nothing; a plane that comes with the
// FEM's answers goes on holding beyond the ridge for as long as the next one takes.
#include "sim/study/failure_bench.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace sim::failure {
namespace {

constexpr double kHalf = 10.0 * kPi / 180.0, kRadius_m = 1e-3, kDeep_m = 2e-4, kPoint_m = 2.5e-3;
constexpr int kAnswerTicks = 20;

/// The ridge is the y axis.
Scene roof() {
    constexpr double kHigh_m = 0.04, kLong_m = 0.05;
    const double wide_m = kHigh_m * std::tan(kHalf);
    Scene scene;
    const auto at = [&](double side, double y) { return dvec3{side * wide_m, y, -kHigh_m}; };
    const auto ridge = [](double y) { return dvec3{0, y, 0}; };
    scene.quad(at(-1, -kLong_m), ridge(-kLong_m), ridge(kLong_m), at(-1, kLong_m));
    scene.quad(at(1, kLong_m), ridge(kLong_m), ridge(-kLong_m), at(1, -kLong_m));
    scene.quad(at(-1, kLong_m), at(1, kLong_m), at(1, -kLong_m), at(-1, -kLong_m));
    scene.triangle.push_back({0, 7, 6}); // the ends
    scene.triangle.push_back({3, 2, 4});
    scene.ready();
    return scene;
}

struct Dragged {
    double turn = 0.0;   // rad, largest in a tick
    double jump_n = 0.0; // largest change in a tick
};

/// From 5 mm before the ridge to 20 mm behind, at one height; no tick is at the ridge.
Dragged drag(const ContactMethod& method, double speed_mps) {
    Scene scene = roof();
    scene.input.radius_m = ball_m(method, kRadius_m);
    const double height_m = method.ball ? kRadius_m - kDeep_m : -kPoint_m;
    Dragged out;
    dvec3 before_n{0.0};
    for (int i = 0; i <= static_cast<int>(0.025 / (speed_mps * kTick_s)); ++i) {
        const dvec3 device_m{-5e-3 + speed_mps * kTick_s * (i + 0.5), 1e-3, height_m};
        const dvec3 force_n = scene.tick(method, device_m).force_n;
        out.jump_n = std::max(out.jump_n, glm::length(force_n - before_n));
        if (glm::length(force_n) > 1e-6 && glm::length(before_n) > 1e-6)
            out.turn = std::max(out.turn, std::acos(std::clamp(glm::dot(glm::normalize(force_n),
                                                                        glm::normalize(before_n)),
                                                               -1.0, 1.0)));
        before_n = force_n;
    }
    return out;
}

/// How far beyond the ridge a plane of the near side still holds the ball, if it is renewed at
/// 50 Hz; the worst of all phases.
double ghost_m(double speed_mps) {
    const dvec3 n{-std::cos(kHalf), 0.0, std::sin(kHalf)};
    double furthest_m = 0.0;
    for (int phase = 0; phase < kAnswerTicks; ++phase) {
        bool near_side = true; // of the last answer
        for (int i = 0; near_side; ++i) {
            const double x_m = -5e-3 + speed_mps * kTick_s * (i + 0.5);
            if (i % kAnswerTicks == phase)
                near_side = x_m < 0.0;
            const bool held = glm::dot(n, dvec3{x_m, 0.0, -kPoint_m}) < 0.0;
            if (near_side && held)
                furthest_m = std::max(furthest_m, x_m);
        }
    }
    return furthest_m;
}

} // namespace

void wedge(const ContactMethod& method, std::uint64_t, Rows& rows) {
    const bool penalty = method.name == "penalty", god = method.name == "god-object";
    for (const double speed_mps : {0.005, 0.05, 0.2}) {
        const Dragged d = drag(method, speed_mps);
        const std::string at = fmt::format("{:.0f} mm/s: ", 1e3 * speed_mps);
        const double near_m = kRadius_m - kDeep_m, step_m = speed_mps * kTick_s;
        if (penalty)
            rows.near("F6", method.name, at + "turn in a tick, deg", d.turn * 180.0 / kPi, 160.0,
                      0.01, true);
        rows.at_most("F6", method.name, at + "turn in a tick, deg", d.turn * 180.0 / kPi,
                     1.05 * std::asin(step_m / near_m) * 180.0 / kPi, penalty);
        // the device and the proxy, which goes r over the device's distance as fast
        rows.at_most("F6", method.name, at + "change in a tick, N", d.jump_n,
                     1.05 * 500.0 * step_m * (1.0 + kRadius_m / near_m), penalty || god);
    }
}

void stale_plane(std::uint64_t, Rows& rows) {
    for (const double speed_mps : {0.05, 0.2}) {
        const double step_m = speed_mps * kTick_s;
        const std::string what = fmt::format("{:.0f} mm/s: held beyond the ridge", 1e3 * speed_mps);
        rows.near("F6", "a plane at 50 Hz", what + ", mm", 1e3 * ghost_m(speed_mps),
                  1e3 * (kAnswerTicks - 1.5) * step_m, 0.01, true); // v T_f, by ticks
        rows.at_most("F6", "a plane at 50 Hz", what + ", m", ghost_m(speed_mps), step_m, true);
    }
}

} // namespace sim::failure
