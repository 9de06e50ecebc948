#include "haptics/contact/path_planes.h"

#include "haptics/contact/safe_proxy.h"
#include "tests/haptics/proxy_bench.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>

// A wall is many triangles. Where two of them meet a ball leans on both, and the one that it only
// just reaches over its edge must not hold it with a plane of its own.

namespace {

using glm::dvec3;

constexpr double kRadius_m = 1e-3;

} // namespace

TEST_CASE("path planes: beside an edge by next to nothing, the triangle's own plane") {
    const haptics::TriangleCorners corner{dvec3{0, 0, 0}, {0.01, 0, 0}, {0.01, 0.01, 0}};
    const auto normal_at = [&](const dvec3& centre_m) {
        haptics::HoldingPlanes planes;
        planes.add(0, corner, haptics::nearest_on_triangle(corner, centre_m), centre_m, kRadius_m);
        REQUIRE(planes.count == 1);
        return planes.plane[0].normal;
    };
    CHECK(normal_at({5e-3, -2e-6, kRadius_m}) == dvec3{0, 0, 1});
    CHECK(normal_at({5e-3, -2e-6, -kRadius_m}) == dvec3{0, 0, -1});
    // further aside it is the edge's: the ball may come down past it
    const dvec3 beside_m{5e-3, -5e-4, 8e-4};
    CHECK(glm::length(normal_at(beside_m) - glm::normalize(dvec3{0, beside_m.y, beside_m.z})) <
          1e-15);
}

TEST_CASE("path planes: in a cube corner, on the seams of its walls, the proxy is exact") {
    // the seams run out of the corner, so that a ball in it rests on all three of them
    proxy_bench::Bench b = proxy_bench::cube_corner();
    b.input.radius_m = kRadius_m;
    const std::vector<haptics::Plane> walls{
        {{1, 0, 0}, kRadius_m}, {{0, 1, 0}, kRadius_m}, {{0, 0, 1}, kRadius_m}};
    std::mt19937_64 engine(1);
    std::normal_distribution<double> step_m(0.0, 3e-5);
    dvec3 device_m{5e-3, 5e-3, 5e-3};
    double worst_m = 0.0;
    for (int i = 0; i < 20000; ++i) {
        device_m += dvec3{step_m(engine), step_m(engine), step_m(engine)} - 1e-3 * device_m;
        b.lead(haptics::step_safe_proxy, device_m);
        worst_m =
            std::max(worst_m, glm::length(b.state.proxy_m -
                                          haptics::nearest_in_planes(walls, device_m).place_m));
    }
    CHECK(worst_m < 2e-8);
}
