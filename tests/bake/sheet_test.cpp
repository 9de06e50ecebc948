// tests/bake/sheet_test.cpp
// Sheets and flaps: volume, skin and tetrahedra of one body, quality.
#include "assets/bake/nearest.h"
#include "assets/bake/quality.h"
#include "assets/bake/shape_sheet.h"

#include "tests/bake/shapes_for_tests.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <rapidcheck.h>

namespace {

bake::SheetShape flap(std::uint64_t seed = 4) {
    return {.centre_mm = {2, -3, 10},
            .size_mm = {90, 70, 5},
            .cells = {11, 8, 1},
            .corner_mm = 8.0,
            .edge_thickness_mm = 3.0,
            .taper_mm = 12.0,
            .bulge_mm = 2.0,
            .noise_mm = 1.0,
            .seed = seed};
}

bake::SheetShape plain() {
    return {.centre_mm = {2, -3, 10},
            .size_mm = {90, 70, 5},
            .cells = {9, 7, 1},
            .edge_thickness_mm = 5.0};
}

bake::Surface boundary(const tissue::TetMesh& mesh) {
    return {mesh.rest_m, tissue::boundary_triangles(mesh)};
}

} // namespace

TEST_CASE("sheet: without rounding, taper, bulge and noise it is a box of exactly its volume") {
    const auto s = plain();
    const auto mesh = bake::sheet_mesh(s);
    CHECK(mesh.rest_m.size() == 10 * 8 * 2);
    CHECK(mesh.tets.size() == 9 * 7 * 6);
    CHECK(tissue::volume_m3(mesh, mesh.rest_m) == bake_tests::near(90 * 70 * 5 * 1e-9));
    CHECK(bake::volume_m3(bake::sheet_surface(s, 0.003)) == bake_tests::near(90 * 70 * 5 * 1e-9));
    CHECK(bake::volume_m3(boundary(mesh)) == bake_tests::near(90 * 70 * 5 * 1e-9)); // no cracks
}

TEST_CASE("sheet: skin and tetrahedra of other fineness are one body") {
    const auto s = flap();
    const auto skin = bake::sheet_surface(s, 0.003);
    const auto mesh = boundary(bake::sheet_mesh(s));
    CHECK(bake::describe(bake::check_surface(skin)).empty());
    CHECK(bake::describe(bake::check_surface(mesh)).empty());
    CHECK(std::abs(bake::volume_m3(mesh) / bake::volume_m3(skin) - 1.0) < 0.02);
    // a tenth of the thickness
    CHECK(bake::sampled_hausdorff_m(skin, bake::NearestOnSurface(mesh)) < 0.5e-3);
    CHECK(bake::sampled_hausdorff_m(mesh, bake::NearestOnSurface(skin)) < 0.5e-3);
}

TEST_CASE("sheet: no tetrahedron is inside out, whatever a recipe may ask for") {
    CHECK(rc::check([] {
        const auto share = [] { return *rc::gen::inRange(0, 101) * 0.01; };
        bake::SheetShape s;
        s.size_mm = {40.0 + 80.0 * share(), 40.0 + 80.0 * share(), 2.0 + 6.0 * share()};
        s.cells = {*rc::gen::inRange(1, 15), *rc::gen::inRange(1, 15), *rc::gen::inRange(1, 4)};
        const double half = std::min(0.5 * s.size_mm.x, s.size_mm.y);
        s.corner_mm = share() * half / bake::kCornerReach;
        s.edge_thickness_mm = s.size_mm.z * (0.3 + 0.7 * share());
        s.taper_mm = 0.5 + share() * (half - 0.5);
        s.bulge_mm = 10.0 * share();
        s.noise_mm = 3.0 * share();
        s.seed = *rc::gen::inRange(0, 1000);
        const auto mesh = bake::sheet_mesh(s);
        tissue::check_mesh(mesh);
        RC_ASSERT(bake::describe(bake::check_surface(bake::sheet_surface(s, 0.004))).empty());
    }));
}

TEST_CASE("sheet: cells wider than its taper leave out little of it, and none is a sliver") {
    auto s = flap();
    const double skin_m3 = bake::volume_m3(bake::sheet_surface(s, 0.002));
    for (const auto& cells : {std::array{9, 7, 1}, std::array{8, 7, 1}, std::array{7, 6, 1}}) {
        s.cells = cells;
        const auto mesh = bake::sheet_mesh(s);
        CHECK(std::abs(tissue::volume_m3(mesh, mesh.rest_m) / skin_m3 - 1.0) < 0.02);
    }
    s.taper_mm = 1.0;
    CHECK(bake::tet_quality(bake::sheet_mesh(s)).worst_dihedral_deg >= 6.0);
    for (const auto& cells : {std::array{1, 1, 1}, std::array{2, 1, 1}, std::array{2, 2, 1}}) {
        s.cells = cells; // no line is beside a free edge alone
        CHECK(tissue::volume_m3(bake::sheet_mesh(s), bake::sheet_mesh(s).rest_m) > 0.0);
    }
}

TEST_CASE("sheet: its tetrahedra are good, in both rounded corners too") {
    const auto mesh = bake::sheet_mesh(flap());
    CHECK(bake::tet_quality(mesh).worst_dihedral_deg >= 15.0);
    auto mirrored = flap();
    mirrored.cells = {10, 8, 1};
    mirrored.noise_mm = 0.0;
    // even cells without noise: every node has its image in the middle plane, and so has each tet
    const auto even = bake::sheet_mesh(mirrored);
    double left_m3 = 0.0;
    for (const auto& t : even.tets) {
        const auto& x = even.rest_m;
        const double six =
            glm::dot(glm::cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]);
        const double side = x[t[0]].x + x[t[1]].x + x[t[2]].x + x[t[3]].x - 4.0 * 0.002;
        left_m3 += side < 0.0 ? six / 6.0 : 0.0;
    }
    CHECK(left_m3 == bake_tests::near(0.5 * tissue::volume_m3(even, even.rest_m)));
}

TEST_CASE("sheet: bulge and noise go up only; the free edges are thin, the corners cut") {
    const auto s = flap();
    const auto skin = bake::sheet_surface(s, 0.003);
    double low = 1e9, left = 1e9, left_at_end = 1e9;
    for (const auto& p : skin.point_m) {
        const glm::dvec3 q = 1e3 * p - s.centre_mm;
        low = std::min(low, q.z);
        left = std::min(left, q.x);
        if (q.y < -35.0 + 8.0 + 1e-6) {
            left_at_end = std::min(left_at_end, q.x);
        }
    }
    CHECK(low >= -2.5 - 1e-9);
    CHECK(left == bake_tests::near(-45.0));
    // the corner itself lies corner_mm inwards of both edges
    CHECK(left_at_end == bake_tests::near(-45.0 + 8.0, 0.02));
    // above the middle of the free edge: edge thickness, and between 0 and noise_mm of lift
    double top = -1e9;
    for (const auto& p : skin.point_m) {
        const glm::dvec3 q = 1e3 * p - s.centre_mm;
        if (q.y < -35.0 + 1e-6) {
            top = std::max(top, q.z);
        }
    }
    CHECK(top >= -2.5 + 3.0 - 1e-9);
    CHECK(top <= -2.5 + 3.0 + 1.0 + 1e-9);
}

TEST_CASE("sheet: a turn of 90 degrees about z brings the attached edge from +y to -x") {
    auto s = flap();
    const auto before = bake::sheet_mesh(s);
    s.tilt_deg = {0, 0, 90};
    const auto after = bake::sheet_mesh(s);
    for (std::size_t i = 0; i < before.rest_m.size(); ++i) {
        const glm::dvec3 a = before.rest_m[i] - 1e-3 * s.centre_mm,
                         b = after.rest_m[i] - 1e-3 * s.centre_mm;
        CHECK(glm::length(b - glm::dvec3{-a.y, a.x, a.z}) < 1e-12);
    }
}

TEST_CASE("sheet: the same seed gives the same bits, another one another sheet") {
    const auto a = bake::sheet_mesh(flap(4));
    CHECK(a.rest_m == bake::sheet_mesh(flap(4)).rest_m);
    CHECK(a.tets == bake::sheet_mesh(flap(4)).tets);
    CHECK(a.rest_m != bake::sheet_mesh(flap(5)).rest_m);
}
