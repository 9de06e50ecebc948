#include "haptics/rigid/convex_hull.h"

#include "tests/haptics/convex_pieces.h"

#include <doctest/doctest.h>
#include <set>
#include <stdexcept>

namespace {

using glm::dvec3;
using haptics::ConvexHull;

// Faces outward and round, every point inside, rings closed, Euler.
void check_solid(const ConvexHull& hull, const std::vector<dvec3>& point_m, double slack_m) {
    for (std::size_t f = 0; f < hull.normal.size(); ++f) {
        CHECK(glm::length(hull.normal[f]) == doctest::Approx(1.0).scale(0.0));
        double most_m = -1e300;
        for (const dvec3& p : point_m)
            most_m = std::max(most_m, glm::dot(hull.normal[f], p) - hull.offset_m[f]);
        CHECK(most_m <= slack_m);
    }
    std::size_t sides = 0;
    for (std::uint32_t v = 0; v < hull.vertex_m.size(); ++v) {
        const auto around = hull.neighbours(v);
        const auto faces = hull.faces_round(v);
        sides += around.size();
        for (std::size_t i = 0; i < around.size(); ++i) {
            const std::uint32_t next = around[(i + 1) % around.size()];
            const auto corner = hull.corners(faces[i]);
            const std::set<std::uint32_t> of_face(corner.begin(), corner.end());
            CHECK(of_face.count(v) + of_face.count(around[i]) + of_face.count(next) == 3);
        }
    }
    CHECK(hull.vertex_m.size() + hull.normal.size() == sides / 2 + 2);
}

std::vector<dvec3> moved(const std::vector<dvec3>& p, double scale, const glm::dmat3& turned,
                         const dvec3& by_m) {
    std::vector<dvec3> q;
    for (const dvec3& x : p)
        q.push_back(scale * (turned * x) + by_m);
    return q;
}

} // namespace

TEST_CASE("convex hull: a box with points on its faces, edges and twice is six squares") {
    std::vector<dvec3> grid; // 5 x 5 x 5 points of a cube, the corners twice
    for (int i = 0; i < 125; ++i)
        grid.push_back(0.01 * dvec3{i % 5, i / 5 % 5, i / 25});
    for (int i = 0; i < 8; ++i)
        grid.push_back(0.04 * dvec3{i & 1, i >> 1 & 1, i >> 2});
    RandomPieces random(1);
    for (const double scale : {1.0, 1e-3, 1e3}) {
        const auto p = moved(grid, scale, random.rotation(), {});
        const ConvexHull hull = haptics::convex_hull(p, "cube");
        CHECK(hull.vertex_m.size() == 8);
        CHECK(hull.normal.size() == 6);
        check_solid(hull, p, 1e-7 * scale);
        CHECK(hull.inner == std::vector<std::uint8_t>(6, 0));
    }
}

TEST_CASE("convex hull: 1000 m from the origin it is the same hull") {
    RandomPieces random(2);
    for (int i = 0; i < 50; ++i) {
        const auto p = random.points();
        const ConvexHull here = haptics::convex_hull(p, "here");
        const ConvexHull there =
            haptics::convex_hull(moved(p, 1.0, glm::dmat3(1.0), {1000, -1000, 1000}), "there");
        CHECK(here.vertex_m.size() == there.vertex_m.size());
        CHECK(here.normal.size() == there.normal.size());
        CHECK(here.radius_m == doctest::Approx(there.radius_m).scale(0.0).epsilon(1e-9));
    }
}

TEST_CASE("convex hull: random points are inside, and the hull is a closed solid") {
    RandomPieces random(3);
    for (int i = 0; i < 100; ++i) {
        const auto p = random.points();
        check_solid(haptics::convex_hull(p, "random"), p, 1e-7);
    }
}

TEST_CASE("convex hull: points on a sphere are all corners") {
    RandomPieces random(4);
    std::vector<dvec3> p;
    for (int i = 0; i < 2000; ++i)
        p.push_back(glm::normalize(random.in_ball()));
    const ConvexHull hull = haptics::convex_hull(p, "sphere");
    CHECK(hull.vertex_m.size() > 1990);
    check_solid(hull, p, 1e-5);
    for (int i = 0; i < 100; ++i) {
        const dvec3 n = random.in_ball();
        const std::uint32_t v = haptics::farthest_vertex(hull, n, 0);
        for (const dvec3& q : hull.vertex_m)
            CHECK(glm::dot(n, q) <= glm::dot(n, hull.vertex_m[v]));
    }
}

TEST_CASE("convex hull: what has no volume or is not finite is refused by name") {
    std::vector<dvec3> flat;
    for (int i = 0; i < 20; ++i)
        flat.push_back({i % 5, i / 5, 0.25 * (i % 5)});
    CHECK_THROWS_WITH_AS(haptics::convex_hull(flat, "lid"),
                         "convex hull: the points of lid lie in one plane", std::invalid_argument);
    CHECK_THROWS_AS(haptics::convex_hull(std::vector<dvec3>(6, dvec3{1.0}), "point"),
                    std::invalid_argument);
    CHECK_THROWS_AS(haptics::convex_hull({}, "nothing"), std::invalid_argument);
    flat.push_back({0, 0, std::nan("")});
    CHECK_THROWS_WITH_AS(haptics::convex_hull(flat, "lid"),
                         "convex hull: point 20 of lid is not finite", std::invalid_argument);
}
