// tests/tissue/corotated_static_test.cpp
#include "tests/tissue/bodies.h"
#include "tests/tissue/reference_statics.h"

#include <doctest/doctest.h>
#include <glm/matrix.hpp>

using bodies::elastic;
using glm::dmat3;
using glm::dvec3;

namespace {

struct Solved {
    tissue::CorotatedModel model;
    tissue::CorotatedState state;
    tissue::StaticReport report;
};

// Boundary nodes held at `place(rest)`, inner nodes free; from rest.
template <typename Place>
Solved held_boundary(const tissue::TetMesh& mesh, const tissue::Material& material,
                     const std::vector<std::uint8_t>& held, Place place) {
    Solved s{tissue::make_corotated(mesh, material, held), {}, {}};
    s.state = tissue::rest_state(s.model);
    for (std::size_t i = 0; i < held.size(); ++i) {
        if (held[i])
            s.state.position_m[i] = place(mesh.rest_m[i]);
    }
    s.report = tissue::solve_static(s.model, {}, 1e-10, 50, s.state);
    return s;
}

bool on_boundary(const dvec3& x, const dvec3& size) {
    return glm::any(glm::lessThan(x, dvec3(1e-9))) || glm::any(glm::greaterThan(x, size - 1e-9));
}

// Beam 0.2 x 0.04 x 0.04 m, clamped at x = 0, rho 1000, under its weight in -y.
reference::Beam heavy_beam(const std::array<int, 3>& cells) {
    const tissue::TetMesh mesh = tissue::box_mesh({0.2, 0.04, 0.04}, cells);
    const double young_pa = 100e3, nu = 0.45;
    return {mesh,
            young_pa * nu / ((1 + nu) * (1 - 2 * nu)),
            young_pa / (2 * (1 + nu)),
            1000.0,
            {0, -9.81, 0},
            bodies::anchors(mesh, [](auto x) { return x.x < 1e-9; })};
}

Solved hang(const reference::Beam& beam, double young_pa) {
    Solved s{tissue::make_corotated(beam.mesh, elastic(young_pa, 0.45), beam.anchored,
                                    beam.gravity_mps2),
             {},
             {}};
    s.state = tissue::rest_state(s.model);
    s.report = tissue::solve_static(s.model, {}, 1e-10, 60, s.state);
    return s;
}

// Displacement of the centre of the end face: the mean of the nodes nearest to it.
dvec3 tip_m(const tissue::TetMesh& mesh, const std::vector<dvec3>& x) {
    double nearest = 1.0;
    const auto distance = [&](std::size_t i) {
        return glm::length(mesh.rest_m[i] - dvec3(0.2, 0.02, 0.02));
    };
    for (std::size_t i = 0; i < x.size(); ++i)
        nearest = std::min(nearest, distance(i));
    dvec3 sum{0.0};
    int count = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (distance(i) > nearest + 1e-9)
            continue;
        sum += x[i] - mesh.rest_m[i];
        ++count;
    }
    return sum / static_cast<double>(count);
}

// Small-deflection cantilever 100 x 20 x 20 mm, E 10 kPa, uniform shear traction on the end; mean
// deflection of the end face in mm, scaled to a load of 10 mN.
double cantilever_mm(const std::array<int, 3>& cells, double poisson) {
    const tissue::TetMesh mesh = tissue::box_mesh({0.1, 0.02, 0.02}, cells);
    const auto model = tissue::make_corotated(
        mesh, elastic(10e3, poisson), bodies::anchors(mesh, [](auto x) { return x.x < 1e-9; }));
    const double load_n = 10e-3, share = 1e-3; // so small that rotations do not count
    std::vector<double> weight(mesh.rest_m.size(), 0.0), load(model.unknowns, 0.0);
    for (const tissue::Triangle& t : tissue::boundary_triangles(mesh)) {
        const dvec3 a = mesh.rest_m[t[0]], b = mesh.rest_m[t[1]], c = mesh.rest_m[t[2]];
        if (std::min({a.x, b.x, c.x}) < 0.1 - 1e-9)
            continue;
        for (const std::uint32_t v : t) {
            weight[v] += glm::length(glm::cross(b - a, c - a)) / 6 / (0.02 * 0.02);
        }
    }
    for (std::size_t i = 0; i < weight.size(); ++i) {
        if (model.dof[i] >= 0)
            load[model.dof[i] + 2] = weight[i] * load_n * share;
    }
    tissue::CorotatedState state = tissue::rest_state(model);
    const auto report = tissue::solve_static(model, load, 1e-8, 20, state);
    CHECK(report.converged);
    double mean_m = 0.0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
        mean_m += weight[i] * (state.position_m[i].z - mesh.rest_m[i].z);
    }
    return mean_m / share * 1e3;
}

} // namespace

TEST_CASE("patch test: inner nodes of any mesh follow an affine boundary to 1e-10") {
    const dvec3 size{0.04, 0.04, 0.04};
    const tissue::TetMesh mesh = tissue::box_mesh(size, {4, 4, 4}, 0.2, 5);
    const auto held = bodies::anchors(mesh, [&](auto x) { return on_boundary(x, size); });
    std::mt19937_64 random(6);
    for (const double strain : {1e-3, 0.15}) {
        const dmat3 A = strain * dmat3{bodies::signed_vector(random), bodies::signed_vector(random),
                                       bodies::signed_vector(random)};
        const auto affine = [&](const dvec3& x) { return x + A * x; };
        const Solved s = held_boundary(mesh, elastic(10e3, 0.45), held, affine);
        CHECK(s.report.converged);
        for (std::size_t i = 0; i < held.size(); ++i) {
            const dvec3 error = s.state.position_m[i] - affine(mesh.rest_m[i]);
            CHECK(glm::length(error) < 1e-10 * strain * size.x);
        }
    }
}

TEST_CASE("a bar stretched between its ends contracts by Poisson's ratio") {
    const double poisson = 0.4, strain = 0.1;
    const tissue::TetMesh mesh = tissue::box_mesh({0.06, 0.02, 0.02}, {6, 2, 2}, 0.1);
    const auto ends = bodies::anchors(mesh, [](auto x) { return x.x < 1e-9 || x.x > 0.06 - 1e-9; });
    const auto uniaxial = [&](const dvec3& x) {
        return x * dvec3(1 + strain, 1 - poisson * strain, 1 - poisson * strain);
    };
    const Solved s = held_boundary(mesh, elastic(10e3, poisson), ends, uniaxial);
    CHECK(s.report.converged);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        CHECK(glm::length(s.state.position_m[i] - uniaxial(mesh.rest_m[i])) < 1e-11);
    }
}

TEST_CASE("linear tetrahedra converge with second order in displacement") {
    // pure bending, nu = 0: u = k (-x y, x^2/2, 0) is exact without body force; boundary given
    const double curvature_1pm = 1e-2; // rotations stay below 1e-3
    const auto bent = [&](const dvec3& x) {
        return x + curvature_1pm * dvec3(-x.x * x.y, x.x * x.x / 2, 0);
    };
    const dvec3 size{0.08, 0.08, 0.08};
    const auto error_m = [&](int cells) {
        const tissue::TetMesh mesh = tissue::box_mesh(size, {cells, cells, cells}, 0.15, 3);
        const auto held = bodies::anchors(mesh, [&](auto x) { return on_boundary(x, size); });
        const Solved s = held_boundary(mesh, elastic(10e3, 0.0), held, bent);
        CHECK(s.report.converged);
        double sum2 = 0.0; // at the centroids, where interpolation is at its worst
        for (const tissue::Tet& t : mesh.tets) {
            dvec3 found{0.0}, centroid{0.0};
            for (const std::uint32_t v : t) {
                found += s.state.position_m[v] / 4.0;
                centroid += mesh.rest_m[v] / 4.0;
            }
            sum2 += glm::dot(found - bent(centroid), found - bent(centroid));
        }
        return std::sqrt(sum2 / static_cast<double>(mesh.tets.size()));
    };
    CHECK(std::abs(std::log2(error_m(4) / error_m(8)) - 2.0) < 0.1);
}

TEST_CASE("a clamped cantilever bends as other linear tetrahedra do, locking included") {
    // published to 4 digits: P1 on 10x2x2 and 20x4x4 cells, nu 0.3, 0.45, 0.49
    CHECK(cantilever_mm({10, 2, 2}, 0.30) == doctest::Approx(13.06).scale(0.0).epsilon(1e-3));
    CHECK(cantilever_mm({10, 2, 2}, 0.45) == doctest::Approx(7.91).scale(0.0).epsilon(1e-3));
    CHECK(cantilever_mm({10, 2, 2}, 0.49) == doctest::Approx(3.22).scale(0.0).epsilon(2e-3));
    CHECK(cantilever_mm({20, 4, 4}, 0.30) == doctest::Approx(20.16).scale(0.0).epsilon(1e-3));
    CHECK(cantilever_mm({20, 4, 4}, 0.45) == doctest::Approx(15.21).scale(0.0).epsilon(1e-3));
}

TEST_CASE("a heavy beam hangs where an independent solver of the same tetrahedra finds it") {
    // tip of the converged beam: (-38.2, -113.8) mm; linear tetrahedra are 49 and 33 % off
    const dvec3 converged_m{-38.2e-3, -113.8e-3, 0};
    const std::array<std::array<int, 3>, 2> cells{{{10, 3, 3}, {20, 4, 4}}};
    const std::array<double, 2> off{0.49, 0.33};
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const reference::Beam beam = heavy_beam(cells[k]);
        const Solved s = hang(beam, 100e3);
        CHECK(s.report.converged);
        CHECK(s.report.iterations <= 30); // from the straight state
        const reference::Equilibrium other = reference::solve(beam, 2, 1e-9);
        REQUIRE(other.relative_residual < 1e-9);

        const dvec3 ours = tip_m(beam.mesh, s.state.position_m);
        const dvec3 theirs = tip_m(beam.mesh, other.position_m);
        CHECK(glm::length(ours - theirs) < 1e-6 * glm::length(theirs));
        const double error = glm::length(ours - converged_m) / glm::length(converged_m);
        CHECK(std::abs(error - off[k]) < 0.005);
    }
}

TEST_CASE("a beam fifty times softer still finds its rest from the straight state") {
    // plain Newton does not: this needs the line search
    const Solved s = hang(heavy_beam({10, 3, 3}), 2e3);
    CHECK(s.report.converged);
    CHECK(tip_m(s.model.mesh, s.state.position_m).y < -0.15);
}

TEST_CASE("statics of a loose body are reported, not invented") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.02, 0.02, 0.02}, {2, 2, 2});
    const auto model = tissue::make_corotated(mesh, elastic(8e3, 0.45), {}, {0, 0, -9.81});
    tissue::CorotatedState state = tissue::rest_state(model);
    CHECK_FALSE(tissue::solve_static(model, {}, 1e-8, 20, state).converged);
}
