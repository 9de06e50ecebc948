#include "haptics/safety/limits.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <rapidcheck.h>

namespace {

using haptics::DeviceFault;
using haptics::limit_force;
using haptics::LimitConfig;
using haptics::LimitState;

// Ramp done, so that only what a test is about happens.
LimitState ramped() {
    LimitState state;
    state.ramp = 1.0;
    return state;
}

} // namespace

TEST_CASE("limits: force comes up in a straight line over the ramp") {
    const LimitConfig config;
    LimitState state;
    for (int tick = 1; tick <= 1000; ++tick) {
        const glm::dvec3 f = limit_force(state, config, {2.0, 0, 0}, DeviceFault::none);
        CHECK(f.x == doctest::Approx(2.0 * std::min(1.0, tick / 750.0)).scale(0.0));
    }
    CHECK(state.slewed + state.saturated + state.not_finite == 0);
}

TEST_CASE("limits: too much force keeps its direction and loses its length") {
    LimitConfig config;
    config.max_slew_n_per_tick = 1e9;
    LimitState state = ramped();
    const glm::dvec3 f = limit_force(state, config, {30, -40, 0}, DeviceFault::none);
    CHECK(f.x == doctest::Approx(4.8).scale(0.0));
    CHECK(f.y == doctest::Approx(-6.4).scale(0.0));
    CHECK(state.saturated == 1);
    // so long that its square overflows
    CHECK(limit_force(state, config, {0, 0, -1e200}, DeviceFault::none).z ==
          doctest::Approx(-8.0).scale(0.0));
}

TEST_CASE("limits: the force never moves by more than the slew limit in a tick") {
    const LimitConfig config;
    LimitState state = ramped();
    CHECK(limit_force(state, config, {5, 0, 0}, DeviceFault::none).x ==
          doctest::Approx(1.0).scale(0.0));
    const glm::dvec3 f = limit_force(state, config, {1, 7, 0}, DeviceFault::none);
    CHECK(f.x == doctest::Approx(1.0).scale(0.0));
    CHECK(f.y == doctest::Approx(1.0).scale(0.0));
    CHECK(state.slewed == 2);
}

TEST_CASE("limits: a fault takes the force away at once, clean reads and a ramp bring it back") {
    const LimitConfig config;
    for (const DeviceFault fault : {DeviceFault::timeout, DeviceFault::bad_report,
                                    DeviceFault::unplugged, DeviceFault::stalled}) {
        LimitState state = ramped();
        for (int tick = 0; tick < 10; ++tick)
            limit_force(state, config, {6, 0, 0}, DeviceFault::none);
        CHECK(state.last_n.x == doctest::Approx(6.0).scale(0.0));
        CHECK(limit_force(state, config, {6, 0, 0}, fault) == glm::dvec3{0.0});
        // 49 clean reads, another fault: the count starts anew
        for (int tick = 0; tick < 49; ++tick)
            CHECK(limit_force(state, config, {6, 0, 0}, DeviceFault::none) == glm::dvec3{0.0});
        CHECK(limit_force(state, config, {6, 0, 0}, fault) == glm::dvec3{0.0});
        for (int tick = 1; tick < 50; ++tick)
            CHECK(limit_force(state, config, {6, 0, 0}, DeviceFault::none) == glm::dvec3{0.0});
        for (int tick = 1; tick <= 800; ++tick) {
            const glm::dvec3 f = limit_force(state, config, {6, 0, 0}, DeviceFault::none);
            CHECK(f.x == doctest::Approx(6.0 * std::min(1.0, tick / 750.0)).scale(0.0));
        }
    }
}

TEST_CASE("limits: what is not finite is zero in the same tick, counted, and ramps back") {
    const LimitConfig config;
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        LimitState state = ramped();
        for (int tick = 0; tick < 10; ++tick)
            limit_force(state, config, {6, 0, 0}, DeviceFault::none);
        CHECK(limit_force(state, config, {1, bad, 0}, DeviceFault::none) == glm::dvec3{0.0});
        CHECK(state.not_finite == 1);
        CHECK(limit_force(state, config, {6, 0, 0}, DeviceFault::none).x ==
              doctest::Approx(6.0 / 750.0).scale(0.0));
    }
}

TEST_CASE("limits: disabled is exactly zero until resume, then the ramp") {
    const LimitConfig config;
    LimitState state = ramped();
    limit_force(state, config, {1, 0, 0}, DeviceFault::none);
    state.enabled = false;
    CHECK(limit_force(state, config, {1, 0, 0}, DeviceFault::none) == glm::dvec3{0.0});
    haptics::resume(state);
    CHECK(state.enabled);
    CHECK(limit_force(state, config, {1, 0, 0}, DeviceFault::none).x ==
          doctest::Approx(1.0 / 750.0).scale(0.0));
}

TEST_CASE("limits: whatever comes in, what goes out is finite, short and slow") {
    CHECK(rc::check([] {
        const LimitConfig config;
        LimitState state;
        glm::dvec3 before{0.0};
        const auto any = [] {
            const int kind = *rc::gen::inRange(0, 12);
            if (kind == 0)
                return std::nan("");
            if (kind == 1)
                return HUGE_VAL;
            return *rc::gen::inRange(-1000, 1000) * std::pow(10.0, *rc::gen::inRange(-300, 300));
        };
        for (int tick = 0; tick < 100; ++tick) {
            const auto fault = static_cast<DeviceFault>(std::max(0, *rc::gen::inRange(-60, 5)));
            const glm::dvec3 f = limit_force(state, config, {any(), any(), any()}, fault);
            RC_ASSERT(glm::length(f) <= config.max_force_n * (1 + 1e-12));
            RC_ASSERT(f == glm::dvec3{0.0} ||
                      glm::length(f - before) <= config.max_slew_n_per_tick * (1 + 1e-12));
            RC_ASSERT(fault == DeviceFault::none || f == glm::dvec3{0.0});
            before = f;
        }
    }));
}

TEST_CASE("limits: a sampled spring gives out K X dx a cycle, and the observer sees it") {
    // F_k = -K x_k held over n equal steps dx out to X and back: taken in n(n-1)/2 K dx^2,
    // given out n(n+1)/2 K dx^2
    const double K = 400.0;
    const double dx = 1e-4;
    const int n = 50;
    haptics::EnergyObserver observer;
    for (int k = 0; k <= 2 * n; ++k) {
        const double x = dx * (k <= n ? k : 2 * n - k);
        haptics::observe_energy(observer, {0.1, x, 0}, {0, -K * x, 0});
        if (k == n)
            CHECK(observer.energy_j == doctest::Approx(K * dx * dx * n * (n - 1) / 2).scale(0.0));
    }
    CHECK(observer.energy_j == doctest::Approx(-K * dx * dx * n).scale(0.0));
    CHECK(observer.min_j == doctest::Approx(-K * dx * dx * n).scale(0.0));
}

TEST_CASE("limits: a force that the hand works against is energy taken in") {
    haptics::EnergyObserver observer;
    haptics::observe_energy(observer, {5, 0, 0}, {-2, 0, 0}); // the first place costs nothing
    haptics::observe_energy(observer, {5.01, 0, 0}, {-2, 0, 0});
    CHECK(observer.energy_j == doctest::Approx(0.02).scale(0.0));
    CHECK(observer.min_j == 0.0);
}
