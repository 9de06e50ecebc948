#include "assets/bake/nearest.h"

#include "tests/bake/shapes_for_tests.h"

#include <cmath>
#include <doctest/doctest.h>
#include <rapidcheck.h>

namespace {

glm::dvec3 random_point(int reach) {
    const auto c = [&] { return *rc::gen::inRange(-reach, reach + 1) * 1e-3; };
    const double x = c(), y = c(), z = c();
    return {x, y, z};
}

} // namespace

TEST_CASE("nearest: no point of the triangle is nearer than the answer") {
    CHECK(rc::check([] {
        const auto a = random_point(50), b = random_point(50), c = random_point(50),
                   p = random_point(90);
        RC_PRE(glm::length(glm::cross(b - a, c - a)) > 1e-6);
        const auto w = bake::nearest_weights(p, a, b, c);
        const auto q = w.x * a + w.y * b + w.z * c;
        RC_ASSERT(std::min({w.x, w.y, w.z}) >= 0.0);
        RC_ASSERT(std::abs(w.x + w.y + w.z - 1.0) < 1e-12);
        // the triangle lies beyond the plane through q across the way to p
        for (const auto& corner : {a, b, c}) {
            RC_ASSERT(glm::dot(corner - q, p - q) <= 1e-12);
        }
    }));
}

TEST_CASE("nearest: the grid finds what looking at every triangle finds") {
    CHECK(rc::check([] {
        bake::Surface s; // loose triangles, mostly small, so that many cells are empty
        for (int i = 0; i < 60; ++i) {
            const auto at = random_point(100);
            const auto first = static_cast<std::uint32_t>(s.point_m.size());
            s.point_m.insert(s.point_m.end(), {at, at + random_point(8), at + random_point(8)});
            s.triangles.push_back({first, first + 1, first + 2});
        }
        const bake::NearestOnSurface nearest(s);
        for (int i = 0; i < 20; ++i) {
            const auto p = random_point(150); // inside, outside and far away
            double best = 1e9;
            for (const auto& t : s.triangles) {
                const auto w =
                    bake::nearest_weights(p, s.point_m[t[0]], s.point_m[t[1]], s.point_m[t[2]]);
                best = std::min(best, glm::length(p - w.x * s.point_m[t[0]] -
                                                  w.y * s.point_m[t[1]] - w.z * s.point_m[t[2]]));
            }
            RC_ASSERT(std::abs(nearest(p).distance_m - best) < 1e-12);
        }
    }));
}

TEST_CASE("nearest: spheres in one another are as far apart as their radii") {
    const auto small = bake_tests::sphere(0.03, 0.005), large = bake_tests::sphere(0.04, 0.005);
    const bake::NearestOnSurface to_small(small), to_large(large);
    // the longest edge is the diagonal of a cell: sagitta 3 x 0.005^2 / (8 x 0.03) = 0.31 mm
    CHECK(bake::sampled_hausdorff_m(large, to_small) == bake_tests::near(0.01, 0.035));
    CHECK(bake::sampled_hausdorff_m(small, to_large) == bake_tests::near(0.01, 0.035));
    CHECK(bake::sampled_hausdorff_m(small, to_small) < 1e-12);
}
