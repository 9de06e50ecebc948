#include "assets/bake/surface.h"

#include "tests/bake/shapes_for_tests.h"

#include <cmath>
#include <doctest/doctest.h>
#include <stdexcept>

using bake_tests::tetrahedron;

TEST_CASE("surface: a tetrahedron is closed, manifold and one sixth of a cube") {
    const auto problems = bake::check_surface(tetrahedron());
    CHECK(bake::describe(problems).empty());
    CHECK(bake::volume_m3(tetrahedron()) == bake_tests::near(1.0 / 6.0));
    CHECK(bake::area_m2(tetrahedron()) == bake_tests::near(1.5 + std::sqrt(3.0) / 2.0));
}

TEST_CASE("surface: a missing triangle leaves three open edges") {
    auto s = tetrahedron();
    s.triangles.pop_back();
    CHECK(bake::check_surface(s).open_edges == 3);
}

TEST_CASE("surface: a triangle turned against its neighbours is refused and named") {
    auto s = tetrahedron();
    std::swap(s.triangles[3][0], s.triangles[3][1]);
    CHECK(bake::check_surface(s).refused_triangles == 1);
    CHECK_THROWS_WITH_AS(bake::make_half_edges(s), doctest::Contains("triangle 3"),
                         std::invalid_argument);
}

TEST_CASE("surface: a third triangle on an edge is refused") {
    auto s = tetrahedron();
    s.point_m.emplace_back(-1, -1, -1);
    s.triangles.push_back({0, 1, 4});
    CHECK(bake::check_surface(s).refused_triangles == 1);
}

TEST_CASE("surface: a corner used twice is refused") {
    auto s = tetrahedron();
    s.triangles.push_back({2, 2, 3});
    CHECK(bake::check_surface(s).refused_triangles == 1);
}

TEST_CASE("surface: two bodies are counted") {
    auto s = tetrahedron();
    for (const auto& p : tetrahedron().point_m) {
        s.point_m.push_back(p + glm::dvec3{5, 0, 0});
    }
    for (const auto& t : tetrahedron().triangles) {
        s.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
    }
    CHECK(bake::check_surface(s).shells == 2);
    CHECK(bake::describe(bake::check_surface(s)).size() == 1);
}

TEST_CASE("surface: a body turned inside out is noticed") {
    auto s = tetrahedron();
    for (auto& t : s.triangles) {
        std::swap(t[1], t[2]);
    }
    CHECK(bake::check_surface(s).inside_out);
}

TEST_CASE("surface: a triangle without height is counted") {
    auto s = tetrahedron();
    s.point_m[3] = {0.5, 0.0, 1e-7}; // on the edge from 0 to 1, but for a hair
    CHECK(bake::check_surface(s).flat_triangles == 1);
}

TEST_CASE("surface: half edges and back keep points and triangles") {
    const auto s = tetrahedron();
    const auto back = bake::make_surface(bake::make_half_edges(s));
    CHECK(back.point_m == s.point_m);
    CHECK(back.triangles.size() == s.triangles.size());
    CHECK(bake::volume_m3(back) == bake_tests::near(1.0 / 6.0));
}

TEST_CASE("surface: the normals of a sphere point away from its centre") {
    const auto s = bake_tests::sphere(0.03, 0.003);
    const auto normal = bake::vertex_normals(s);
    double worst = 1.0;
    for (std::size_t i = 0; i < normal.size(); ++i) {
        worst = std::min(worst, glm::dot(normal[i], glm::normalize(s.point_m[i])));
    }
    CHECK(worst > 0.98); // cells of a tenth of the radius: within about 0.1 rad
}
