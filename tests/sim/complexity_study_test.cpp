// tests/sim/complexity_study_test.cpp
// The complexity study: its fits against laws that are known, its work against what it says it is.
#include "sim/study/complexity_study.h"

#include <cmath>
#include <doctest/doctest.h>

TEST_CASE("complexity: the fit finds a power law, and refuses what has none") {
    std::vector<std::pair<double, double>> law;
    for (const double n : {500.0, 2000.0, 50000.0})
        law.emplace_back(n, 0.3 * std::pow(n / 1e3, 4.0 / 3.0));
    const sim::Growth g = sim::growth(law);
    CHECK(g.exponent == doctest::Approx(4.0 / 3.0).epsilon(1e-12).scale(0.0));
    CHECK(g.at_1000 == doctest::Approx(0.3).epsilon(1e-12).scale(0.0));
    CHECK_THROWS_WITH(sim::growth(std::vector<std::pair<double, double>>{{500.0, 1.0}}),
                      "growth: two sizes or more are needed");
    law.emplace_back(10.0, 0.0);
    CHECK_THROWS(sim::growth(law));
}

TEST_CASE("complexity: every tier presses the same block, and says what is not accepted") {
    sim::ComplexityOptions o;
    o.nodes = {200, 600};
    o.steps = 40;
    int heard = 0;
    const auto rows = sim::run_complexity(o, [&](const auto&) { ++heard; });
    REQUIRE(rows.size() == 6);
    CHECK(heard == 6);
    for (const sim::ComplexityRow& r : rows) {
        CAPTURE(tissue::name_of(r.tier));
        CAPTURE(r.nodes);
        CHECK(r.times.linear_residual <= 1e-3);
        CHECK(r.megabytes > 0.1);
        CHECK(r.times.resting_ms < r.times.mean_ms);
        CHECK(r.times.p50_ms <= r.times.p99_ms);
        // of one tip of 1.5 mm, 4 mm deep in a half-space: 4/3 E* sqrt(a) d^1.5 = 0.09 N; its
        // depth is past what that law is for, hence the factor of two either way
        CHECK(r.times.force_n > 0.045);
        CHECK(r.times.force_n < 0.18);
    }
    CHECK(rows[0].nodes < rows[3].nodes);
    o.nodes = {50};
    CHECK_THROWS_WITH(sim::run_complexity(o, [](const auto&) {}),
                      "--nodes: 1 of them: accepted: two sizes or more");
    o.nodes = {50, 500};
    CHECK_THROWS_WITH(sim::run_complexity(o, [](const auto&) {}),
                      "--nodes 50: accepted: 100 to 200000");
    o.nodes = {500, 1000};
    o.tiers = {tissue::Tier::rigid};
    CHECK_THROWS(sim::run_complexity(o, [](const auto&) {}));
}
