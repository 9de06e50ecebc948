// tests/bake/tube_test.cpp
// Tubes along a centreline: volumes by formula, skin and tetrahedra of one body, quality.
#include "assets/bake/centreline.h"
#include "assets/bake/nearest.h"
#include "assets/bake/quality.h"
#include "assets/bake/shape_tube.h"

#include "tests/bake/shapes_for_tests.h"

#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

namespace {

using std::numbers::pi;

bake::TubeShape bar(double radius_mm, double radius_end_mm, int sides) {
    return {.point_mm = {{5, 0, 0}, {55, 60, 20}},
            .radius_mm = radius_mm,
            .radius_end_mm = radius_end_mm,
            .sides = sides};
}

// S-shaped, out of plane; tightest bend about three radii.
bake::TubeShape winding(int sides) {
    return {
        .point_mm = {{-50, -8, 0}, {-26, 0, 4}, {-8, 4, 6}, {12, -8, 0}, {30, -9, -6}, {50, 5, 0}},
        .radius_mm = 4.0,
        .radius_end_mm = 4.0,
        .sides = sides};
}

bake::Surface boundary(const tissue::TetMesh& mesh) {
    return {mesh.rest_m, tissue::boundary_triangles(mesh)};
}

} // namespace

TEST_CASE("tube: a straight one has exactly the volume pi r^2 L, in tetrahedra and in skin") {
    const double length_mm = std::sqrt(50.0 * 50 + 60 * 60 + 20 * 20);
    for (const int sides : {5, 6, 8}) {
        const auto shape = bar(4.0, 4.0, sides);
        const double exact = pi * 16.0 * length_mm * 1e-9;
        const auto mesh = bake::tube_mesh(shape, 0.004);
        CHECK(tissue::volume_m3(mesh, mesh.rest_m) == bake_tests::near(exact));
        CHECK(bake::volume_m3(bake::tube_surface(shape, 0.002)) == bake_tests::near(exact));
    }
}

TEST_CASE("tube: one whose radius changes has the volume of a truncated cone") {
    const double length_mm = std::sqrt(50.0 * 50 + 60 * 60 + 20 * 20);
    const double exact = pi / 3.0 * (9.0 + 3.0 * 5.0 + 25.0) * length_mm * 1e-9;
    const auto mesh = bake::tube_mesh(bar(3.0, 5.0, 6), 0.004);
    CHECK(tissue::volume_m3(mesh, mesh.rest_m) == bake_tests::near(exact));
    // rings turn by half a side from one to the next: not quite cones
    CHECK(bake::volume_m3(bake::tube_surface(bar(3.0, 5.0, 6), 0.002)) ==
          bake_tests::near(exact, 0.002));
}

TEST_CASE("tube: bent, it has the volume of Pappus, and skin and tetrahedra are one body") {
    for (const int sides : {6, 8}) {
        const auto shape = winding(sides);
        const auto skin = bake::tube_surface(shape, 0.002);
        const auto mesh = boundary(bake::tube_mesh(shape, 0.0045));
        CHECK(bake::describe(bake::check_surface(skin)).empty());
        CHECK(bake::describe(bake::check_surface(mesh)).empty());
        const double pappus = pi * 16.0 * bake::line_length_mm(shape.point_mm) * 1e-9;
        CHECK(bake::volume_m3(mesh) == bake_tests::near(pappus, 0.02));
        CHECK(bake::volume_m3(skin) == bake_tests::near(pappus, 0.02));
        CHECK(bake::volume_m3(mesh) == bake_tests::near(bake::volume_m3(skin), 0.02));
        // the corners of six sides stand out by a tenth of the radius
        CHECK(bake::sampled_hausdorff_m(skin, bake::NearestOnSurface(mesh)) < 0.15 * 4e-3);
        CHECK(bake::sampled_hausdorff_m(mesh, bake::NearestOnSurface(skin)) < 0.15 * 4e-3);
    }
}

TEST_CASE("tube: its tetrahedra are good and as many as a tube may have") {
    for (const int sides : {6, 8}) {
        const auto mesh = bake::tube_mesh(winding(sides), 0.0045);
        CHECK_NOTHROW(tissue::check_mesh(mesh));
        CHECK(bake::tet_quality(mesh).worst_dihedral_deg >= 15.0);
        CHECK(mesh.rest_m.size() >= 150);
        CHECK(mesh.rest_m.size() <= 250);
    }
}

TEST_CASE("tube: as tight a bend as a recipe may have turns no tetrahedron inside out") {
    for (const double edge_mm : {2.0, 4.5, 8.0}) {
        bake::TubeShape shape{.point_mm = {}, .radius_mm = 1.0, .radius_end_mm = 1.0, .sides = 6};
        for (int i = 0; i <= 16; ++i) { // half a circle of 20 mm and straight on
            shape.point_mm.emplace_back(20.0 * std::cos(pi * i / 16), 20.0 * std::sin(pi * i / 16),
                                        0.0);
        }
        shape.radius_mm = bake::tightest_bend_mm(shape.point_mm) / bake::kTightestBend;
        shape.radius_end_mm = shape.radius_mm;
        CHECK_NOTHROW(tissue::check_mesh(bake::tube_mesh(shape, 1e-3 * edge_mm)));
    }
}

TEST_CASE("tube: the same line gives the same bits") {
    CHECK(bake::tube_mesh(winding(6), 0.0045).rest_m == bake::tube_mesh(winding(6), 0.0045).rest_m);
    CHECK(bake::tube_surface(winding(6), 0.002).point_m ==
          bake::tube_surface(winding(6), 0.002).point_m);
}
