// tests/sim/contact_bench_test.cpp
// The contact bench measures what it says: ticks add up, known failures of the classical methods
// show, a method that has none shows none, and the same run gives the same forces.
#include "sim/study/bench_method.h"
#include "sim/study/contact_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace {

using glm::dvec3;

sim::ContactBench run(const sim::ContactScene& scene, const std::string& contact) {
    sim::ContactBenchOptions o;
    o.contact = contact;
    return sim::run_contact_bench(scene, o);
}

} // namespace

TEST_CASE("tick times: percentiles are order statistics") {
    std::vector<double> ns;
    for (int i = 10000; i > 0; --i)
        ns.push_back(i);
    const auto t = sim::tick_times(ns);
    CHECK(t.n == 10000);
    CHECK(t.mean_ns == 5000.5);
    CHECK(t.p50_ns == 5000.0);
    CHECK(t.p99_ns == 9900.0);
    CHECK(t.p9999_ns == 9999.0);
    CHECK(t.max_ns == 10000.0);
    CHECK(sim::tick_times({}).n == 0);
    CHECK(sim::tick_times({7.0}).p9999_ns == 7.0);
}

TEST_CASE("tick clock: counts what the steady clock counts") {
    using Steady = std::chrono::steady_clock;
    const sim::TickClock clock;
    double best = 1.0; // of a few tries: others use the processor too
    for (int i = 0; i < 5; ++i) {
        const auto began = Steady::now();
        const auto from = clock.start();
        while (Steady::now() - began < std::chrono::milliseconds(5)) {
        }
        const double ns = clock.ns(from, clock.stop());
        const std::chrono::duration<double, std::nano> lasted = Steady::now() - began;
        best = std::min(best, std::abs(ns / lasted.count() - 1.0));
    }
    CHECK(best < 0.01);
    CHECK(clock.overhead_ns() < 1000.0);
}

TEST_CASE("contact bench: every tick is a contact tick or a free one, and cold ones are a share") {
    const auto scene = sim::built_in_scene("organ:1k", 2.0, 1, 0.002, {});
    sim::ContactBenchOptions o;
    o.method = "ours"; // so quick that caches driven out are felt twentyfold, also beside others
    o.cold = true;
    o.cold_every = 100;
    const auto b = sim::run_contact_bench(scene, o);
    CHECK(b.triangles == 980);
    const auto left_out = static_cast<std::size_t>(b.preempted);
    const auto contacts = static_cast<std::size_t>(b.quality.contact_ticks);
    CHECK(b.contact.n + b.free.n + left_out == 2000);
    CHECK(b.contact.n <= contacts);
    CHECK(b.contact.n + left_out >= contacts);
    CHECK(b.contact.n > 700);
    CHECK(b.cold.n <= (contacts + 99) / 100);
    CHECK(b.cold.n > 0);
    CHECK(b.cold.p50_ns > b.contact.p50_ns);
    CHECK(b.missed == 0);
    CHECK(b.tick.size() == 2000);
    // the nearest-point method does no wrong on a fat organ at rest
    CHECK(b.quality.bad == 0);
    CHECK(b.quality.max_force_n == doctest::Approx(500.0 * 0.004).scale(0.0).epsilon(0.15));
}

TEST_CASE("contact bench: the nearest-point method and penalty push out of a sheet's far side") {
    const auto scene = sim::built_in_scene("sheet:1k", 2.0, 1, 0.002, {});
    for (const char* contact : {"none", "penalty"}) {
        CAPTURE(contact);
        const auto b = run(scene, contact);
        // pressed deeper than radius + half the thickness: a share of the path's sine
        CHECK(b.quality.wrong_side > b.quality.contact_ticks / 5);
        CHECK(b.quality.max_force_step_n > 0.5);
    }
}

TEST_CASE("contact bench: a god-object holds on a sheet at rest and is lost on one that breathes") {
    const auto rest = run(sim::built_in_scene("sheet:1k", 2.0, 1, 0.002, {}), "god-object");
    CHECK(rest.contact.n + static_cast<std::size_t>(rest.preempted) >
          700); // of the ball, of which the point feels the deeper part
    CHECK(rest.quality.contact_ticks > 400);
    CHECK(rest.quality.bad == 0);
    const auto breathing = run(
        sim::built_in_scene("sheet:1k", 2.0, 1, 0.002, {0.005, sim::Wave::radial}), "god-object");
    CHECK(breathing.quality.lost > breathing.quality.contact_ticks / 2);
    CHECK(breathing.quality.wrong_side > breathing.quality.contact_ticks / 2);
}

TEST_CASE("contact bench: ours does no wrong, at rest and on what breathes") {
    for (const char* name : {"organ:1k", "sheet:1k"})
        for (const double amplitude_m : {0.0, 0.002, 0.005})
            for (const sim::Wave wave : {sim::Wave::radial, sim::Wave::travelling})
                for (const double radius_m : {0.0, 0.0005, 0.002}) {
                    CAPTURE(name);
                    CAPTURE(amplitude_m);
                    CAPTURE(radius_m);
                    sim::ContactBenchOptions o;
                    o.method = o.contact = "ours";
                    o.radius_m = radius_m;
                    const auto b = sim::run_contact_bench(
                        sim::built_in_scene(name, 2.0, 7, radius_m, {amplitude_m, wave}), o);
                    CHECK(b.quality.contact_ticks > 500);
                    CHECK(b.quality.bad == 0);
                    CHECK(b.quality.max_force_step_n < 0.5);
                }
}

TEST_CASE("contact bench: the virtual proxy does no wrong at rest, shaded or not") {
    for (const char* name : {"organ:1k", "sheet:1k"}) {
        CAPTURE(name);
        const auto scene = sim::built_in_scene(name, 2.0, 7, 0.002, {});
        const auto plain = run(scene, "virtual-proxy"), shaded = run(scene, "virtual-proxy-shaded");
        CHECK(plain.quality.contact_ticks > 700);
        CHECK(plain.quality.bad == 0);
        CHECK(shaded.quality.bad == 0);
        int differ = 0;
        for (std::size_t i = 0; i < plain.tick.size(); ++i)
            differ += plain.tick[i].force_n != shaded.tick[i].force_n;
        CHECK(differ > 700);
    }
}

TEST_CASE("contact bench: shading goes with a mesh that was refitted") {
    const auto scene = sim::built_in_scene("organ:1k", 0.5, 7, 0.002, {});
    const auto turned = [](const dvec3& p) { return dvec3{-p.y, p.x, p.z}; };
    std::vector<dvec3> turned_m;
    for (const dvec3& v : scene.work.rest_m)
        turned_m.push_back(turned(v));
    const haptics::MeshView still{scene.work.rest_m, scene.work.triangle, {}};
    const haptics::MeshView moved{turned_m, scene.work.triangle, {}};
    auto one = sim::make_bench_method("ours", "virtual-proxy-shaded", still);
    auto two = sim::make_bench_method("ours", "virtual-proxy-shaded", still);
    two.refit(moved);
    haptics::ProxyInput input{.radius_m = 0.002};
    haptics::ProxyState here, there;
    int touched = 0;
    for (const dvec3& device_m : scene.path_m) {
        input.device_m = device_m;
        one.step(still, input, here);
        input.device_m = turned(device_m);
        two.step(moved, input, there);
        touched += here.touching;
        CHECK(glm::length(turned(here.force_n) - there.force_n) < 1e-5); // a hover, at 500 N/m
    }
    CHECK(touched > 100);
}

TEST_CASE("contact bench: the same run gives the same forces to the bit") {
    const auto scene = sim::built_in_scene("organ:1k", 1.0, 5, 0.002, {0.002, sim::Wave::radial});
    const auto one = run(scene, "virtual-proxy"), two = run(scene, "virtual-proxy");
    for (std::size_t i = 0; i < one.tick.size(); ++i)
        REQUIRE(one.tick[i].force_n == two.tick[i].force_n);
}

TEST_CASE("contact bench: a mesh and a path from outside are judged like the built-in ones") {
    const auto built_in = sim::built_in_scene("organ:1k", 1.0, 5, 0.002, {});
    auto path_m = built_in.path_m;
    path_m.insert(path_m.begin(), dvec3{0.0, 0.0, 0.1}); // begins free
    const auto scene =
        sim::recorded_scene(built_in.work.rest_m, built_in.work.triangle, std::move(path_m));
    CHECK(scene.entry_side == 1);
    const auto one = run(built_in, "penalty"), two = run(scene, "penalty");
    CHECK(one.quality.contact_ticks == two.quality.contact_ticks);
    CHECK(one.quality.bad == two.quality.bad);
    for (std::size_t i = 0; i < one.tick.size(); ++i)
        REQUIRE(one.tick[i].force_n == two.tick[i + 1].force_n);
    // from within an organ, its hollow side is the free one
    CHECK(sim::recorded_scene(built_in.work.rest_m, built_in.work.triangle, {{0.0, 0.0, 0.0}})
              .entry_side == 0);
}

TEST_CASE("contact bench: unknown names and numbers that mean nothing are refused") {
    const auto scene = sim::built_in_scene("organ:1k", 0.01, 1, 0.002, {});
    const auto refused = [&](auto change, const char* says) {
        sim::ContactBenchOptions o;
        change(o);
        CHECK_THROWS_WITH_AS(sim::run_contact_bench(scene, o), doctest::Contains(says),
                             std::invalid_argument);
    };
    refused([](auto& o) { o.method = "magic"; }, "brute-force");
    refused([](auto& o) { o.contact = "magic"; }, "virtual-proxy");
    refused([](auto& o) { o.reach_m = 0.0; }, "reach");
    refused([](auto& o) { o.radius_m = -1.0; }, "0 or more");
    CHECK_THROWS_AS(sim::recorded_scene({}, {}, {{0.0, 0.0, 0.0}}), std::invalid_argument);
}
