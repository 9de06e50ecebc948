// tests/tissue/corotated_model_test.cpp
#include "tests/tissue/bodies.h"

#include <doctest/doctest.h>
#include <numeric>
#include <stdexcept>
#include <string>

TEST_CASE("masses add up to density times volume") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.04, 0.03, 0.02}, {4, 3, 2}, 0.1);
    const auto model = tissue::make_corotated(mesh, bodies::elastic(8e3, 0.45, 1060.0), {});
    CHECK(std::accumulate(model.mass_kg.begin(), model.mass_kg.end(), 0.0) ==
          doctest::Approx(1060.0 * 0.04 * 0.03 * 0.02).scale(0.0).epsilon(1e-13));
}

TEST_CASE("gradients reproduce every linear field and sum to zero") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.04, 0.03, 0.02}, {4, 3, 2}, 0.1);
    const auto model = tissue::make_corotated(mesh, bodies::elastic(8e3, 0.45), {});
    const glm::dvec3 slope{3.0, -2.0, 5.0};
    for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
        glm::dvec3 found{0.0}, sum{0.0};
        for (int a = 0; a < 4; ++a) {
            found += glm::dot(slope, mesh.rest_m[mesh.tets[e][a]]) * model.gradient_1pm[e][a];
            sum += model.gradient_1pm[e][a];
        }
        CHECK(glm::length(found - slope) < 1e-12);
        CHECK(glm::length(sum) < 1e-12 * glm::length(model.gradient_1pm[e][1]));
    }
}

TEST_CASE("the pattern is a lower triangle with the diagonal first and rows ascending") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.04, 0.03, 0.02}, {4, 3, 2});
    const auto flags = bodies::anchors(mesh, [](auto x) { return x.x < 1e-9; });
    const auto model = tissue::make_corotated(mesh, bodies::elastic(8e3, 0.45), flags);
    const tissue::SparsePattern& p = model.pattern;
    CHECK(model.unknowns == 3 * 4 * 4 * 3);
    REQUIRE(p.size == model.unknowns);
    REQUIRE(p.column_start.size() == static_cast<std::size_t>(p.size) + 1);
    for (int c = 0; c < p.size; ++c) {
        REQUIRE(p.row[p.column_start[c]] == c);
        for (int k = p.column_start[c] + 1; k < p.column_start[c + 1]; ++k) {
            CHECK(p.row[k] > p.row[k - 1]);
            CHECK(p.row[k] < p.size);
        }
    }
}

TEST_CASE("a body that cannot be simulated is refused with its reason") {
    const auto message = [](tissue::TetMesh mesh, std::vector<std::uint8_t> flags) -> std::string {
        try {
            tissue::make_corotated(mesh, bodies::elastic(8e3, 0.45), flags);
        } catch (const std::invalid_argument& e) {
            return e.what();
        }
        return "";
    };
    const tissue::TetMesh mesh = tissue::box_mesh({0.02, 0.02, 0.02}, {1, 1, 1});
    CHECK(message(mesh, {}).empty());
    CHECK(message(mesh, std::vector<std::uint8_t>(8, 1)).find("every node") != std::string::npos);
    CHECK(message(mesh, {1, 0}).find("2 nodes") != std::string::npos);

    tissue::TetMesh loose = mesh;
    loose.rest_m.push_back({1, 1, 1});
    CHECK(message(loose, {}).find("node 8 has no mass") != std::string::npos);

    tissue::TetMesh flipped = mesh;
    std::swap(flipped.tets[3][0], flipped.tets[3][1]);
    CHECK(message(flipped, {}).find("tet 3 ") != std::string::npos);
}
