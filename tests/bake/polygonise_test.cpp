#include "assets/bake/polygonise.h"

#include "tests/bake/shapes_for_tests.h"

#include <doctest/doctest.h>
#include <numbers>
#include <rapidcheck.h>
#include <stdexcept>

TEST_CASE("polygonise: the volume of a sphere converges with the square of the cell") {
    const double exact = 4.0 / 3.0 * std::numbers::pi * 0.03 * 0.03 * 0.03;
    const double coarse = std::abs(bake::volume_m3(bake_tests::sphere(0.03, 0.004)) / exact - 1.0);
    const double fine = std::abs(bake::volume_m3(bake_tests::sphere(0.03, 0.002)) / exact - 1.0);
    CHECK(coarse < 0.01);
    CHECK(coarse / fine == bake_tests::near(4.0, 0.1));
}

TEST_CASE("polygonise: unions of balls are closed and manifold wherever the grid lies") {
    CHECK(rc::check([] {
        struct Ball {
            glm::dvec3 centre;
            double radius;
        };
        std::vector<Ball> balls;
        const auto coordinate = [] { return *rc::gen::inRange(-12, 13) * 1e-3; };
        for (int i = 0, n = *rc::gen::inRange(1, 5); i < n; ++i) {
            const double x = coordinate(), y = coordinate(), z = coordinate();
            balls.push_back({{x, y, z}, *rc::gen::inRange(4, 15) * 1e-3});
        }
        const auto s = bake::polygonise(
            [&](const glm::dvec3& p) {
                double d = 1.0;
                for (const auto& b : balls) {
                    d = std::min(d, glm::length(p - b.centre) - b.radius);
                }
                return d;
            },
            glm::dvec3{-0.03}, glm::dvec3{0.03}, 0.003); // centres and radii fall on grid points
        const auto problems = bake::check_surface(s);
        RC_ASSERT(problems.refused_triangles == 0);
        RC_ASSERT(problems.open_edges == 0);
        RC_ASSERT(problems.pinched_vertices == 0);
        RC_ASSERT(!problems.inside_out);
    }));
}

TEST_CASE("polygonise: a body that touches the box is refused") {
    const auto ball = [](const glm::dvec3& p) { return glm::length(p) - 1.0; };
    CHECK_THROWS_AS(bake::polygonise(ball, glm::dvec3{-0.9}, glm::dvec3{0.9}, 0.1),
                    std::invalid_argument);
}

TEST_CASE("polygonise: no body is refused") {
    const auto nothing = [](const glm::dvec3&) { return 1.0; };
    CHECK_THROWS_AS(bake::polygonise(nothing, glm::dvec3{-1.0}, glm::dvec3{1.0}, 0.5),
                    std::invalid_argument);
}
