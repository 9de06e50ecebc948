// tests/bake/ground_test.cpp
// The ground under the organs: its outline, its depth, its bits.
#include "assets/bake/shape_ground.h"

#include "tests/bake/shapes_for_tests.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/vector_relational.hpp>
#include <numbers>
#include <random>

namespace {

bake::GroundShape cavity(std::uint64_t seed = 5) {
    return {
        .centre_mm = {3, -2, 7},
        .size_mm = {240, 200},
        .bowl_mm = 30.0,
        .flat_mm = 15.0,
        .noise_mm = 3.0,
        .noise_wavelength_mm = 50.0,
        .seed = seed,
        .pits = {{.centre_mm = {10, 5}, .radius_mm = {40, 25}, .depth_mm = 20.0, .wall_mm = 12.0}}};
}

/// The other way: the nearest of many places on the ellipse.
double sampled_distance(const glm::dvec2& p, const glm::dvec2& r) {
    double least = 1e9;
    constexpr int kPlaces = 5000;
    for (int i = 0; i < kPlaces; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kPlaces;
        least = std::min(least, glm::length(p - r * glm::dvec2{std::cos(angle), std::sin(angle)}));
    }
    return glm::length(p / r) < 1.0 ? -least : least;
}

std::vector<glm::dvec2> places(const bake::GroundShape& g, int count) {
    std::mt19937_64 random(11);
    const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; };
    std::vector<glm::dvec2> list;
    for (int i = 0; i < count; ++i) {
        const double x = share(), y = share();
        list.push_back(glm::dvec2{g.centre_mm} + g.size_mm * glm::dvec2{x, y});
    }
    return list;
}

} // namespace

TEST_CASE("ground: the distance from an ellipse is that of the nearest of its places") {
    for (const glm::dvec2 r : {glm::dvec2{40, 25}, glm::dvec2{20, 20}, glm::dvec2{15, 45}}) {
        // half the way between two of 5000 places, on the ellipse itself
        const double slack = 0.5 * 2.0 * std::numbers::pi * std::max(r.x, r.y) / 5000;
        for (const auto& p : places(cavity(), 200)) {
            CHECK(std::abs(bake::ellipse_distance(p, r) - sampled_distance(p, r)) <= slack);
        }
        CHECK(bake::ellipse_distance({0, 0}, r) == bake_tests::near(-std::min(r.x, r.y)));
        CHECK(bake::ellipse_distance({0, 70}, r) == bake_tests::near(70 - r.y));
        CHECK(bake::ellipse_distance({-70, 0}, r) == bake_tests::near(70 - r.x));
    }
}

TEST_CASE("ground: flat from the rim to flat_mm beyond it, and as deep as asked within the walls") {
    const auto g = cavity();
    const auto& pit = g.pits[0];
    int flat = 0, floor = 0, rough = 0;
    for (const auto& p : places(g, 2000)) {
        const double d = sampled_distance(p - pit.centre_mm, pit.radius_mm);
        const double z = bake::ground_height_mm(g, p);
        if (d > 0.1 && d < g.flat_mm - 0.1) {
            CHECK(std::abs(z - g.centre_mm.z) < 1e-9);
            ++flat;
        } else if (d < -pit.wall_mm - 0.1) {
            CHECK(z == bake_tests::near(g.centre_mm.z - pit.depth_mm));
            ++floor;
        } else if (d > g.flat_mm + 10.0) {
            rough += std::abs(z - g.centre_mm.z) > 0.5 ? 1 : 0;
        }
    }
    CHECK(flat > 100);
    CHECK(floor > 20);
    CHECK(rough > 500);
    // half the way down at half the wall: the step is symmetric
    CHECK(bake::ground_height_mm(g, pit.centre_mm + glm::dvec2{40.0 - 6.0, 0.0}) ==
          bake_tests::near(g.centre_mm.z - 0.5 * pit.depth_mm));
}

TEST_CASE("ground: its edges rise by the bowl, within the noise") {
    const auto g = cavity();
    for (const glm::dvec2 side : {glm::dvec2{1, 0}, glm::dvec2{-1, 0}, glm::dvec2{0, -1}}) {
        const auto at = glm::dvec2{g.centre_mm} + 0.5 * g.size_mm * side;
        CHECK(std::abs(bake::ground_height_mm(g, at) - g.centre_mm.z - g.bowl_mm) <=
              g.noise_mm + 1e-9);
    }
}

TEST_CASE("ground: one open sheet over the whole rectangle that faces the camera") {
    const auto g = cavity();
    const auto s = bake::ground_surface(g, 0.006);
    const auto problems = bake::check_surface(s);
    CHECK(problems.refused_triangles == 0);
    CHECK(problems.pinched_vertices == 0);
    CHECK(problems.flat_triangles == 0);
    CHECK(problems.shells == 1);
    double plane_m2 = 0.0, longest_m = 0.0, longest_in_pit_m = 0.0;
    for (const auto& t : s.triangles) {
        const auto a = s.point_m[t[0]], b = s.point_m[t[1]], c = s.point_m[t[2]];
        const double up_m2 = 0.5 * glm::cross(b - a, c - a).z;
        CHECK(up_m2 > 0.0);
        plane_m2 += up_m2;
        const double edge_m = glm::length(glm::dvec2{b - a});
        longest_m = std::max(longest_m, edge_m);
        if (bake::ellipse_distance(1e3 * glm::dvec2{a} - g.pits[0].centre_mm, {40, 25}) < -3.0) {
            longest_in_pit_m = std::max(longest_in_pit_m, edge_m);
        }
    }
    CHECK(plane_m2 == bake_tests::near(0.240 * 0.200));
    CHECK(longest_m < 0.006 * 1.42); // a diagonal
    CHECK(longest_in_pit_m < 0.003 * 1.42);
}

TEST_CASE("ground: the same seed gives the same bits, another one another ground") {
    const auto a = bake::ground_surface(cavity(5), 0.008);
    CHECK(a.point_m == bake::ground_surface(cavity(5), 0.008).point_m);
    CHECK(a.point_m != bake::ground_surface(cavity(6), 0.008).point_m);
}
