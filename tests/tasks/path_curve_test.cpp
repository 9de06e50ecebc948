// tests/tasks/path_curve_test.cpp
// The curve of a path against circles, straight lines and brute force.
#include "tasks/exercise/path_curve.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <numbers>
#include <rapidcheck.h>

namespace {

std::vector<glm::dvec3> arc(int points, double radius_m, double angle_rad) {
    std::vector<glm::dvec3> out;
    for (int k = 0; k < points; ++k) {
        const double a = angle_rad * k / (points - 1);
        out.emplace_back(radius_m * std::cos(a), radius_m * std::sin(a), 0.0);
    }
    return out;
}

} // namespace

TEST_CASE("path curve: it passes through every point and keeps to a straight line") {
    const std::vector<glm::dvec3> bent = arc(9, 0.05, 2.0);
    for (std::size_t k = 0; k < bent.size(); ++k)
        CHECK(glm::distance(tasks::curve_at(bent, static_cast<double>(k)), bent[k]) < 1e-15);
    const std::vector<glm::dvec3> line{{0, 0, 0}, {0.01, 0, 0}, {0.03, 0, 0}, {0.035, 0, 0}};
    for (double u = 0.0; u <= 3.0; u += 0.1) {
        CHECK(std::abs(tasks::curve_at(line, u).y) < 1e-15);
        CHECK(std::abs(tasks::curve_length_m(line, u) - tasks::curve_at(line, u).x) < 1e-12);
    }
}

TEST_CASE("path curve: between points on a circle it stays within 0.1 % of the radius") {
    const double radius_m = 0.05, angle = 2.4; // 120 mm of arc, points 8 mm apart
    const std::vector<glm::dvec3> points = arc(16, radius_m, angle);
    for (double u = 1.0; u <= 14.0; u += 0.05) // the ends have no neighbour to bend to
        CHECK(glm::length(tasks::curve_at(points, u)) ==
              doctest::Approx(radius_m).scale(0.0).epsilon(1e-3));
    CHECK(tasks::curve_length_m(points, 15.0) ==
          doctest::Approx(radius_m * angle).scale(0.0).epsilon(1e-3));
}

TEST_CASE("path curve: a step of a way is that long, forward and back, and stops at the ends") {
    const std::vector<glm::dvec3> points = arc(16, 0.05, 2.4);
    for (const double way_m : {0.3e-3, 5e-3, 31e-3}) {
        const double u = tasks::curve_step(points, 3.3, way_m);
        CHECK(tasks::curve_length_m(points, u) - tasks::curve_length_m(points, 3.3) ==
              doctest::Approx(way_m).scale(0.0).epsilon(2e-3));
        CHECK(tasks::curve_step(points, u, -way_m) ==
              doctest::Approx(3.3).scale(0.0).epsilon(1e-3));
    }
    CHECK(tasks::curve_step(points, 14.0, 1.0) == 15.0);
    CHECK(tasks::curve_step(points, 1.0, -1.0) == 0.0);
    CHECK(tasks::curve_step(points, 1.0, 0.0) == 1.0);
}

TEST_CASE("path curve: nothing sampled on it is nearer than the nearest place") {
    const std::vector<glm::dvec3> points = arc(12, 0.05, 2.0);
    rc::check("any segment", [&] {
        const auto coordinate = [] { return 1e-4 * *rc::gen::inRange(-900, 900); };
        const glm::dvec3 a{coordinate(), coordinate(), coordinate()};
        const glm::dvec3 b{coordinate(), coordinate(), coordinate()};
        const tasks::NearCurve near = tasks::nearest_on_curve(points, a, b, 0.0, 11.0);
        double sampled_m = 1.0;
        for (int i = 0; i <= 880; ++i) {
            for (int j = 0; j <= 100; ++j)
                sampled_m = std::min(sampled_m, glm::distance(tasks::curve_at(points, i / 80.0),
                                                              a + 0.01 * j * (b - a)));
        }
        // pieces cut the arc by their height, 0.02 mm; samples lie up to half their spacing off
        RC_ASSERT(near.distance_m <= sampled_m + 0.05e-3);
        RC_ASSERT(near.distance_m >= sampled_m - 1.5e-3);
    });
}

TEST_CASE("path curve: coincident points and a single one give numbers") {
    const std::vector<glm::dvec3> same{{0.01, 0, 0}, {0.01, 0, 0}, {0.01, 0, 0}};
    CHECK(std::isfinite(tasks::curve_at(same, 1.5).x));
    CHECK(tasks::curve_length_m(same, 2.0) < 1e-15);
    const std::vector<glm::dvec3> one{{0.01, 0, 0}};
    CHECK(tasks::curve_at(one, 0.7).x == 0.01);
    CHECK(tasks::nearest_on_curve(one, {0, 0, 0}, {0, 0, 0}, 0.0, 0.0).distance_m ==
          doctest::Approx(0.01).scale(0.0));
}
