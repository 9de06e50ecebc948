// tests/haptics/anchored_test.cpp
// The anchored coupling against a mass on a spring stepped at 1 kHz, answers late as they may be.
#include "haptics/contact/coupling.h"

#include "haptics/contact/model_step.h"
#include "tests/haptics/mass_spring.h"
#include "tests/haptics/sneddon_table.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>
#include <utility>
#include <vector>

namespace {

using haptics::CouplingConfig;
using haptics::CouplingResult;
using haptics::CouplingState;
using haptics::kTools;
using haptics::LocalModels;
using haptics::PoseHistory;
using haptics::ToolTip;
using Tips = std::array<ToolTip, kTools>;

constexpr double kTick_s = 1e-3;
constexpr double kTipRadius_m = 3e-3;

Tips one_tip(const glm::dvec3& centre_m) {
    Tips tips;
    tips[0] = {centre_m, kTipRadius_m};
    return tips;
}

// Slots of the exchange: the answer in use and the pending one stay, the third is written.
struct Slots {
    std::array<std::unique_ptr<LocalModels>, 3> slot{empty_models(), empty_models(),
                                                     empty_models()};
    int next = 0;
    LocalModels& take() { return *slot[std::exchange(next, (next + 1) % 3)]; }
};

// Down onto the slab, tapping, leaving and coming back.
double tapping_m(int tick) {
    const double t = tick * kTick_s;
    return kTipRadius_m + 2e-3 - 0.03 * std::min(t, 0.2) + 3e-3 * std::sin(2 * M_PI * 5.0 * t) +
           1e-3 * std::sin(2 * M_PI * 31.0 * t);
}

} // namespace

TEST_CASE("anchored: one mode is the mass and spring stepped directly at 1 kHz") {
    MassSpring slab;
    const auto rest = empty_models();
    slab.publish(*rest, 0, -1, 0.0);
    CouplingState state;
    PoseHistory history;
    adopt(state, *rest);
    double most_n = 0.0;
    for (int tick = 0; tick < 600; ++tick) {
        history.push(tick, one_tip({0, 0, tapping_m(tick)}));
        const CouplingResult r = anchored_tick(state, {}, history, tick);
        const double expected_n = slab.step(kTick_s, tapping_m(tick));
        CHECK(std::abs(r.force_n[0].z - expected_n) < 1e-12);
        CHECK(r.touching[0] == (expected_n > 0.0));
        most_n = std::max(most_n, expected_n);
    }
    CHECK(most_n > 0.5);
}

TEST_CASE("anchored: answers adopted at any latency leave the trajectory as it was") {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        std::mt19937 rng(seed);
        MassSpring slab;
        Slots slots;
        LocalModels& rest = slots.take();
        slab.publish(rest, 0, -1, 0.0);
        CouplingState state;
        PoseHistory history;
        adopt(state, rest);
        LocalModels* waiting = nullptr;
        int arrives = 0;
        int promotions = 0;
        for (int tick = 0; tick < 800; ++tick) {
            // an answer about the tick before: on its way for 0 to 60 ticks
            if (!waiting && !state.pending.answer && rng() % 4 == 0 && tick > 0) {
                waiting = &slots.take();
                slab.publish(*waiting, tick, tick - 1, 0.0);
                arrives = tick + static_cast<int>(rng() % 61);
            }
            if (waiting && tick >= arrives) {
                adopt(state, *waiting);
                waiting = nullptr;
            }
            history.push(tick, one_tip({0, 0, tapping_m(tick)}));
            const CouplingResult r = anchored_tick(state, {}, history, tick);
            promotions += r.promoted;
            REQUIRE(r.replayed <= CouplingConfig{}.replay_ticks_per_tick);
            const double expected_n = slab.step(kTick_s, tapping_m(tick));
            REQUIRE(std::abs(r.force_n[0].z - expected_n) < 1e-12);
        }
        CHECK(promotions > 10);
    }
}

TEST_CASE("anchored: hold is late by one and a half FEM periods, anchored is not") {
    constexpr int kPeriod = 20;
    const double omega = 2 * M_PI * 1.0;
    const auto tip_m = [&](int tick) {
        return kTipRadius_m - 4e-3 + 2e-3 * std::sin(omega * tick * kTick_s);
    };
    // phase of a force against the motion, as a delay
    const auto delay_s = [&](auto force_at) {
        double in = 0.0;
        double quadrature = 0.0;
        for (int tick = 1000; tick < 4000; ++tick) {
            in -= force_at(tick) * std::sin(omega * tick * kTick_s);
            quadrature -= force_at(tick) * std::cos(omega * tick * kTick_s);
        }
        return std::atan2(-quadrature, in) / omega;
    };
    const auto run = [&](auto coupling_tick) {
        MassSpring slab; // steps at 1 kHz, so that what differs is the coupling
        Slots slots;
        CouplingState state;
        PoseHistory history;
        std::vector<double> force;
        LocalModels* answer = nullptr;
        double truth_n = 0.0;
        for (int tick = 0; tick < 4000; ++tick) {
            if (tick % kPeriod == 0) {
                if (answer)
                    adopt(state, *answer);
                answer = &slots.take();
                slab.publish(*answer, tick / kPeriod, tick - 1, truth_n);
            }
            history.push(tick, one_tip({0, 0, tip_m(tick)}));
            force.push_back(coupling_tick(state, CouplingConfig{}, history, tick).force_n[0].z);
            truth_n = slab.step(kTick_s, tip_m(tick));
        }
        return delay_s([&](int tick) { return force[tick]; });
    };
    MassSpring slab;
    std::vector<double> truth;
    for (int tick = 0; tick < 4000; ++tick)
        truth.push_back(slab.step(kTick_s, tip_m(tick)));
    const double own_s = delay_s([&](int tick) { return truth[tick]; });

    // a sample is used while it is 21 to 40 ticks old
    const double hold_s = run(haptics::hold_tick) - own_s;
    CHECK(hold_s == doctest::Approx(0.0305).scale(0.0).epsilon(0.01));
    CHECK(std::abs(run(haptics::anchored_tick) - own_s) < 1e-5);
}

TEST_CASE("anchored: a late answer catches up over several ticks while the old model works") {
    MassSpring slab;
    slab.damping_nspm = 20.0; // does not bounce off
    const auto rest = empty_models();
    const auto late = empty_models();
    slab.publish(*rest, 0, -1, 0.0);
    slab.z_m = 0.5e-3; // an answer that disagrees, so that the change of model can be seen
    slab.publish(*late, 1, 10, 0.0);
    CouplingState state;
    PoseHistory history;
    adopt(state, *rest);
    CouplingConfig config;
    config.replay_ticks_per_tick = 24;
    int promoted_at = -1;
    std::vector<int> replayed;
    for (int tick = 0; tick < 120; ++tick) {
        history.push(tick, one_tip({0, 0, kTipRadius_m - 1e-3}));
        if (tick == 80)
            adopt(state, *late);
        const CouplingResult r = anchored_tick(state, config, history, tick);
        CHECK(r.touching[0]);
        if (r.replayed > 0)
            replayed.push_back(r.replayed);
        if (r.promoted && tick > 0)
            promoted_at = tick;
    }
    // 69 ticks behind at tick 80: 24, 24 and, two ticks later, 23
    CHECK(replayed == std::vector<int>{24, 24, 23});
    CHECK(promoted_at == 82);
    CHECK(state.active.answer == late.get());
    CHECK(state.active.tick == 119);
}

TEST_CASE("anchored: an answer older than the history is replayed from the oldest tip held") {
    MassSpring slab;
    const auto rest = empty_models();
    const auto old = empty_models();
    slab.publish(*rest, 0, -1, 0.0);
    slab.publish(*old, 1, 5, 0.0);
    CouplingState state;
    PoseHistory history;
    adopt(state, *rest);
    CouplingConfig config;
    config.replay_ticks_per_tick = 10000;
    for (int tick = 0; tick <= 1000; ++tick) {
        history.push(tick, one_tip({0, 0, kTipRadius_m - 1e-3}));
        if (tick == 1000)
            adopt(state, *old);
        const CouplingResult r = anchored_tick(state, config, history, tick);
        if (tick == 1000) {
            CHECK(r.replayed == PoseHistory::kLength - 1);
            CHECK(r.promoted);
        }
    }
}

TEST_CASE("anchored: a jump of the force is bled off in a straight line over one period") {
    // two rigid slabs, one 0.2 mm higher: 800 N/m makes that 160 mN
    const auto low = empty_models();
    const auto high = empty_models();
    for (LocalModels* m : {low.get(), high.get()}) {
        make_flat_patch(m->tool[0], {0, 0, m == high.get() ? 0.2e-3 : 0.0}, 0.04, 8);
        m->tool[0].floor_mpn = 1.0 / 800.0;
    }
    low->sample_tick = -1;
    high->sample_tick = 49;
    const auto run = [&](double tip_m, double ease_above_n) {
        CouplingState state;
        PoseHistory history;
        CouplingConfig config;
        config.period_ticks = 10;
        config.ease_above_n = ease_above_n;
        adopt(state, *low);
        std::vector<double> force;
        for (int tick = 0; tick < 80; ++tick) {
            history.push(tick, one_tip({0, 0, tip_m}));
            if (tick == 50)
                adopt(state, *high);
            force.push_back(anchored_tick(state, config, history, tick).force_n[0].z);
        }
        return force;
    };
    const auto eased = run(kTipRadius_m - 1e-3, 0.025);
    for (int tick = 50; tick < 80; ++tick) {
        const double left = std::max(0.0, 1.0 - (tick - 50) / 10.0);
        CHECK(eased[tick] == doctest::Approx(0.96 - 0.16 * left).scale(0.0));
    }
    // below the threshold, or with one of the two in the air, there is nothing to ease
    CHECK(run(kTipRadius_m - 1e-3, 0.2)[50] == doctest::Approx(0.96).scale(0.0));
    CHECK(run(kTipRadius_m + 0.1e-3, 0.025)[50] == doctest::Approx(0.08).scale(0.0));
}

TEST_CASE("anchored: two tools on one body feel each other, on two bodies they do not") {
    // Two tips at rest on one slab: P_i = (reach + z)/floor, z = -(P_0 + P_1)/k.
    const double reach_m[2] = {2.2e-3, 2.5e-3};
    for (const bool shared : {true, false}) {
        MassSpring slab;
        slab.damping_nspm = 20.0;
        const auto models = empty_models();
        slab.publish(*models, 0, -1, 0.0);
        models->tool[1] = models->tool[0];
        if (!shared) {
            models->modes = 2;
            models->lambda[1] = models->lambda[0];
            models->damping[1] = models->damping[0];
            models->tool[1].first_mode = 1;
            models->tool[1].body = 1;
        }
        CouplingState state;
        PoseHistory history;
        adopt(state, *models);
        CouplingResult r;
        for (int tick = 0; tick < 2000; ++tick) {
            Tips tips = one_tip({0, 0, kTipRadius_m - reach_m[0]});
            tips[1] = {{5e-3, 0, kTipRadius_m - reach_m[1]}, kTipRadius_m};
            history.push(tick, tips);
            r = anchored_tick(state, {}, history, tick);
        }
        const double k = slab.stiffness_npm;
        const double f = slab.series_mpn;
        for (int i = 0; i < 2; ++i) {
            const double both_m = (reach_m[0] + reach_m[1]) / (2.0 / k + f); // P_0 + P_1
            const double expected_n =
                shared ? (reach_m[i] - both_m / k) / f : reach_m[i] / (1.0 / k + f);
            CHECK(r.force_n[i].z == doctest::Approx(expected_n).scale(0.0).epsilon(1e-9));
        }
    }
}

TEST_CASE("anchored: a dragged contact slides at the Coulomb limit and its point follows") {
    const auto models = empty_models();
    haptics::ToolPatch& patch = models->tool[0];
    make_flat_patch(patch, {0, 0, 0}, 0.04, 8);
    patch.friction = 0.3;
    patch.floor_mpn = 1e-3;
    patch.vertex[0].tangential_mpn = 0.0;
    models->sample_tick = -1;
    CouplingState state;
    PoseHistory history;
    adopt(state, *models);
    for (int tick = 0; tick < 400; ++tick) {
        const double x_m = 5e-5 * std::max(0, tick - 100);
        history.push(tick, one_tip({x_m, 0.1 * x_m, kTipRadius_m - 1e-3}));
        const CouplingResult r = anchored_tick(state, {}, history, tick);
        CHECK(r.force_n[0].z == doctest::Approx(1.0).scale(0.0));
        if (tick == 99)
            CHECK(glm::length(glm::dvec2{r.force_n[0]}) < 1e-12);
        if (tick > 120) {
            const glm::dvec2 friction{r.force_n[0]};
            CHECK(glm::length(friction) == doctest::Approx(0.3).scale(0.0).epsilon(1e-9));
            CHECK(friction.x / friction.y == doctest::Approx(10.0).scale(0.0).epsilon(1e-6));
        }
    }
    // the point lags by the tangential spring at the limit: 0.3 N * 1 mm/N
    const haptics::SurfacePoint& at = state.active.contact[0];
    glm::dvec3 point_m{0.0};
    for (int k = 0; k < 3; ++k)
        point_m += at.weight[k] * patch.vertex[patch.triangle[at.triangle].vertex[k]].anchor_m;
    const glm::dvec3 tip_m{5e-5 * 299, 5e-6 * 299, 0};
    CHECK(glm::length(tip_m - point_m) == doctest::Approx(0.3e-3).scale(0.0).epsilon(1e-6));
}

TEST_CASE("anchored: a tool pushed over the rim of its patch lets go, and may come back") {
    const auto models = empty_models();
    make_flat_patch(models->tool[0], {0, 0, 0}, 0.02, 4); // rim at x = 10 mm
    models->tool[0].floor_mpn = 1e-3;
    models->sample_tick = -1;
    CouplingState state;
    PoseHistory history;
    adopt(state, *models);
    for (int tick = 0; tick < 400; ++tick) {
        const double x_mm = tick < 200 ? 0.07 * tick : 0.07 * (400 - tick); // to 14 mm and back
        history.push(tick, one_tip({1e-3 * x_mm, 0, kTipRadius_m - 1e-3}));
        const CouplingResult r = anchored_tick(state, {}, history, tick);
        const bool off = x_mm > 11.0 + 1e-9;
        CHECK(r.slid_off == (off ? 1 : 0));
        if (off)
            CHECK(r.force_n[0].z == 0.0);
        else
            CHECK(r.force_n[0].z == doctest::Approx(1.0).scale(0.0));
    }
}

TEST_CASE("anchored: one broken tool or patch does not silence the others") {
    const double nan = std::nan("");
    for (const bool broken_shape : {false, true}) {
        MassSpring slab;
        const auto models = empty_models();
        slab.publish(*models, 0, -1, 0.0);
        models->modes = 3; // three bodies
        models->lambda[2] = models->lambda[1] = models->lambda[0];
        for (int i = 1; i < kTools; ++i) {
            haptics::ToolPatch& patch = models->tool[i];
            patch = models->tool[0];
            patch.first_mode = i;
            patch.friction = 0.3; // a stuck contact asks for no walk that could notice
            patch.memory = {.touching = true, .x = 0.1};
        }
        haptics::ToolPatch& broken = models->tool[2];
        for (int v = 0; v < broken.vertices; ++v)
            (broken_shape ? broken.shape[v][0][0] : broken.vertex[v].anchor_m.x) = nan;
        CouplingState state;
        PoseHistory history;
        adopt(state, *models);
        for (int tick = 0; tick < 3; ++tick) {
            Tips tips = one_tip({0, 0, kTipRadius_m - 1e-3});
            tips[1].centre_m = {nan, 0, 0};
            tips[2].centre_m = tips[0].centre_m;
            history.push(tick, tips);
            const CouplingResult r = anchored_tick(state, {}, history, tick);
            CHECK(r.force_n[0].z > 0.0);
            CHECK(r.force_n[1] == glm::dvec3{0.0});
            CHECK(r.force_n[2] == glm::dvec3{0.0});
        }
    }
}
