#include "tasks/score/ideal_path.h"

#include "relative.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <rapidcheck.h>
#include <vector>

using glm::dvec3;
using tasks::shortest_tour_m;
using tasks::testing::relative;

TEST_CASE("the shortest tour to one ball stops at its skin") {
    const std::vector<dvec3> ball{{0.03, 0.04, 0.0}};
    CHECK(shortest_tour_m(dvec3{0.0}, ball, 0.003) == relative(0.047));
    CHECK(shortest_tour_m(dvec3{0.03, 0.04, 0.001}, ball, 0.003) == 0.0);
    CHECK(shortest_tour_m(dvec3{0.0}, {}, 0.003) == 0.0);
}

TEST_CASE("balls that the straight way meets cost nothing") {
    const std::vector<dvec3> balls{{0.02, 0.002, 0.0}, {0.04, -0.002, 0.0}, {0.06, 0.0, 0.0}};
    CHECK(shortest_tour_m(dvec3{0.0}, balls, 0.003) == relative(0.057, 1e-6));
}

TEST_CASE("a ball of no size between two places is a mirror law") {
    // Out to the point and back: two straight legs.
    const std::vector<dvec3> balls{{0.03, 0.04, 0.0}, {0.06, 0.0, 0.0}};
    CHECK(shortest_tour_m(dvec3{0.0}, balls, 0.0) == relative(0.1));
}

TEST_CASE("a detour over a symmetric ball touches its near pole") {
    // From (-a,0) over the ball at (0,h) to the point ball at (a,0): by symmetry through (0,h-r).
    const double a = 0.03, h = 0.02, r = 0.003;
    const std::vector<dvec3> balls{{0.0, h, 0.0}, {a, 0.0, 0.0}};
    // The last ball's skin is met too; with both radii r the tour is found by bisection on x.
    const double got = shortest_tour_m(dvec3{-a, 0.0, 0.0}, balls, r);
    double best = 1.0; // independent: brute force over the angle of the touching point
    for (int i = 0; i <= 200000; ++i) {
        const double angle = -M_PI + 2.0 * M_PI * i / 200000.0;
        const dvec3 x = balls[0] + r * dvec3{std::cos(angle), std::sin(angle), 0.0};
        best =
            std::min(best, glm::distance(dvec3{-a, 0.0, 0.0}, x) + glm::distance(x, balls[1]) - r);
    }
    CHECK(got == relative(best, 1e-6));
}

TEST_CASE("no path through the balls is shorter than the shortest tour") {
    CHECK(rc::check("lower bound", [](std::vector<std::array<int, 6>> cells) {
        if (cells.size() > 6u)
            cells.resize(6);
        const double r = 0.003;
        std::vector<dvec3> centre;
        double path = 0.0;
        dvec3 at{0.0};
        const auto cell = [](int i) { return static_cast<double>(i % 60); };
        for (const auto& c : cells) {
            centre.push_back(1e-3 * dvec3{cell(c[0]), cell(c[1]), cell(c[2])});
            dvec3 inside{cell(c[3]), cell(c[4]), cell(c[5])};
            inside *= r / std::max(1.0, glm::length(inside));
            path += glm::distance(at, centre.back() + inside);
            at = centre.back() + inside;
        }
        RC_ASSERT(shortest_tour_m(dvec3{0.0}, centre, r) <= path + 1e-5);
    }));
}

TEST_CASE("the careful way retracts to the clear depth, swings about the port and inserts") {
    const glm::dvec3 port{0.01, 0.02, 0.2}, down{0.0, 0.0, -1.0}, side{1.0, 0.0, 0.0};
    const auto at = [&](double depth, double angle) {
        return port + depth * (std::cos(angle) * down + std::sin(angle) * side);
    };
    const std::vector<glm::dvec3> places{at(0.14, 0.0), at(0.15, 0.5), at(0.09, 0.2)};
    // 37 mm down to 3 mm before the first; up, over at 100 mm and down again; then up to 3 mm
    // before the third, which lies less deep than the start, and over at that depth.
    const double expected = 0.037 + (0.037 + 0.1 * 0.5 + 0.047) + (0.147 - 0.087) + 0.087 * 0.3;
    CHECK(tasks::retraction_tour_m(port, at(0.1, 0.0), places, 0.003) == relative(expected));
    CHECK(tasks::retraction_tour_m(port, at(0.1, 0.0), {}, 0.003) == 0.0);
}
