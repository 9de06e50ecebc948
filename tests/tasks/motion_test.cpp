#include "tasks/hand/motion.h"

#include "relative.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

using tasks::testing::relative;
using namespace tasks;

namespace {

// Pushes against a spring `k` through a grip of 400 N/m with first-order lag; returns the forces.
std::vector<double> pressed(double k_npm, double delay_s, double gap_m, double wanted_n,
                            double speed_mps) {
    Press press = begin_press(wanted_n, speed_mps, delay_s);
    std::vector<double> force(8000);
    double tip_m = 0.0, now_n = 0.0;
    for (double& f : force) {
        advance(press, now_n);
        const double into_m = press.advanced_m - gap_m;
        const double balance_m =
            into_m > 0.0 ? gap_m + into_m * 400.0 / (400.0 + k_npm) : press.advanced_m;
        tip_m += 0.05 * (balance_m - tip_m);
        now_n = std::max(0.0, k_npm * (tip_m - gap_m));
        f = now_n;
    }
    return force;
}

} // namespace

TEST_CASE("a planned movement starts and ends at rest and peaks at the speed asked for") {
    const glm::dvec3 from{0.01, 0.02, 0.0}, to{0.01, 0.02, 0.05};
    MinimumJerk move = plan_move(from, to, 0.05);
    CHECK(move.duration_s == relative(1.875 * 0.05 / 0.05));
    double peak_mps = 0.0;
    glm::dvec3 before = place_m(move);
    CHECK(before == from);
    while (!arrived(move)) {
        move.time_s += kTick_s;
        peak_mps = std::max(peak_mps, glm::distance(place_m(move), before) / kTick_s);
        before = place_m(move);
    }
    CHECK(peak_mps == relative(0.05, 1e-3));
    CHECK(glm::distance(before, to) < 1e-12);
}

TEST_CASE("a bow bends a movement by itself at half-way and not at the ends") {
    MinimumJerk move = plan_move(glm::dvec3{0.0}, {0.1, 0.0, 0.0}, 0.1);
    move.bow_m = {0.0, 0.01, 0.0};
    move.time_s = 0.5 * move.duration_s;
    CHECK(glm::distance(place_m(move), glm::dvec3{0.05, 0.01, 0.0}) < 1e-12);
    move.time_s = move.duration_s;
    CHECK(glm::distance(place_m(move), glm::dvec3{0.1, 0.0, 0.0}) < 1e-12);
}

TEST_CASE("tremor has the length asked for and lives between 3 and 12 Hz") {
    Tremor tremor{Random(5), {}};
    const int n = 200000; // 200 s: the power of 9 Hz of noise is then known to 2 %
    double square = 0.0;
    std::vector<double> x(n);
    for (double& v : x) {
        const glm::dvec3 y = next_tremor_m(tremor, 50e-6);
        square += glm::dot(y, y);
        v = y.x;
    }
    CHECK(std::sqrt(square / n) == relative(50e-6, 0.03));
    // The filter's own magnitude as the independent number: |H|^2 at f over |H|^2 at 6 Hz of an
    // analogue band pass, 1 / (1 + ((f/6 - 6/f) 6/9)^2), from averaged periodograms of 1 s.
    const auto power = [&](double f_hz) {
        double sum = 0.0;
        for (int part = 0; part < 200; ++part) {
            double re = 0.0, im = 0.0;
            for (int i = 0; i < 1000; ++i) {
                const double w = 2.0 * std::numbers::pi * f_hz * i * kTick_s;
                const double hann = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * i / 1000.0);
                re += hann * x[static_cast<std::size_t>(part * 1000 + i)] * std::cos(w);
                im += hann * x[static_cast<std::size_t>(part * 1000 + i)] * std::sin(w);
            }
            sum += re * re + im * im;
        }
        return sum;
    };
    const double middle = power(6.0);
    for (const double f_hz : {1.0, 3.0, 12.0, 30.0}) {
        const double ratio = (f_hz / 6.0 - 6.0 / f_hz) * 6.0 / 9.0;
        const double expected = 1.0 / (1.0 + ratio * ratio);
        // 200 periodograms each way: 10 % of spread; half as much again where Hann leaks (1 Hz)
        CHECK(power(f_hz) / middle > 0.6 * expected);
        CHECK(power(f_hz) / middle < 1.7 * expected);
    }
}

TEST_CASE("a press settles at the wanted force on any tissue without overshooting it by much") {
    for (const double k_npm : {20.0, 50.0, 80.0, 300.0, 2000.0})
        for (const double delay_s : {0.0, 0.15, 0.25}) {
            const double wanted_n = 0.5, speed_mps = 0.015;
            const auto force = pressed(k_npm, delay_s, 5e-3, wanted_n, speed_mps);
            CAPTURE(k_npm);
            CAPTURE(delay_s);
            CHECK(force.back() == relative(wanted_n, 0.02));
            // Until the first force is felt the goal goes on for the delay and stops in speed/0.15
            // s: that way, through grip and tissue in series, is what cannot be helped.
            const double series_npm = k_npm * 400.0 / (k_npm + 400.0);
            const double blind_n =
                series_npm * speed_mps * (delay_s + 0.1 + speed_mps / (2.0 * 0.15));
            const double peak_n = *std::max_element(force.begin(), force.end());
            CHECK(peak_n < std::max(1.1 * wanted_n, 0.1 + blind_n));
        }
}

TEST_CASE("a press in the air goes on at its speed") {
    Press press = begin_press(0.5, 0.01, 0.1);
    for (int i = 0; i < 2000; ++i)
        advance(press, 0.0);
    // speed * time, less half the time it takes to get up to speed
    CHECK(press.advanced_m == relative(0.01 * (2.0 - 0.5 * 0.01 / 0.15), 1e-3));
    CHECK(press.contact_ticks == 0);
}

TEST_CASE("normal draws have mean 0, variance 1 and normal tails") {
    Random random(3);
    double sum = 0.0, square = 0.0;
    int beyond = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double x = random.normal();
        sum += x;
        square += x * x;
        beyond += std::abs(x) > 1.96;
    }
    CHECK(std::abs(sum / n) < 4.0 / std::sqrt(double(n)));
    CHECK(square / n == relative(1.0, 0.02));
    CHECK(double(beyond) / n == relative(0.05, 0.06));
}
