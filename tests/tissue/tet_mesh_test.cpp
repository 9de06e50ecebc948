// tests/tissue/tet_mesh_test.cpp
#include "tissue/mesh/tet_mesh.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <set>
#include <stdexcept>
#include <string>

using glm::dvec3;

namespace {

std::string message_of(const tissue::TetMesh& mesh) {
    try {
        tissue::check_mesh(mesh);
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return "";
}

} // namespace

TEST_CASE("a box mesh fills its box, jittered or not") {
    for (const double jitter : {0.0, 0.15}) {
        const tissue::TetMesh mesh = tissue::box_mesh({0.08, 0.06, 0.04}, {4, 3, 5}, jitter);
        tissue::check_mesh(mesh);
        CHECK(mesh.rest_m.size() == 5 * 4 * 6);
        CHECK(mesh.tets.size() == 6 * 4 * 3 * 5);
        CHECK(tissue::volume_m3(mesh, mesh.rest_m) ==
              doctest::Approx(0.08 * 0.06 * 0.04).scale(0.0).epsilon(1e-13));
    }
}

TEST_CASE("jitter moves every interior node by at most its share, the same for the same seed") {
    const dvec3 cell{0.01};
    const tissue::TetMesh plain = tissue::box_mesh({0.04, 0.04, 0.04}, {4, 4, 4});
    const tissue::TetMesh moved = tissue::box_mesh({0.04, 0.04, 0.04}, {4, 4, 4}, 0.2, 7);
    const tissue::TetMesh again = tissue::box_mesh({0.04, 0.04, 0.04}, {4, 4, 4}, 0.2, 7);
    const tissue::TetMesh other = tissue::box_mesh({0.04, 0.04, 0.04}, {4, 4, 4}, 0.2, 8);
    int shifted = 0;
    for (std::size_t i = 0; i < plain.rest_m.size(); ++i) {
        const dvec3 shift = glm::abs(moved.rest_m[i] - plain.rest_m[i]);
        CHECK(std::max({shift.x, shift.y, shift.z}) <= 0.2 * cell.x * (1 + 1e-12));
        shifted += glm::length(shift) > 0.0;
    }
    CHECK(shifted == 3 * 3 * 3);
    CHECK(moved.rest_m == again.rest_m);
    CHECK(moved.rest_m != other.rest_m);
}

TEST_CASE("the boundary of a box is closed, faces out and has the area of the box") {
    const dvec3 size{0.08, 0.06, 0.04};
    const tissue::TetMesh mesh = tissue::box_mesh(size, {4, 3, 2}, 0.1);
    const auto triangles = tissue::boundary_triangles(mesh);
    CHECK(triangles.size() == 2 * 2 * (4 * 3 + 3 * 2 + 4 * 2));

    double area = 0.0, six_volumes = 0.0;
    dvec3 sum{0.0};
    for (const tissue::Triangle& t : triangles) {
        const dvec3 a = mesh.rest_m[t[0]], b = mesh.rest_m[t[1]], c = mesh.rest_m[t[2]];
        const dvec3 twice = glm::cross(b - a, c - a);
        area += glm::length(twice) / 2;
        sum += twice;
        six_volumes += glm::dot(a, glm::cross(b, c)); // divergence theorem: > 0 if outward
    }
    CHECK(area ==
          doctest::Approx(2 * (size.x * size.y + size.y * size.z + size.x * size.z)).scale(0.0));
    CHECK(glm::length(sum) < 1e-15);
    CHECK(six_volumes / 6 == doctest::Approx(size.x * size.y * size.z).scale(0.0));
}

TEST_CASE("all four faces of a lone tet look away from the opposite corner") {
    const tissue::TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
    const auto triangles = tissue::boundary_triangles(mesh);
    REQUIRE(triangles.size() == 4);
    for (const tissue::Triangle& t : triangles) {
        const std::uint32_t apex = 6 - t[0] - t[1] - t[2];
        const dvec3 a = mesh.rest_m[t[0]], b = mesh.rest_m[t[1]], c = mesh.rest_m[t[2]];
        CHECK(glm::dot(glm::cross(b - a, c - a), mesh.rest_m[apex] - a) < 0.0);
    }
}

TEST_CASE("volume follows the determinant of an affine map") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.03, 0.02, 0.02}, {3, 2, 2});
    std::vector<dvec3> x;
    for (const dvec3& p : mesh.rest_m)
        x.push_back({1.1 * p.x + 0.3 * p.y, 0.9 * p.y, 1.2 * p.z});
    CHECK(tissue::volume_m3(mesh, x) ==
          doctest::Approx(1.1 * 0.9 * 1.2 * 0.03 * 0.02 * 0.02).scale(0.0).epsilon(1e-13));
}

TEST_CASE("a mesh with a bad tet is refused by its number") {
    tissue::TetMesh mesh = tissue::box_mesh({0.02, 0.02, 0.02}, {2, 2, 2});
    CHECK(message_of(mesh).empty());

    tissue::TetMesh inside_out = mesh;
    std::swap(inside_out.tets[17][0], inside_out.tets[17][1]);
    CHECK(message_of(inside_out).find("tet 17 ") != std::string::npos);

    tissue::TetMesh out_of_range = mesh;
    out_of_range.tets[5][2] = 27;
    CHECK(message_of(out_of_range).find("tet 5 names node 27 of 27") != std::string::npos);
}

TEST_CASE("a box without cells is refused") {
    CHECK_THROWS_AS(tissue::box_mesh({0.1, 0.1, 0.1}, {3, 0, 3}), std::invalid_argument);
    CHECK_THROWS_AS(tissue::box_mesh({0.1, -0.1, 0.1}, {3, 3, 3}), std::invalid_argument);
}
