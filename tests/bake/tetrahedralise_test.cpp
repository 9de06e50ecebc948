#include "assets/bake/tetrahedralise.h"

#include "assets/bake/quality.h"
#include "assets/bake/remesh.h"
#include "tests/bake/shapes_for_tests.h"

#include <algorithm>
#include <doctest/doctest.h>

TEST_CASE("tetrahedralise: a box keeps its volume and its boundary, triangle for triangle") {
    const auto s = bake::remesh(bake::box_surface({0.08, 0.08, 0.04}, 0.02),
                                bake_tests::even(0.015), {.crease_deg = 40.0});
    const auto answer = bake::tetrahedralise(s, {.edge_m = 0.015});
    REQUIRE(answer.mesh);
    tissue::check_mesh(*answer.mesh);
    CHECK(answer.attempts.size() == 1);
    CHECK(tissue::volume_m3(*answer.mesh, answer.mesh->rest_m) ==
          bake_tests::near(0.08 * 0.08 * 0.04, 1e-9));
    CHECK(tissue::boundary_triangles(*answer.mesh).size() == s.triangles.size());
    CHECK(bake::tet_quality(*answer.mesh).worst_dihedral_deg > 8.0);
}

TEST_CASE("tetrahedralise: a hopeless time limit ends in a refusal that says so three times") {
    const auto s = bake::box_surface({0.08, 0.08, 0.04}, 0.02);
    const auto answer = bake::tetrahedralise(s, {.time_limit_s = 1e-6});
    CHECK_FALSE(answer.mesh);
    REQUIRE(answer.attempts.size() == 3);
    for (const auto& a : answer.attempts) {
        CHECK(a.outcome == "not done within 1e-06 s");
    }
}

TEST_CASE("tetrahedralise: a surface through itself is refused and the count of its triangles") {
    auto s = bake_tests::tetrahedron();
    for (const auto& p : bake_tests::tetrahedron().point_m) { // the same, pushed half into itself
        s.point_m.push_back(p + glm::dvec3{0.2, 0.15, 0.1});
    }
    for (const auto& t : bake_tests::tetrahedron().triangles) {
        s.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
    }
    const auto answer = bake::tetrahedralise(s, {.edge_m = 0.5, .time_limit_s = 20.0});
    CHECK_FALSE(answer.mesh);
    REQUIRE(answer.attempts.size() == 3);
    // the slanted face of the first cuts the three faces at right angles of the second
    CHECK(answer.problem == "4 triangles of the surface intersect others");
}
