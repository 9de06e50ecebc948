// tests/tissue/linear_statics_test.cpp
// Linear and quadratic tetrahedra against beams and patches.
#include "tissue/response/linear_statics.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace {

using glm::dvec3;

double relative_error(double value, double truth) {
    return std::abs(value - truth) / std::abs(truth);
}

// Mean deflection of the end face of a beam under an even traction on it, E = 10 kPa, 10 mN.
double beam_tip_mm(int order, double poisson, const std::array<int, 3>& cells) {
    const auto mesh = tissue::box_mesh({0.1, 0.02, 0.02}, cells);
    std::vector<std::uint8_t> anchored;
    for (const dvec3& x : mesh.rest_m)
        anchored.push_back(x.x < 1e-9);
    const auto statics = tissue::make_linear_statics(mesh, order, poisson, anchored);
    // per triangle of the end face: centroid rule (linear), edge midpoints (quadratic)
    std::vector<double> load(statics.unknowns, 0.0);
    for (const tissue::Triangle& t : tissue::boundary_triangles(mesh)) {
        if (std::any_of(t.begin(), t.end(), [&](auto i) { return mesh.rest_m[i].x < 0.1 - 1e-9; }))
            continue;
        const double share = 0.5 *
                             glm::length(glm::cross(mesh.rest_m[t[1]] - mesh.rest_m[t[0]],
                                                    mesh.rest_m[t[2]] - mesh.rest_m[t[0]])) /
                             (0.02 * 0.02);
        for (const dvec3& weight : {dvec3{.5, .5, 0}, dvec3{0, .5, .5}, dvec3{.5, 0, .5}}) {
            const auto shape = tissue::surface_shape(statics, t, weight);
            for (int k = 0; k < shape.count; ++k)
                load[statics.dof[shape.node[k]] + 2] += share / 3.0 * shape.value[k];
        }
    }
    std::vector<double> u = load;
    tissue::SparseFactor factor(statics.pattern);
    REQUIRE(factor.factor(statics.stiffness_m));
    factor.solve(u, 1);
    double tip = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i)
        tip += load[i] * u[i];
    return tip * 10e-3 / 10e3 * 1e3;
}

} // namespace

TEST_CASE("linear statics: a slender quadratic beam without Poisson bends as Timoshenko says") {
    // P L^3 / 3EI + P L / (kappa G A), kappa = 5/6 for nu = 0 (Cowper 1966)
    const double inertia = std::pow(0.02, 4.0) / 12.0;
    const double bend = 10e-3 * 1e-3 / (3.0 * 10e3 * inertia);
    const double shear = 10e-3 * 0.1 / (5.0 / 6.0 * 5e3 * 4e-4);
    CHECK(relative_error(beam_tip_mm(2, 0.0, {20, 4, 4}), 1e3 * (bend + shear)) < 0.005);
}

TEST_CASE("linear statics: coarse beams bend as little as another program's") {
    // the same grids, six tets a cell, computed independently
    struct Fact {
        int order;
        double poisson;
        std::array<int, 3> cells;
        double tip_mm;
    };
    for (const auto& [order, poisson, cells, tip_mm] :
         {Fact{1, .30, {10, 2, 2}, 13.06}, Fact{1, .45, {10, 2, 2}, 7.91},
          Fact{1, .45, {20, 4, 4}, 15.21}, Fact{2, .30, {10, 2, 2}, 25.21},
          Fact{2, .45, {10, 2, 2}, 24.30}, Fact{2, .49, {10, 2, 2}, 23.59}}) {
        CAPTURE(order);
        CAPTURE(poisson);
        CHECK(relative_error(beam_tip_mm(order, poisson, cells), tip_mm) < 0.01);
    }
}

TEST_CASE("linear statics: an even strain costs what Hooke says, a rotation nothing") {
    // energy of u = A x: V (lambda/2 tr(e)^2 + mu e:e)
    const auto mesh = tissue::box_mesh({0.03, 0.02, 0.04}, {2, 2, 2}, 0.2);
    const std::vector<std::uint8_t> loose(mesh.rest_m.size(), 0);
    const double nu = 0.4, lambda = nu / (1.4 * 0.2), mu = 0.5 / 1.4;
    const glm::dmat3 A{1e-3, 4e-4, -2e-4, 3e-4, -5e-4, 1e-4, 6e-4, 2e-4, 8e-4};
    const glm::dmat3 e = 0.5 * (A + glm::transpose(A));
    double squared = 0.0;
    for (int k = 0; k < 3; ++k)
        squared += glm::dot(e[k], e[k]);
    const double trace = e[0][0] + e[1][1] + e[2][2];
    const double energy = 0.03 * 0.02 * 0.04 * (0.5 * lambda * trace * trace + mu * squared);
    for (const int order : {1, 2}) {
        const auto statics = tissue::make_linear_statics(mesh, order, nu, loose);
        std::vector<dvec3> place = mesh.rest_m;
        for (const auto& [low, high, node] : statics.mid)
            place.push_back(0.5 * (mesh.rest_m[low] + mesh.rest_m[high]));
        const auto energy_of = [&](const glm::dmat3& gradient) {
            std::vector<double> u(statics.unknowns), f(statics.unknowns);
            for (std::size_t i = 0; i < place.size(); ++i) {
                const dvec3 move = gradient * place[i];
                for (int axis = 0; axis < 3; ++axis)
                    u[statics.dof[i] + axis] = move[axis];
            }
            tissue::multiply(statics.pattern, statics.stiffness_m, u, f);
            double sum = 0.0;
            for (std::size_t i = 0; i < u.size(); ++i)
                sum += 0.5 * u[i] * f[i];
            return sum;
        };
        CHECK(relative_error(energy_of(A), energy) < 1e-10);
        const glm::dmat3 spin{0, 1e-3, -2e-3, -1e-3, 0, 5e-4, 2e-3, -5e-4, 0};
        CHECK(std::abs(energy_of(spin)) < 1e-12 * energy);
    }
}

TEST_CASE("linear statics: shapes on a boundary triangle sum to one and carry a linear field") {
    const auto mesh = tissue::box_mesh(dvec3{1.0}, {1, 1, 1});
    const std::vector<std::uint8_t> loose(mesh.rest_m.size(), 0);
    const auto statics = tissue::make_linear_statics(mesh, 2, 0.3, loose);
    std::vector<dvec3> place = mesh.rest_m;
    for (const auto& [low, high, node] : statics.mid)
        place.push_back(0.5 * (mesh.rest_m[low] + mesh.rest_m[high]));
    for (const tissue::Triangle& t : tissue::boundary_triangles(mesh)) {
        const dvec3 weight{0.2, 0.5, 0.3};
        const auto shape = tissue::surface_shape(statics, t, weight);
        dvec3 carried{0.0};
        for (int k = 0; k < shape.count; ++k)
            carried += shape.value[k] * place[shape.node[k]];
        const dvec3 truth =
            .2 * mesh.rest_m[t[0]] + .5 * mesh.rest_m[t[1]] + .3 * mesh.rest_m[t[2]];
        CHECK(glm::distance(carried, truth) < 1e-14);
    }
}

TEST_CASE("linear statics: wrong order and impossible Poisson's ratio are refused") {
    const auto mesh = tissue::box_mesh(dvec3{1.0}, {1, 1, 1});
    const std::vector<std::uint8_t> loose(8, 0);
    CHECK_THROWS_WITH(tissue::make_linear_statics(mesh, 3, 0.3, loose),
                      doctest::Contains("order = 3"));
    CHECK_THROWS_WITH(tissue::make_linear_statics(mesh, 1, 0.5, loose),
                      doctest::Contains("poisson"));
}
