// tests/tissue/mass_spring_test.cpp
// Mass-springs: stiffness against Lloyd et al. and Cauchy, the critical step, and what springs
// cannot.
#include "tests/tissue/baselines.h"

#include <doctest/doctest.h>
#include <glm/vector_relational.hpp>

using bodies::elastic;
using glm::dvec3;

namespace {

// Energy density, J/m3, of a homogeneous strain.
double density(const tissue::MassSpringModel& model, const glm::dmat3& F) {
    tissue::BaselineState state = tissue::rest_state(model.body);
    for (dvec3& x : state.position_m)
        x = F * x;
    return tissue::elastic_energy_j(model, state) /
           tissue::volume_m3(model.body.mesh, model.body.mesh.rest_m);
}

} // namespace

TEST_CASE("a regular tet has the springs of Lloyd, Szekely and Harders") {
    const double edge_m = 0.01, young_pa = 7e3;
    const double s = edge_m / std::sqrt(8.0);
    const tissue::TetMesh mesh{{{s, s, s}, {s, -s, -s}, {-s, s, -s}, {-s, -s, s}}, {{0, 2, 1, 3}}};
    tissue::TetMesh positive = mesh;
    if (tissue::volume_m3(mesh, mesh.rest_m) < 0)
        std::swap(positive.tets[0][0], positive.tets[0][1]);
    const auto model = tissue::make_mass_spring(positive, elastic(young_pa, 0.25), {});
    REQUIRE(model.springs.size() == 6);
    for (const tissue::Spring& spring : model.springs) {
        CHECK(baselines::off(spring.rest_m, edge_m) < 1e-14);
        CHECK(baselines::off(spring.npm, 2 * std::sqrt(2.0) / 25 * young_pa * edge_m) < 1e-13);
    }
    // two ways: the k that brings k K_1 nearest to the stiffness K of the element, <K_1, K>/<K_1,
    // K_1>
    const auto body = tissue::make_corotated(positive, elastic(young_pa, 0.25), {});
    tissue::CorotatedSystem system = tissue::make_system(body);
    tissue::linearize(body, tissue::rest_state(body), 1.0, system);
    double both = 0.0, own = 0.0;
    std::vector<std::vector<double>> unit;
    for (const tissue::Spring& spring : model.springs) {
        const dvec3 n = (positive.rest_m[spring.b] - positive.rest_m[spring.a]) / edge_m;
        std::vector<double> v(12), product(12);
        for (int k = 0; k < 3; ++k) {
            v[3 * spring.a + k] = -n[k];
            v[3 * spring.b + k] = n[k];
        }
        tissue::multiply(body.pattern, system.stiffness, v, product);
        both += bodies::inner(v, product);
        unit.push_back(v);
    }
    for (const auto& v : unit) {
        for (const auto& w : unit)
            own += std::pow(bodies::inner(v, w), 2);
    }
    CHECK(baselines::off(model.springs[0].npm, both / own) < 1e-12);
}

TEST_CASE("averaged over directions Poisson's ratio is 1/4, whatever was asked") {
    // stretches along the six axes of the icosahedron average as those along all directions do
    const double phi = (1 + std::sqrt(5.0)) / 2, strain = 1e-5;
    const dvec3 axes[] = {{0, 1, phi},  {0, 1, -phi}, {1, phi, 0},
                          {1, -phi, 0}, {phi, 0, 1},  {-phi, 0, 1}};
    for (const double asked : {0.0, 0.3, 0.49}) {
        const auto model =
            tissue::make_mass_spring(baselines::small_box(), elastic(7e3, asked), {});
        double along = 0.0; // lambda + 2 mu
        for (const dvec3& axis : axes) {
            const dvec3 n = glm::normalize(axis);
            along += density(model, glm::dmat3(1.0) + strain * glm::outerProduct(n, n)) /
                     (0.5 * strain * strain) / 6;
        }
        const double all = density(model, glm::dmat3(1 + strain)) / (0.5 * strain * strain);
        const double lambda = (all - 3 * along) / 6, mu = (along - lambda) / 2; // 9 lambda + 6 mu
        CHECK(baselines::off(lambda / (2 * (lambda + mu)), 0.25) < 1e-4);
        CHECK(baselines::off(mu * (3 * lambda + 2 * mu) / (lambda + mu), 0.96 * 7e3) <
              1e-4); // Young's
    }
}

TEST_CASE("forces of springs are the gradient of their energy") {
    const auto model = tissue::make_mass_spring(baselines::small_box(), elastic(7e3, 0.3), {});
    CHECK(baselines::gradient_error(model, baselines::shaken(model.body, 2e-3, 0, 4)) < 1e-6);
}

TEST_CASE("a lone tet's critical step is that of its three springs") {
    const double height_m = 0.008, young_pa = 7e3;
    const auto mesh = baselines::lone_tet(height_m);
    const auto model = tissue::make_mass_spring(mesh, elastic(young_pa, 0.3), baselines::kBase);
    const double volume_m3 = tissue::volume_m3(mesh, mesh.rest_m);
    const double length2 = height_m * height_m + 1e-4, npm = 0.96 * young_pa * volume_m3 / length2;
    const double stiffest = npm * std::max(3 * height_m * height_m, 1.5 * 1e-4) / length2;
    CHECK(baselines::off(model.critical_s, 2 / std::sqrt(stiffest / (1000 * volume_m3 / 4))) <
          1e-4);
    CHECK(baselines::off(model.substep_s, 0.9 * model.critical_s) < 1e-12);
}

TEST_CASE("symplectic Euler of springs is stable below the critical step and diverges above it") {
    auto model = tissue::make_mass_spring(baselines::small_box(), elastic(7e3, 0.3), {});
    for (const double share : {0.95, 1.05}) {
        model.substep_s = share * model.critical_s;
        tissue::BaselineState state = baselines::shaken(model.body, 0, 1e-6, 5);
        const auto report = baselines::run(model, {}, model.substep_s, 2000, state);
        // at 0.95 amplitudes are 1/sqrt(1 - 0.95^2) of the exact ones; at 1.05 the fastest mode
        // grows by (1.05 + sqrt(1.05^2 - 1))^2 = 1.9 each step, and springs that long are stiffer
        // still
        CHECK((report.finite && baselines::fastest_mps(state) < 2e-5) == (share < 1));
        CHECK((!report.finite || baselines::fastest_mps(state) > 1.0) == (share > 1));
    }
}

TEST_CASE("springs lose no energy in ten seconds") {
    CHECK(baselines::energy_drift(
              tissue::make_mass_spring(baselines::small_box(), elastic(7e3, 0.3), {})) < 0.01);
}

TEST_CASE("springs do not notice that a body is inside out") {
    const auto model = tissue::make_mass_spring(baselines::small_box(), elastic(7e3, 0.3), {});
    tissue::BaselineState state = tissue::rest_state(model.body);
    for (dvec3& x : state.position_m)
        x.z = -x.z;
    const tissue::BaselineReport report = baselines::run(model, {}, 0.01, 100, state);
    CHECK(report.inverted == static_cast<int>(model.body.mesh.tets.size()));
    CHECK(baselines::fastest_mps(state) < 1e-9);
}

TEST_CASE("springs fail the patch test: a homogeneous strain is no equilibrium of a general mesh") {
    // Of an isotropic solid with these constants the force on an inner node is exactly none
    const double strain = 1e-3;
    const tissue::TetMesh mesh = tissue::box_mesh({0.03, 0.03, 0.03}, {3, 3, 3}, 0.1);
    const auto springs = tissue::make_mass_spring(mesh, elastic(7e3, 0.25), {});
    const auto tets = tissue::make_tled(mesh, elastic(7e3, 0.25), {});
    tissue::BaselineState state = tissue::rest_state(springs.body);
    for (dvec3& x : state.position_m)
        x.x *= 1 + strain;
    std::vector<dvec3> of_springs(mesh.rest_m.size()), of_tets(mesh.rest_m.size());
    tissue::elastic_forces(springs, state, of_springs);
    tissue::elastic_forces(tets, state, of_tets);
    double springs_n = 0.0, tets_n = 0.0;
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
        const dvec3 x = mesh.rest_m[i];
        if (glm::all(glm::greaterThan(x, dvec3(1e-9))) &&
            glm::all(glm::lessThan(x, dvec3(0.03 - 1e-9)))) {
            springs_n = std::max(springs_n, glm::length(of_springs[i]));
            tets_n = std::max(tets_n, glm::length(of_tets[i]));
        }
    }
    const double cell_n = 7e3 * strain * 1e-4; // what the strain carries through a cell
    CHECK(tets_n < 1e-12 * cell_n);
    CHECK(springs_n > 0.01 * cell_n);
}

TEST_CASE("a spring beam does not know Poisson's ratio, and a finer mesh brings it no nearer") {
    const double converged_m = -113.8e-3; // neo-Hooke, nu = 0.45: CalculiX and the reference solver
    double tip_m[2][2];
    for (const int fine : {0, 1}) {
        for (const int stiff : {0, 1}) {
            const baselines::Beam beam({5 << fine, 2 << fine, 2 << fine}, 1e5, stiff ? 0.45 : 0.0);
            const auto model = beam.made<tissue::MassSpringModel>();
            tip_m[fine][stiff] = beam.tip_m(baselines::settled(model, {}, 0.01, 1e-5, 1000)).y;
        }
        MESSAGE("tip ", 1e3 * tip_m[fine][0], " mm of ", 1e3 * converged_m);
        CHECK(tip_m[fine][0] == tip_m[fine][1]);
    }
    CHECK(std::abs(tip_m[1][1] - converged_m) > std::abs(tip_m[0][1] - converged_m));
    CHECK(tip_m[1][1] / converged_m > 1.2);
}
