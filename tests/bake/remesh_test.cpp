#include "assets/bake/remesh.h"

#include "assets/bake/fit.h"
#include "assets/bake/nearest.h"
#include "tests/bake/shapes_for_tests.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

namespace {

struct Edges {
    double shortest = 1e9, longest = 0.0, mean = 0.0;
};
Edges edges_of(const bake::Surface& s) {
    Edges e;
    for (const auto& t : s.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const double length = glm::length(s.point_m[t[k]] - s.point_m[t[(k + 1) % 3]]);
            e.shortest = std::min(e.shortest, length);
            e.longest = std::max(e.longest, length);
            e.mean += length / (3.0 * static_cast<double>(s.triangles.size()));
        }
    }
    return e;
}

double smallest_angle_deg(const bake::Surface& s) {
    double smallest = 180.0;
    for (const auto& t : s.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = s.point_m[t[k]], b = s.point_m[t[(k + 1) % 3]],
                       c = s.point_m[t[(k + 2) % 3]];
            const double cosine = glm::dot(glm::normalize(b - a), glm::normalize(c - a));
            smallest = std::min(smallest, std::acos(cosine) * 180.0 / std::numbers::pi);
        }
    }
    return smallest;
}

// A lens with a thin rim: two balls cut with one another.
bake::Surface lens() {
    const auto field = [](const glm::dvec3& p) {
        const glm::dvec3 up{0, 0, 0.05};
        return std::max(glm::length(p - up), glm::length(p + up)) - 0.07;
    };
    return bake::polygonise(field, glm::dvec3{-0.06, -0.06, -0.03}, glm::dvec3{0.06, 0.06, 0.03},
                            0.0025);
}

} // namespace

TEST_CASE("remesh: a sphere gets even edges of the asked length, and stays a sphere") {
    const auto shape = bake_tests::sphere(0.03, 0.002);
    const auto s = bake::remesh(shape, bake_tests::even(0.005), {});
    CHECK(bake::describe(bake::check_surface(s)).empty());
    const auto e = edges_of(s);
    CHECK(e.mean == bake_tests::near(0.005, 0.1));
    CHECK(e.shortest > 0.5 * 0.005);
    CHECK(e.longest < 1.6 * 0.005);
    CHECK(smallest_angle_deg(s) > 30.0);
    for (const auto& p : s.point_m) {
        CHECK(glm::length(p) == bake_tests::near(0.03, 0.002)); // sagitta of the cells
    }
}

TEST_CASE("remesh: the wanted length may vary over the body") {
    const auto shape = bake_tests::sphere(0.03, 0.002);
    const auto size = [](const glm::dvec3& p) { return p.z > 0.0 ? 0.003 : 0.008; };
    const auto s = bake::remesh(shape, size, {});
    double top = 0.0, bottom = 0.0;
    int tops = 0, bottoms = 0;
    for (const auto& t : s.triangles) {
        const double length = glm::length(s.point_m[t[0]] - s.point_m[t[1]]);
        const double z = s.point_m[t[0]].z;
        if (z > 0.01) {
            top += length, ++tops;
        } else if (z < -0.01) {
            bottom += length, ++bottoms;
        }
    }
    CHECK(top / tops == bake_tests::near(0.003, 0.15));
    CHECK(bottom / bottoms == bake_tests::near(0.008, 0.15));
}

TEST_CASE("remesh: a box keeps its edges, corners and volume exactly") {
    const glm::dvec3 size{0.08, 0.08, 0.04};
    const auto s =
        bake::remesh(bake::box_surface(size, 0.02), bake_tests::even(0.007), {.crease_deg = 40.0});
    CHECK(bake::describe(bake::check_surface(s)).empty());
    CHECK(bake::volume_m3(s) == bake_tests::near(size.x * size.y * size.z, 1e-12));
    CHECK(bake::area_m2(s) == bake_tests::near(2 * 0.08 * 0.08 + 4 * 0.08 * 0.04, 1e-12));
    CHECK(edges_of(s).mean == bake_tests::near(0.007, 0.1));
}

TEST_CASE("remesh: without creases a box loses its corners, so the creases are what keeps them") {
    const glm::dvec3 size{0.08, 0.08, 0.04};
    const auto s = bake::remesh(bake::box_surface(size, 0.02), bake_tests::even(0.007), {});
    CHECK(bake::volume_m3(s) < 0.999 * size.x * size.y * size.z);
}

TEST_CASE("remesh: the same surface gives the same triangles") {
    const auto shape = bake_tests::sphere(0.03, 0.004);
    const auto a = bake::remesh(shape, bake_tests::even(0.006), {});
    const auto b = bake::remesh(shape, bake_tests::even(0.006), {});
    CHECK(a.point_m == b.point_m);
    CHECK(a.triangles == b.triangles);
}

TEST_CASE("curvature size: a sphere wants edges of so many radii") {
    const auto shape = bake_tests::sphere(0.02, 0.001);
    const auto even = bake::remesh(shape, bake_tests::even(0.002), {});
    const auto size = bake::curvature_size(even, 0.1, 0.5, 0.01);
    // half a radius is 10 mm; the curvature of a triangulated sphere scatters
    CHECK(size({0.02, 0.0, 0.0}) == bake_tests::near(0.01, 0.25));
    // and never longer than asked, nor shorter than the share
    CHECK(bake::curvature_size(even, 0.004, 0.5, 0.01)({0.02, 0, 0}) == bake_tests::near(0.004));
    CHECK(bake::curvature_size(even, 0.1, 0.001, 0.3)({0.02, 0, 0}) == bake_tests::near(0.03));
}

TEST_CASE("fit: coarse triangles inside a sphere grow to its volume") {
    const auto shape = bake_tests::sphere(0.03, 0.002);
    const auto skin = bake::remesh(shape, bake_tests::even(0.003), {});
    auto coarse = bake::remesh(skin, bake_tests::even(0.014), {});
    const double exact = bake::volume_m3(skin);
    CHECK(bake::volume_m3(coarse) < 0.95 * exact);
    bake::fit_to_skin(skin, 20, 180.0, coarse);
    CHECK(bake::volume_m3(coarse) == bake_tests::near(exact, 0.02));
}

TEST_CASE("fit: a thin rim comes back to where it was") {
    const auto skin = bake::remesh(lens(), bake_tests::even(0.003), {});
    auto coarse = bake::remesh(skin, bake_tests::even(0.012), {});
    const bake::NearestOnSurface before(coarse);
    const double away = bake::sampled_hausdorff_m(skin, before);
    bake::fit_to_skin(skin, 20, 180.0, coarse);
    const bake::NearestOnSurface after(coarse);
    CHECK(bake::sampled_hausdorff_m(skin, after) < 0.6 * away);
}

TEST_CASE("fit: what is round is no crease where only the coarse triangles bend by as much") {
    const auto skin = bake::remesh(bake_tests::sphere(0.03, 0.002), bake_tests::even(0.003),
                                   {.crease_deg = 30.0});
    const double exact = bake::volume_m3(skin);
    auto coarse = bake::remesh(skin, bake_tests::even(0.028), {.crease_deg = 180.0});
    int bends = 0;
    const auto mesh = bake::make_half_edges(coarse);
    for (const auto e : mesh.edges())
        bends +=
            std::abs(mesh.calc_dihedral_angle(mesh.halfedge_handle(e, 0))) > std::numbers::pi / 6
                ? 1
                : 0;
    REQUIRE(bends > 10);
    REQUIRE(bake::volume_m3(coarse) < 0.85 * exact);
    bake::fit_to_skin(skin, 20, 30.0, coarse);
    CHECK(bake::volume_m3(coarse) == bake_tests::near(exact, 0.03));
}

TEST_CASE("fit: points on a crease of the skin stay, and only they") {
    // a ball cut in half: its rim is a crease, its dome is none
    const glm::dvec3 reach{0.036};
    const auto half = bake::remesh(
        bake::polygonise([](const glm::dvec3& p) { return std::max(glm::length(p) - 0.03, -p.z); },
                         -reach, reach, 0.001),
        bake_tests::even(0.0025), {.crease_deg = 180.0});
    const auto skin = bake::remesh(half, bake_tests::even(0.0025), {.crease_deg = 45.0});
    const auto coarse = bake::remesh(skin, bake_tests::even(0.016), {.crease_deg = 45.0});
    auto fitted = coarse;
    bake::fit_to_skin(skin, 20, 45.0, fitted);
    int stayed = 0, moved = 0;
    for (std::size_t v = 0; v < coarse.point_m.size(); ++v) {
        const double by_m = glm::length(fitted.point_m[v] - coarse.point_m[v]);
        const glm::dvec3& p = coarse.point_m[v];
        stayed += by_m == 0.0 ? 1 : 0;
        if (p.z > 0.01) // well above the rim
            CHECK(by_m > 0.0);
        moved += by_m > 0.0 ? 1 : 0;
    }
    CHECK(stayed >= 6);
    CHECK(moved > 5);
}
