#include "assets/bake/quality.h"

#include "tests/bake/shapes_for_tests.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

tissue::TetMesh one_tet(const std::array<glm::dvec3, 4>& corner) {
    return {{corner.begin(), corner.end()}, {{0, 1, 2, 3}}};
}

} // namespace

TEST_CASE("quality: a regular tetrahedron has six angles of acos(1/3) and aspect 1") {
    const std::array<glm::dvec3, 4> corner{{{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}}};
    for (const double angle : bake::dihedrals_rad(corner)) {
        CHECK(angle == bake_tests::near(std::acos(1.0 / 3.0)));
    }
    auto mesh = one_tet(corner);
    tissue::check_mesh(mesh);
    CHECK(bake::tet_quality(mesh).worst_aspect == bake_tests::near(1.0));
}

TEST_CASE("quality: the corner of a cube has three right angles and three of acos(1/sqrt 3)") {
    const std::array<glm::dvec3, 4> corner{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    auto angle = bake::dihedrals_rad(corner);
    std::sort(angle.begin(), angle.end());
    CHECK(angle[0] == bake_tests::near(std::acos(1.0 / std::sqrt(3.0))));
    CHECK(angle[2] == bake_tests::near(angle[0]));
    CHECK(angle[3] == bake_tests::near(std::numbers::pi / 2));
    CHECK(angle[5] == bake_tests::near(std::numbers::pi / 2));
    // longest edge sqrt 2, smallest height 1/sqrt 3 (over the slanted face)
    const auto q = bake::tet_quality(one_tet(corner));
    CHECK(q.worst_aspect == bake_tests::near(std::sqrt(2.0) * std::sqrt(3.0) * std::sqrt(2.0 / 3)));
    CHECK(q.worst_dihedral_deg == bake_tests::near(std::acos(1.0 / std::sqrt(3.0)) * kDegPerRad));
    CHECK(q.largest_dihedral_deg == bake_tests::near(90.0));
}

TEST_CASE("improve: a jittered box gets better and keeps its boundary and volume") {
    auto mesh = tissue::box_mesh({0.04, 0.04, 0.04}, {4, 4, 4}, 0.35, 5);
    const auto before = mesh;
    const double worst = bake::tet_quality(mesh).worst_dihedral_deg;
    bake::improve_inner_nodes(mesh, 3);
    tissue::check_mesh(mesh);
    CHECK(bake::tet_quality(mesh).worst_dihedral_deg > 1.5 * worst);
    for (const auto& triangle : tissue::boundary_triangles(before)) {
        for (const auto v : triangle) {
            CHECK(mesh.rest_m[v] == before.rest_m[v]);
        }
    }
    CHECK(tissue::volume_m3(mesh, mesh.rest_m) == bake_tests::near(0.04 * 0.04 * 0.04));
}
