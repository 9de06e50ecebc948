#include "assets/bake/centreline.h"

#include "tests/bake/shapes_for_tests.h"

#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

namespace {

using std::numbers::pi;

std::vector<glm::dvec3> arc(double radius_mm, double angle, int points) {
    std::vector<glm::dvec3> list;
    for (int i = 0; i < points; ++i) {
        const double a = angle * i / (points - 1);
        list.emplace_back(radius_mm * std::cos(a), radius_mm * std::sin(a), 0.0);
    }
    return list;
}

} // namespace

TEST_CASE("centreline: passes the points, and is straight between two") {
    const std::vector<glm::dvec3> two{{0, 0, 0}, {30, 40, 0}};
    CHECK(bake::line_length_mm(two) == bake_tests::near(50.0));
    CHECK(bake::tightest_bend_mm(two) > 1e6);
    const auto list = bake::stations(two, 11);
    for (int k = 0; k <= 10; ++k) {
        CHECK(glm::length(list[k].place_mm - glm::dvec3{3.0 * k, 4.0 * k, 0.0}) < 1e-9);
        CHECK(glm::length(list[k].along - glm::dvec3{0.6, 0.8, 0.0}) < 1e-9);
    }
    const std::vector<glm::dvec3> bent{{0, 0, 0}, {20, 10, 5}, {50, 0, 0}};
    double least = 1e9;
    for (const auto& s : bake::stations(bent, 2001)) {
        least = std::min(least, glm::length(s.place_mm - bent[1]));
    }
    CHECK(least < 0.03); // stations are 0.03 mm apart
}

TEST_CASE("centreline: through points of a circle it has the circle's length and bend") {
    const auto points = arc(30.0, pi, 9);
    CHECK(bake::line_length_mm(points) == bake_tests::near(30.0 * pi, 0.01));
    // the end pieces go from straight to twice the bend, so that they turn as much as the others
    CHECK(bake::tightest_bend_mm(arc(30.0, pi, 17)) == bake_tests::near(15.0, 0.03));
    // the ends of the half circle face each other
    CHECK(bake::nearest_return_mm(points, 29.9 * pi) == bake_tests::near(60.0, 0.01));
    CHECK(bake::nearest_return_mm(points, 100.0 * pi) > 1e6);
}

TEST_CASE("centreline: stations are equally far apart, their frames right-handed") {
    const std::vector<glm::dvec3> points{{0, 0, 0}, {20, 12, 5}, {45, 0, 9}, {60, -20, 0}};
    const auto list = bake::stations(points, 41);
    const double each = bake::line_length_mm(points) / 40.0;
    for (std::size_t k = 0; k < list.size(); ++k) {
        const auto& s = list[k];
        CHECK(glm::length(s.side) == bake_tests::near(1.0));
        CHECK(std::abs(glm::dot(s.side, s.along)) < 1e-12);
        CHECK(glm::length(glm::cross(s.side, s.up) - s.along) < 1e-12);
        if (k > 0) { // the chord is a little shorter than the line
            CHECK(glm::length(s.place_mm - list[k - 1].place_mm) == bake_tests::near(each, 0.005));
        }
    }
}

TEST_CASE("centreline: along a helix the frame turns back against the curve by its torsion") {
    // radius a, climb 2 pi b a turn: torsion b / (a^2 + b^2), so that over the length of one turn
    // the frame without twist falls behind the principal normal by 2 pi b / sqrt(a^2 + b^2)
    const double a = 20.0, b = 10.0;
    std::vector<glm::dvec3> points;
    for (int i = 0; i <= 64; ++i) {
        const double t = 2.0 * pi * i / 64;
        points.emplace_back(a * std::cos(t), a * std::sin(t), b * t);
    }
    const auto list = bake::stations(points, 201);
    const auto behind = [](const bake::Station& s) { // angle of the normal in the frame
        const glm::dvec3 normal{-s.place_mm.x, -s.place_mm.y, 0.0};
        return std::atan2(glm::dot(normal, s.up), glm::dot(normal, s.side));
    };
    const double turned = behind(list.back()) - behind(list.front());
    const double expected = 2.0 * pi * b / std::sqrt(a * a + b * b);
    // the line's ends go on straight, which costs a little
    CHECK(std::abs(std::remainder(turned - expected, 2.0 * pi)) < 0.03);
}
