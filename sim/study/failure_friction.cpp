// sim/study/failure_friction.cpp
// F7, friction 0.4 and 0.3, pressed with 1 N: a pull of 0.3 N must not move a contact in 10 s; a
// slide drags 0.30 N at any speed, both ways; friction only takes energy, and there is none in
// the air. Beside the methods one that looks at the sign of the velocity: it creeps and chatters.
#include "sim/study/failure_bench.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace sim::failure {
namespace {

constexpr double kStatic = 0.4, kDynamic = 0.3, kStiff_npm = 500.0, kPress_n = 1.0;
constexpr double kRadius_m = 1e-3, kPull_n = 0.3, kFloor_m = 0.1;

struct Floor {
    Scene scene;
    double pressed_m = 0.0;

    explicit Floor(const ContactMethod& method) {
        const double s = kFloor_m;
        scene.quad({-s, -s, 0}, {s, -s, 0}, {s, s, 0}, {-s, s, 0});
        scene.ready();
        scene.input = {.radius_m = ball_m(method, kRadius_m),
                       .stiffness_npm = kStiff_npm,
                       .static_friction = kStatic,
                       .dynamic_friction = kDynamic};
        pressed_m = scene.input.radius_m - kPress_n / kStiff_npm;
        scene.tick(method, {0, 0, scene.input.radius_m + 1e-4});
    }
};

/// Of the proxy under a steady pull of a free device, after it has settled, or to the floor's edge.
double creep_m(const ContactMethod& method) {
    Floor f(method);
    FreeAxis device;
    double from_m = 0.0;
    for (int i = 0; i < 20000 && std::abs(device.place_m) < 0.9 * kFloor_m; ++i) {
        const auto& state = f.scene.tick(method, {device.place_m, 0, f.pressed_m});
        if (i == 10000)
            from_m = state.proxy_m.x;
        device.step(state.force_n.x + kPull_n * std::min(1.0, i / 5000.0));
    }
    return std::abs(f.scene.state.proxy_m.x - from_m);
}

struct Slide {
    double ratio_error = 0.0; // of |F_t| / F_n over the dynamic coefficient, sliding
    double most_ratio = 0.0;
    double work_j = 0.0; // of friction on the device, a whole cycle
    int restarts = 0;    // changes from stuck to sliding
    double in_air_n = 0.0;
};

/// There and back and there again, 6 mm each, then off and on through the air.
Slide slide(const ContactMethod& method, double speed_mps) {
    Floor f(method);
    Slide out;
    const double step_m = speed_mps * kTick_s;
    const int half = static_cast<int>(6e-3 / step_m);
    double x_m = 0.0;
    bool slid = false;
    for (int i = 0; i < 3 * half; ++i) {
        const double way = i / half == 1 ? -1.0 : 1.0;
        const double before_n = f.scene.state.force_n.x;
        x_m += way * step_m;
        const auto& s = f.scene.tick(method, {x_m, 0, f.pressed_m});
        const double ratio = std::abs(s.force_n.x) / s.force_n.z;
        out.most_ratio = std::max(out.most_ratio, ratio);
        if (i % half > half / 2) // long since sliding
            out.ratio_error = std::max(out.ratio_error, std::abs(ratio / kDynamic - 1.0));
        if (i >= half)
            out.work_j += 0.5 * (before_n + s.force_n.x) * way * step_m;
        out.restarts += s.sliding && !slid;
        slid = s.sliding;
    }
    for (int i = 0; i < 100; ++i)
        out.in_air_n = std::max(
            out.in_air_n,
            glm::length(f.scene.tick(method, {x_m + step_m * i, 0, f.scene.input.radius_m + 1e-5})
                            .force_n));
    return out;
}

} // namespace

void friction(const ContactMethod& method, std::uint64_t, Rows& rows) {
    const bool none = method.name == "penalty" || method.name == "god-object";
    rows.at_most("F7", method.name, "creep in 10 s under 0.3 N, m", creep_m(method), 1e-6, none);
    for (const double speed_mps : {0.001, 0.01, 0.1}) {
        const Slide s = slide(method, speed_mps);
        const std::string at = fmt::format("{:.0f} mm/s: ", 1e3 * speed_mps);
        rows.at_most("F7", method.name, at + "error of 0.3 F_n, relative", s.ratio_error, 0.02,
                     none);
        rows.at_most("F7", method.name, at + "largest F_t / F_n", s.most_ratio, 1.001 * kStatic,
                     false);
        rows.at_most("F7", method.name, at + "work of friction, J", s.work_j, 1e-12, false);
        rows.at_most("F7", method.name, at + "starts in three slides", s.restarts, 3, false);
        rows.at_most("F7", method.name, at + "force in the air, N", s.in_air_n, 0, false);
    }
}

void signum_friction(std::uint64_t, Rows& rows) {
    FreeAxis device;
    double from_m = 0.0, before_n = 0.0;
    int turns = 0;
    for (int i = 0; i < 20000; ++i) {
        if (i == 10000)
            from_m = device.place_m;
        const double drag_n = device.speed_mps > 0.0   ? -kStatic * kPress_n
                              : device.speed_mps < 0.0 ? kStatic * kPress_n
                                                       : 0.0;
        turns += i >= 10000 && drag_n * before_n < 0.0;
        before_n = drag_n;
        device.step(drag_n + kPull_n * std::min(1.0, i / 5000.0));
    }
    rows.at_most("F7", "sign of the velocity", "creep in 10 s under 0.3 N, m",
                 std::abs(device.place_m - from_m), 1e-6, true);
    rows.at_most("F7", "sign of the velocity", "turns of friction in 10 s", turns, 0, true);
}

} // namespace sim::failure
