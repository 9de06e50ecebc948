// tests/tissue/refine_test.cpp
// Local refinement keeps the body: its volume, its skin, its anchors and its bed.
#include "tissue/mesh/refine.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <map>

namespace {

using glm::dvec3;

const dvec3 kBox{0.08, 0.07, 0.05}, kPlace{0.033, 0.031, 0.05};

tissue::TetMesh coarse() {
    return tissue::box_mesh(kBox, {5, 4, 4}, 0.2, 3);
}

tissue::RefinedMesh fine(const tissue::TetMesh& mesh, double edge_m,
                         std::span<const tissue::BedSample> bed = {}) {
    return tissue::refined(mesh, {}, bed, kPlace, {.edge_m = edge_m, .core_m = 2e-3});
}

double longest_edge_m(const tissue::TetMesh& mesh, const tissue::Tet& t) {
    double longest = 0.0;
    for (const auto a : t) {
        for (const auto b : t)
            longest = std::max(longest, glm::distance(mesh.rest_m[a], mesh.rest_m[b]));
    }
    return longest;
}

// Second moments of a bed about the origin: what its energy is for linear fields.
std::array<double, 4> moments(const tissue::TetMesh& mesh, std::span<const tissue::BedSample> bed) {
    std::array<double, 4> sum{};
    for (const auto& s : bed) {
        dvec3 x{0.0};
        for (int k = 0; k < 4; ++k)
            x += s.weight[k] * mesh.rest_m[mesh.tets[s.tet][k]];
        for (int k = 0; k < 3; ++k)
            sum[k] += s.stiffness_m * x[k] * x[k];
        sum[3] += s.stiffness_m;
    }
    return sum;
}

} // namespace

TEST_CASE("refine: volume stays, every tet is positive, every face has two tets or is on the box") {
    const auto mesh = coarse();
    const auto r = fine(mesh, 0.5e-3);
    REQUIRE(r.mesh.tets.size() > 3 * mesh.tets.size());
    CHECK_NOTHROW(tissue::check_mesh(r.mesh));
    const double volume = kBox.x * kBox.y * kBox.z;
    CHECK(tissue::volume_m3(r.mesh, r.mesh.rest_m) ==
          doctest::Approx(volume).epsilon(1e-12).scale(0.0));
    // a face that hangs would be a boundary face inside
    double area = 0.0;
    for (const auto& t : tissue::boundary_triangles(r.mesh)) {
        const dvec3 a = r.mesh.rest_m[t[0]], b = r.mesh.rest_m[t[1]], c = r.mesh.rest_m[t[2]];
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    CHECK(area == doctest::Approx(2 * (kBox.x * kBox.y + kBox.y * kBox.z + kBox.z * kBox.x))
                      .epsilon(1e-12)
                      .scale(0.0));
}

TEST_CASE("refine: tets are small near the place, and only there") {
    const auto mesh = coarse();
    const auto r = fine(mesh, 0.5e-3);
    int near = 0;
    for (const auto& t : r.mesh.tets) {
        double distance = 1.0;
        for (const auto node : t)
            distance = std::min(distance, glm::distance(r.mesh.rest_m[node], kPlace));
        near += distance < 2e-3;
        CHECK(longest_edge_m(r.mesh, t) <= 0.5e-3 + 0.5 * std::max(0.0, distance - 2e-3) + 1e-12);
    }
    CHECK(near > 200);
    // of tets with such edges the box would take more than 280 cm3 / (0.5 mm)^3 = 2 million
    CHECK(r.mesh.tets.size() < 50000);
}

TEST_CASE("refine: along a line down from the place, tets are small as they are at the place") {
    const dvec3 down{0.0, 0.0, -20e-3};
    const auto r =
        tissue::refined(coarse(), {}, {}, kPlace, {.edge_m = 1e-3, .core_m = 1e-3, .down_m = down});
    int deep = 0;
    for (const auto& t : r.mesh.tets) {
        double distance = 1.0;
        for (const auto node : t) {
            const dvec3 x = r.mesh.rest_m[node] - kPlace;
            const double along = std::clamp(x.z, down.z, 0.0);
            distance = std::min(distance, glm::length(x - dvec3{0.0, 0.0, along}));
            deep += x.z < -15e-3 && distance < 1e-3;
        }
        CHECK(longest_edge_m(r.mesh, t) <= 1e-3 + 0.5 * std::max(0.0, distance - 1e-3) + 1e-12);
    }
    CHECK(deep > 50);
    // negative control: with no line the deep ones stay large
    const auto without =
        tissue::refined(coarse(), {}, {}, kPlace, {.edge_m = 1e-3, .core_m = 1e-3});
    CHECK(without.mesh.tets.size() < r.mesh.tets.size() / 2);
}

TEST_CASE("refine: halving sizes four times does not flatten tets further than the first time") {
    const auto mesh = coarse();
    const double start = tissue::least_shape_quality(mesh);
    const double first = tissue::least_shape_quality(fine(mesh, 4e-3).mesh);
    for (const double edge_m : {2e-3, 1e-3, 0.5e-3})
        CHECK(tissue::least_shape_quality(fine(mesh, edge_m).mesh) > 0.5 * std::min(first, start));
}

TEST_CASE("refine: a regular tet has quality 1, a flat one 0") {
    const tissue::TetMesh regular{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                                  {{0, 2, 1, 3}}};
    CHECK(std::abs(tissue::least_shape_quality(regular) - 1.0) < 1e-12);
    const tissue::TetMesh flat{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2, 3}}};
    CHECK(tissue::least_shape_quality(flat) < 1e-9);
}

TEST_CASE("refine: the bed keeps its sum and its moments, at points inside their tets") {
    const auto mesh = coarse();
    const auto bed = tissue::make_bed(
        mesh, [](const dvec3& x) { return x.x + x.z > 0.06; }, 0.01);
    const auto r = fine(mesh, 1e-3, bed);
    REQUIRE(r.bed.size() == bed.size());
    const auto before = moments(mesh, bed), after = moments(r.mesh, r.bed);
    for (int k = 0; k < 4; ++k)
        CHECK(after[k] == doctest::Approx(before[k]).epsilon(1e-12).scale(0.0));
    for (const auto& s : r.bed)
        CHECK(*std::min_element(s.weight.begin(), s.weight.end()) >= -1e-12);
}

TEST_CASE("refine: between two anchored nodes a new one is anchored, beside a free one it is not") {
    const auto mesh = coarse();
    std::vector<std::uint8_t> anchored;
    for (const dvec3& x : mesh.rest_m)
        anchored.push_back(x.z > kBox.z - 1e-9);
    const auto r = tissue::refined(mesh, anchored, {}, kPlace, {.edge_m = 1e-3, .core_m = 2e-3});
    REQUIRE(r.anchored.size() == r.mesh.rest_m.size());
    for (std::size_t i = 0; i < r.anchored.size(); ++i)
        CHECK((r.anchored[i] == 1) == (r.mesh.rest_m[i].z > kBox.z - 1e-9));
}

TEST_CASE("refine: what cannot be refined is refused with the value") {
    const auto mesh = coarse();
    CHECK_THROWS_WITH(fine(mesh, 0.0), doctest::Contains("edge_m = 0"));
    CHECK_THROWS_WITH(tissue::refined(mesh, {}, {}, kPlace, {.edge_m = 1e-4}, 5000),
                      doctest::Contains("more than 5000 tets"));
    const std::vector<std::uint8_t> few(3, 0);
    CHECK_THROWS_WITH(tissue::refined(mesh, few, {}, kPlace, {.edge_m = 1e-2}),
                      doctest::Contains("flags for 3"));
    const std::vector<tissue::BedSample> beyond{{99999, {1, 0, 0, 0}, 1.0}};
    CHECK_THROWS_WITH(fine(mesh, 1e-2, beyond), doctest::Contains("tet 99999"));
}
