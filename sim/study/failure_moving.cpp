// sim/study/failure_moving.cpp
// F4, a surface that moves: an organ 10 mm thick comes towards a ball at rest, or breathes under
// it, and its vertices jump 50 times a second, as FEM answers do. A method that takes the mesh as
// it is now finds its proxy inside, nearer to the far side or facing the skin from within, once a
// jump is longer than the ball's radius.
#include "sim/study/failure_bench.h"

#include <algorithm>
#include <cmath>

namespace sim::failure {
namespace {

constexpr double kThick_m = 0.01, kRadius_m = 1e-3;
constexpr int kAnswerTicks = 20;

struct Outcome {
    int lost_ticks = 0;   // pressed, and not pushed out
    double error_n = 0.0; // from K d
};

/// `top_m(time)`: where the upper face is; the device rests at z = 0.
template <class Top> Outcome follow(const ContactMethod& method, double seconds, const Top& top_m) {
    Scene scene;
    scene.box({-0.05, -0.05, -kThick_m}, {0.05, 0.05, 0.0});
    const std::vector<dvec3> rest = scene.vertex;
    const auto at = [&](double time_s) {
        std::vector<dvec3> moved = rest;
        for (dvec3& v : moved)
            v.z += top_m(time_s);
        return moved;
    };
    scene.vertex = at(0.0);
    scene.ready();
    scene.input.radius_m = ball_m(method, kRadius_m);
    Outcome out;
    for (int i = 0; i < static_cast<int>(seconds / kTick_s); ++i) {
        if (i % kAnswerTicks == 0)
            scene.move_to(at(kTick_s * i));
        const double wanted_n =
            std::max(0.0, scene.input.stiffness_npm * (scene.vertex[0].z + scene.input.radius_m));
        const double push_n = scene.tick(method, {0.01, 0.005, 0.0}).force_n.z;
        out.lost_ticks += wanted_n > 0.0 && push_n <= 0.0;
        out.error_n = std::max(out.error_n, std::abs(push_n - wanted_n));
    }
    return out;
}

/// From 20 mm below to 16 mm above.
Outcome rise(const ContactMethod& method, double speed_mps) {
    return follow(method, 0.036 / speed_mps,
                  [&](double time_s) { return -0.02 + speed_mps * time_s; });
}

} // namespace

void moving(const ContactMethod& method, std::uint64_t, Rows& rows) {
    const bool wrong =
        method.name == "penalty" || method.name == "god-object" || method.name == "virtual-proxy";
    const Outcome fast = rise(method, 0.2);
    const Outcome breath = follow(method, 1.0, [](double time_s) {
        return -0.01 * std::cos(2.0 * kPi * 2.0 * time_s); // 2 Hz, 10 mm: 126 mm/s at most
    });
    rows.at_most("F4", method.name, "200 mm/s at 50 Hz: ticks without push", fast.lost_ticks, 0,
                 wrong);
    rows.at_most("F4", method.name, "200 mm/s at 50 Hz: error of K d, N", fast.error_n, 0.01,
                 wrong);
    rows.at_most("F4", method.name, "2 Hz, 10 mm at 50 Hz: ticks without push", breath.lost_ticks,
                 0, wrong);
    rows.at_most("F4", method.name, "2 Hz, 10 mm at 50 Hz: error of K d, N", breath.error_n, 0.01,
                 wrong);
    if (method.name == "virtual-proxy") {
        const double lost_mps =
            bisect(0.01, 0.2, [&](double v) { return rise(method, v).lost_ticks == 0; });
        rows.near("F4", method.name, "speed from which it is lost, mm/s", 1e3 * lost_mps,
                  1e3 * kRadius_m / (kAnswerTicks * kTick_s), 0.02, true);
    }
}

} // namespace sim::failure
