// tests/haptics/sweep_point_test.cpp
// The swept point at its edges: hovering over and along a triangle.
#include "haptics/collision/triangle.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>

// A point that hovers over a triangle by far less than the triangle is long, as a god-object does:
// the difference of two places that nearly meet says little about where the triangle is.

namespace {

using glm::dvec3;

struct Hovering {
    std::mt19937_64 engine{1};
    haptics::TriangleCorners corner{};
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    dvec3 inside() {
        const double u = between(0.05, 0.45), v = between(0.05, 0.45);
        return corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0]);
    }
};

} // namespace

TEST_CASE("sweep: a point that hovers over a triangle does not get through it") {
    Hovering h;
    int missed = 0;
    for (int i = 0; i < 20000; ++i) {
        const double size_m = std::pow(10.0, h.between(-3, 0));
        h.corner = {dvec3{h.between(-1, 1), h.between(-1, 1), 0.0}};
        h.corner[1] = h.corner[0] + size_m * dvec3{1, h.between(-0.3, 0.3), 0};
        h.corner[2] = h.corner[0] + size_m * dvec3{h.between(-0.3, 0.3), 1, 0};
        const double gap_m = std::pow(10.0, h.between(-12, -6)), side = i % 2 ? 1.0 : -1.0;
        const dvec3 from = h.inside() + dvec3{0, 0, side * gap_m};
        const dvec3 to = h.inside() - dvec3{0, 0, side * std::pow(10.0, h.between(-4, -2))};
        const auto sweep = haptics::sweep_ball({h.corner, h.corner}, from, to, 0.0);
        missed += sweep.time > 1.0;
    }
    CHECK(missed == 0);
}

TEST_CASE("sweep: a point that hovers along a triangle does not touch it") {
    Hovering h;
    int touched = 0;
    for (int i = 0; i < 20000; ++i) {
        const double size_m = std::pow(10.0, h.between(-3, 0));
        h.corner = {dvec3{h.between(-1, 1), h.between(-1, 1), 0.0}};
        h.corner[1] = h.corner[0] + size_m * dvec3{1, h.between(-0.3, 0.3), 0};
        h.corner[2] = h.corner[0] + size_m * dvec3{h.between(-0.3, 0.3), 1, 0};
        const double gap_m = 4e-6 * size_m;
        const auto sweep =
            haptics::sweep_ball({h.corner, h.corner}, h.inside() + dvec3{0, 0, gap_m},
                                h.inside() + dvec3{0, 0, 0.9 * gap_m}, 0.0);
        touched += sweep.time <= 1.0;
    }
    CHECK(touched == 0);
}
