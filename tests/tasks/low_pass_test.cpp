// tests/tasks/low_pass_test.cpp
// The zero-phase low pass of positions, against the gain of its Butterworth filter.
#include "tasks/score/metrics.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <numbers>

using glm::dvec3;
using tasks::low_pass;

namespace {
constexpr double kFs_hz = 1000.0, kCutoff_hz = 10.0;
}

TEST_CASE("low pass: a sine comes out in phase, scaled by the squared Butterworth gain") {
    // |H|^2 of the bilinear second order: 1 / (1 + (tan(pi f/fs)/tan(pi fc/fs))^4), twice passed.
    for (const double f_hz : {1.0, 5.0, 10.0, 20.0}) {
        std::vector<dvec3> path(4001);
        for (std::size_t i = 0; i < path.size(); ++i)
            path[i].x = std::sin(2.0 * std::numbers::pi * f_hz * static_cast<double>(i) / kFs_hz);
        const auto out = low_pass(path, kFs_hz, kCutoff_hz);
        const double ratio = std::tan(std::numbers::pi * f_hz / kFs_hz) /
                             std::tan(std::numbers::pi * kCutoff_hz / kFs_hz);
        const double gain = 1.0 / (1.0 + std::pow(ratio, 4));
        for (std::size_t i = 1000; i < 3000; ++i) // the middle: edges decayed below 1e-6
            REQUIRE(std::abs(out[i].x - gain * path[i].x) < 1e-6);
    }
}

TEST_CASE("low pass: rest and straight uniform motion pass unchanged, up to the edges") {
    std::vector<dvec3> path(500);
    for (std::size_t i = 0; i < path.size(); ++i)
        path[i] = dvec3{3.0, -1.0, 2.0} + static_cast<double>(i) * dvec3{1e-4, 0.0, -2e-4};
    const auto out = low_pass(path, kFs_hz, kCutoff_hz);
    REQUIRE(out.size() == path.size());
    // The filter starts from rest at the far end of the reflection: exp(-8.9) of the slope's lag.
    for (std::size_t i = 0; i < path.size(); ++i)
        CHECK(glm::distance(out[i], path[i]) < 2e-6);
}

TEST_CASE("low pass: a path played backwards comes out backwards") {
    std::vector<dvec3> path(800);
    for (std::size_t i = 0; i < path.size(); ++i)
        path[i].y = std::sin(0.002 * static_cast<double>(i * i % 3001));
    std::vector<dvec3> reversed(path.rbegin(), path.rend());
    const auto out = low_pass(path, kFs_hz, kCutoff_hz);
    const auto back = low_pass(reversed, kFs_hz, kCutoff_hz);
    for (std::size_t i = 0; i < path.size(); ++i)
        CHECK(std::abs(out[i].y - back[path.size() - 1 - i].y) < 1e-3);
}

TEST_CASE("low pass: nothing, one sample and too high a cut-off come back as they are") {
    CHECK(low_pass({}, kFs_hz, kCutoff_hz).empty());
    const std::vector<dvec3> one{{1, 2, 3}}, some{{1, 2, 3}, {4, 5, 6}, {0, 0, 0}};
    CHECK(low_pass(one, kFs_hz, kCutoff_hz) == one);
    CHECK(low_pass(some, 15.0, kCutoff_hz) == some);
    CHECK(low_pass(some, kFs_hz, kCutoff_hz).size() == 3); // shorter than its own reflection
}
