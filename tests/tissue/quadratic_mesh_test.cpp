// tests/tissue/quadratic_mesh_test.cpp
#include "tests/tissue/reference_bodies.h"
#include "tissue/reference/tet10.h"

#include <cmath>
#include <doctest/doctest.h>
#include <set>

using glm::dvec3;

TEST_CASE("edge nodes lie in the middle of the edges 01 12 02 03 13 23, one for each edge") {
    const tissue::TetMesh corners = tissue::box_mesh({0.03, 0.02, 0.01}, {3, 2, 2}, 0.2);
    const tissue::QuadraticMesh mesh = tissue::quadratic_mesh(corners);
    // CalculiX 2.20 manual, C3D10: node 5 between 1 and 2, 6: 2-3, 7: 3-1, 8: 1-4, 9: 2-4, 10: 3-4
    constexpr std::array<std::array<int, 3>, 6> kManual{
        {{5, 1, 2}, {6, 2, 3}, {7, 3, 1}, {8, 1, 4}, {9, 2, 4}, {10, 3, 4}}};
    std::set<std::array<std::uint32_t, 2>> edges;
    for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
        const tissue::Tet10& t = mesh.tets[i];
        for (int k = 0; k < 4; ++k)
            CHECK(t[k] == corners.tets[i][k]);
        for (const auto& [middle, a, b] : kManual) {
            const dvec3 expected = (mesh.rest_m[t[a - 1]] + mesh.rest_m[t[b - 1]]) / 2.0;
            CHECK(mesh.rest_m[t[middle - 1]] == expected);
            edges.insert({std::min(t[a - 1], t[b - 1]), std::max(t[a - 1], t[b - 1])});
        }
    }
    CHECK(mesh.rest_m.size() == corners.rest_m.size() + edges.size());
    // a Kuhn grid has the nodes of the grid of half the size
    CHECK(mesh.rest_m.size() == 7 * 5 * 5);
}

TEST_CASE("six-node triangles of the boundary have their edge nodes on their edges, outwards") {
    const dvec3 size{0.03, 0.02, 0.01};
    const tissue::QuadraticMesh mesh = tissue::quadratic_mesh(tissue::box_mesh(size, {3, 2, 1}));
    double volume = 0.0;
    for (const tissue::Triangle6& t : boundary_triangles(mesh)) {
        for (int k = 0; k < 3; ++k) {
            CHECK(glm::length(mesh.rest_m[t[3 + k]] -
                              0.5 * (mesh.rest_m[t[k]] + mesh.rest_m[t[(k + 1) % 3]])) < 1e-15);
        }
        volume += glm::dot(mesh.rest_m[t[0]], glm::cross(mesh.rest_m[t[1]], mesh.rest_m[t[2]])) / 6;
    }
    CHECK(
        volume ==
        doctest::Approx(size.x * size.y * size.z).scale(0.0).epsilon(1e-12)); // divergence theorem
}

TEST_CASE("a flat tetrahedron is refused by name") {
    tissue::TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2, 3}}};
    CHECK_THROWS_WITH_AS(tissue::quadratic_mesh(mesh), doctest::Contains("tet 0 has volume 0"),
                         std::invalid_argument);
}

namespace {

double factorial(int n) {
    return std::tgamma(n + 1);
}

// Mean of L0^i L1^j L2^k L3^l over a tet: 3! i! j! k! l! / (3 + i + j + k + l)!
double exact_mean(const std::array<int, 4>& p) {
    return 6 * factorial(p[0]) * factorial(p[1]) * factorial(p[2]) * factorial(p[3]) /
           factorial(3 + p[0] + p[1] + p[2] + p[3]);
}

template <typename Rule> double greatest_error(const Rule& rule, int degree) {
    double greatest = 0.0;
    for (int i = 0; i <= degree; ++i) {
        for (int j = 0; i + j <= degree; ++j) {
            for (int k = 0; i + j + k <= degree; ++k) {
                const std::array<int, 4> power{i, j, k, degree - i - j - k};
                double sum = 0.0;
                for (const tissue::QuadraturePoint& p : rule) {
                    double term = p.weight;
                    for (int a = 0; a < 4; ++a)
                        term *= std::pow(p.at[a], power[a]);
                    sum += term;
                }
                greatest = std::max(greatest, std::abs(sum / exact_mean(power) - 1.0));
            }
        }
    }
    return greatest;
}

} // namespace

TEST_CASE("four points integrate all polynomials of degree 2, fourteen those of degree 5") {
    for (int degree = 0; degree <= 2; ++degree)
        CHECK(greatest_error(tissue::kFourPoints, degree) < 1e-13);
    CHECK(greatest_error(tissue::kFourPoints, 3) > 1e-3);
    for (int degree = 0; degree <= 5; ++degree)
        CHECK(greatest_error(tissue::fourteen_points(), degree) < 1e-12);
    CHECK(greatest_error(tissue::fourteen_points(), 6) > 1e-3);
}

TEST_CASE("shape functions are 1 at their own node; their gradients give any quadratic's") {
    const tissue::QuadraticMesh mesh = reference_bodies::irregular_box({0.02, 0.02, 0.02}, 2, 3);
    const tissue::Tet10& tet = mesh.tets[5];
    for (std::size_t a = 0; a < 10; ++a) {
        tissue::Barycentric at{};
        if (a < 4) {
            at[a] = 1.0;
        } else {
            at[tissue::kEdge[a - 4][0]] = at[tissue::kEdge[a - 4][1]] = 0.5;
        }
        const auto N = tissue::shape_values(at);
        for (std::size_t b = 0; b < 10; ++b)
            CHECK(N[b] == (a == b ? 1.0 : 0.0));
    }
    // g(x) = x y - 2 z^2 + 3 x
    const auto g = [](const dvec3& x) { return x.x * x.y - 2 * x.z * x.z + 3 * x.x; };
    const tissue::Barycentric at{0.1, 0.2, 0.3, 0.4};
    const auto N = tissue::shape_values(at);
    const auto s = tissue::shape_gradients(mesh, tet, at);
    dvec3 x{0.0}, gradient{0.0};
    for (std::size_t a = 0; a < 10; ++a) {
        x += N[a] * mesh.rest_m[tet[a]];
        gradient += g(mesh.rest_m[tet[a]]) * s.gradient_1pm[a];
    }
    CHECK(glm::length(gradient - dvec3(x.y + 3, x.x, -4 * x.z)) < 1e-13);
}
