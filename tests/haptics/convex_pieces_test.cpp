#include "haptics/rigid/convex_pieces.h"

#include "tests/haptics/convex_pieces.h"
#include "tests/haptics/rigid_surfaces.h"

#include <doctest/doctest.h>
#include <stdexcept>

namespace {

using glm::dvec3;
using haptics::ConvexHull;
using haptics::RigidSurface;

double outside_m(const ConvexHull& hull, const dvec3& p) {
    double most_m = -1e300;
    for (std::size_t f = 0; f < hull.normal.size(); ++f)
        most_m = std::max(most_m, glm::dot(hull.normal[f], p) - hull.offset_m[f]);
    return most_m;
}

// Pieces cover the surface and stay in the solid.
std::vector<ConvexHull> checked_pieces(const RigidSurface& surface, double slack_m) {
    const auto pieces = haptics::convex_pieces(surface, 2e-3);
    RandomPieces random(60);
    for (const auto& [a, b, c] : surface.triangle) {
        const dvec3 p = (surface.vertex_m[a] + surface.vertex_m[b] + surface.vertex_m[c]) / 3.0;
        CHECK(std::any_of(pieces.begin(), pieces.end(),
                          [&](const ConvexHull& hull) { return outside_m(hull, p) < slack_m; }));
    }
    for (const ConvexHull& hull : pieces) {
        for (int i = 0; i < 200; ++i) {
            const dvec3 p = hull.centre_m + hull.radius_m * random.in_ball();
            if (outside_m(hull, p) < -slack_m)
                CHECK(haptics::winding_number(surface, p) == doctest::Approx(1.0).scale(0.0));
        }
    }
    MESSAGE(surface.name << ": " << surface.triangle.size() << " triangles, " << pieces.size()
                         << " pieces");
    return pieces;
}

} // namespace

TEST_CASE("convex pieces: what is convex is one piece, and nothing of it is inner") {
    const ConvexHull ball = haptics::convex_hull(sphere_surface(0.01, 6).vertex_m, "ball");
    for (const RigidSurface& surface : {cube_surface(0.01), hull_surface("ball", ball)}) {
        const auto pieces = checked_pieces(surface, 1e-6);
        REQUIRE(pieces.size() == 1);
        CHECK(std::count(pieces[0].inner.begin(), pieces[0].inner.end(), 1) == 0);
    }
}

TEST_CASE("convex pieces: L, U and torus are covered, and no hull fills a notch") {
    CHECK(checked_pieces(l_surface(), 1e-5).size() <= 8);
    CHECK(checked_pieces(u_surface(), 1e-5).size() <= 12);
    checked_pieces(torus_surface(0.02, 0.006, 16, 10), 1e-4);
}

TEST_CASE("convex pieces: faces between pieces are inner, faces of the solid are not") {
    for (const RigidSurface& surface : {l_surface(), u_surface()}) {
        for (const ConvexHull& hull : haptics::convex_pieces(surface, 2e-3)) {
            for (std::size_t f = 0; f < hull.normal.size(); ++f) {
                dvec3 middle{0.0};
                for (const std::uint32_t v : hull.corners(f))
                    middle += hull.vertex_m[v] / double(hull.corners(f).size());
                const double beyond =
                    haptics::winding_number(surface, middle + 1e-6 * hull.normal[f]);
                CHECK(hull.inner[f] == (beyond > 0.5));
            }
        }
    }
}

TEST_CASE("convex pieces: an open sheet becomes shells behind it") {
    // two squares in a plane, not convex together with the third: an L
    const std::vector<dvec3> vertex{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0},
                                    {1, 1, 0}, {2, 1, 0}, {0, 2, 0}, {1, 2, 0}};
    const RigidSurface sheet = haptics::make_surface(
        "sheet", vertex,
        Triangles{{0, 1, 4}, {4, 3, 0}, {1, 2, 5}, {5, 4, 1}, {3, 4, 7}, {7, 6, 3}});
    CHECK(!sheet.closed);
    const auto pieces = haptics::convex_pieces(sheet, 0.1);
    CHECK(pieces.size() >= 2);
    for (const ConvexHull& hull : pieces) {
        CHECK(outside_m(hull, {1.9, 1.9, -0.05}) > 0.1); // the notch is free
        for (const dvec3& v : hull.vertex_m)
            CHECK((v.z < 1e-9 && v.z > -0.1 - 1e-9));
    }
    const auto in_some = [&](const dvec3& p) {
        return std::any_of(pieces.begin(), pieces.end(),
                           [&](const ConvexHull& h) { return outside_m(h, p) < 1e-9; });
    };
    CHECK(in_some({0.5, 0.5, -0.05}));
    CHECK(in_some({1.5, 0.5, -0.05}));
    CHECK(in_some({0.5, 1.5, -0.05}));
}

TEST_CASE("surface: what is wrong is named") {
    const RigidSurface cube = cube_surface(1.0);
    auto triangle = cube.triangle;
    triangle[3] = {0, 1, 99};
    CHECK_THROWS_WITH_AS(haptics::make_surface("cube", cube.vertex_m, triangle),
                         "surface cube: triangle 3 names vertex 99 of 8", std::invalid_argument);
    triangle[3] = {0, 1, 1};
    CHECK_THROWS_WITH_AS(haptics::make_surface("cube", cube.vertex_m, triangle),
                         "surface cube: triangle 3 has no area", std::invalid_argument);
    triangle = cube.triangle;
    std::swap(triangle[4][0], triangle[4][1]); // turned inside out
    CHECK_THROWS_AS(haptics::make_surface("cube", cube.vertex_m, triangle), std::invalid_argument);
    CHECK_THROWS_AS(haptics::make_surface("none", {}, {}), std::invalid_argument);
    CHECK_THROWS_AS(haptics::convex_pieces(cube, 0.0), std::invalid_argument);
}

TEST_CASE("surface: inside, outside and the distance of a sphere") {
    const RigidSurface sphere = sphere_surface(0.01, 12);
    RandomPieces random(61);
    for (int i = 0; i < 200; ++i) {
        const dvec3 p = 0.02 * random.in_ball();
        const double r = glm::length(p);
        if (std::abs(r - 0.01) < 2e-4)
            continue;
        // rounding of the solid angles of its triangles, which add up to 4 pi or to nothing
        CHECK(std::abs(haptics::winding_number(sphere, p) - (r < 0.01 ? 1.0 : 0.0)) < 1e-13);
        CHECK(haptics::nearest_point(sphere, p).distance_m ==
              doctest::Approx(std::abs(r - 0.01)).epsilon(0.02).scale(5e-3));
    }
}

TEST_CASE("surface: the distance of a sliver is as exact as any") {
    // at a height over a place inside; corners are rounded, by some bits of a coordinate
    RandomPieces random(62);
    for (const double thin : {1e-3, 1e-6, 1e-9})
        for (int i = 0; i < 200; ++i) {
            const glm::dmat3 turn = random.rotation();
            const dvec3 a = 0.1 * random.in_ball(), along = 0.1 * turn[0],
                        across = 0.03 * turn[0] + 0.1 * thin * turn[1];
            const std::vector<dvec3> vertex{a, a + along, a + across};
            const RigidSurface sliver =
                haptics::make_surface("sliver", vertex, Triangles{{0, 1, 2}});
            const double high_m = random.number(0.0, 0.02);
            const dvec3 place_m = a + random.number(0.0, 0.5) * along +
                                  random.number(0.0, 0.5) * across + high_m * turn[2];
            CHECK(std::abs(haptics::nearest_point(sliver, place_m).distance_m - high_m) < 1e-15);
        }
}
