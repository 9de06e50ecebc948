// tests/tissue/reference_patch_test.cpp
// What ten-node tetrahedra reproduce exactly, and what no motion may change.
#include "tests/tissue/reference_bodies.h"

#include <doctest/doctest.h>
#include <glm/matrix.hpp>

using bodies::elastic;
using glm::dmat3;
using glm::dvec3;
using reference_bodies::flags;
using reference_bodies::irregular_box;
using reference_bodies::places;
using tissue::kHeld;
using tissue::Law;

namespace {

const dvec3 kBox{0.04, 0.04, 0.04};

dmat3 random_matrix(std::mt19937_64& random) {
    return {bodies::signed_vector(random), bodies::signed_vector(random),
            bodies::signed_vector(random)};
}

std::uint8_t held_on_box(const dvec3& x) {
    return reference_bodies::on_box(x, kBox) ? kHeld : 0;
}

} // namespace

TEST_CASE(
    "reference patch test: inner nodes follow an affine boundary to 1e-10, any law, any strain") {
    const tissue::QuadraticMesh mesh = irregular_box(kBox, 3, 5);
    std::mt19937_64 random(6);
    for (const Law law : {Law::neo_hooke, Law::small_strain}) {
        for (const double strain : {1e-3, 0.3}) {
            const dmat3 A = strain * random_matrix(random);
            const auto affine = [&](const dvec3& x) { return x + A * x; };
            const auto target = places(mesh, affine);
            const auto s = reference_bodies::solve(mesh, elastic(10e3, 0.45), law,
                                                   flags(mesh, held_on_box), {{}, target});
            CHECK(s.report.converged);
            CHECK(reference_bodies::greatest_error_m(s, affine) < 1e-10 * strain * kBox.x);

            // uniform stress: the energy of the whole is the density times the volume
            const double density = energy_density_jpm3(s.model.elasticity, dmat3(1.0) + A);
            const double volume = kBox.x * kBox.y * kBox.z;
            CHECK(s.report.energy_j == doctest::Approx(density * volume).scale(0.0).epsilon(1e-9));
        }
    }
}

TEST_CASE("any quadratic displacement with its constant body force is exact under small strain") {
    const tissue::QuadraticMesh mesh = irregular_box(kBox, 3, 8);
    const tissue::Material material = elastic(10e3, 0.4);
    const tissue::Lame c = lame(material);
    std::mt19937_64 random(9);
    for (int i = 0; i < 3; ++i) {
        // u_k = x^T Q_k x / 2, Q_k symmetric; strains of a per cent. div sigma_k =
        // (lambda + mu) sum_j Q_j[j][k] + mu tr Q_k
        std::array<dmat3, 3> Q;
        for (dmat3& q : Q) {
            q = random_matrix(random);
            q = 0.25 * (q + glm::transpose(q));
        }
        const auto quadratic = [&](const dvec3& x) {
            return x +
                   0.5 * dvec3(glm::dot(x, Q[0] * x), glm::dot(x, Q[1] * x), glm::dot(x, Q[2] * x));
        };
        dvec3 divergence;
        for (int k = 0; k < 3; ++k) {
            divergence[k] = (c.lambda_pa + c.mu_pa) * (Q[0][0][k] + Q[1][1][k] + Q[2][2][k]) +
                            c.mu_pa * (Q[k][0][0] + Q[k][1][1] + Q[k][2][2]);
        }
        const auto target = places(mesh, quadratic);
        const auto s = reference_bodies::solve(
            mesh, material, Law::small_strain, flags(mesh, held_on_box), {{}, target},
            -divergence / material.density_kgpm3, {.tolerance = 1e-13});
        CHECK(s.report.iterations <= 2); // carried there, then one for rounding
        const double moved_m = 0.5 * kBox.x * kBox.x;
        CHECK(reference_bodies::greatest_error_m(s, quadratic) < 1e-10 * moved_m);
    }
}

TEST_CASE("a rigid motion makes no force, and turns the forces of a deformed body") {
    const tissue::QuadraticMesh mesh = irregular_box(kBox, 2, 3);
    const double young = 10e3;
    const auto model = make_reference(mesh, elastic(young, 0.45), Law::neo_hooke, {});
    std::mt19937_64 random(2);
    std::vector<dvec3> still(mesh.rest_m.size()), turned(mesh.rest_m.size());
    const auto bump = [](const dvec3& x) {
        return x + 0.1 * dvec3(x.y, 20 * x.x * x.z, -x.x) + dvec3(0, 0, 2 * x.y * x.y);
    };
    for (const double angle : {1e-3, 0.7, 3.0, 12.0}) {
        const dmat3 R = bodies::rotation(bodies::signed_vector(random), angle);
        const dvec3 shift = 0.1 * bodies::signed_vector(random);
        const auto rigid = [&](const dvec3& x) { return R * x + shift; };
        elastic_forces(model, places(mesh, rigid), turned);
        for (const dvec3& f : turned)
            CHECK(glm::length(f) < 1e-9 * young * kBox.x * kBox.x);

        elastic_forces(model, places(mesh, bump), still);
        elastic_forces(model, places(mesh, [&](auto& x) { return rigid(bump(x)); }), turned);
        double largest = 0.0;
        for (std::size_t i = 0; i < still.size(); ++i) {
            largest = std::max(largest, glm::length(still[i]));
            CHECK(glm::length(R * still[i] - turned[i]) < 1e-12 * young * kBox.x * kBox.x);
        }
        CHECK(largest > 1e-3 * young * kBox.x * kBox.x);
    }
}

TEST_CASE("forces are the slope of the energy, K that of the forces, on curved tetrahedra too") {
    tissue::QuadraticMesh mesh = irregular_box(kBox, 2, 4);
    std::mt19937_64 random(5);
    for (dvec3& x : mesh.rest_m)
        x += 4e-4 * bodies::signed_vector(random); // edge nodes off their edges
    for (const Law law : {Law::neo_hooke, Law::small_strain}) {
        const auto model = make_reference(mesh, elastic(10e3, 0.45), law, {});
        tissue::ReferenceSystem system = make_system(model);
        tissue::ReferenceState state = rest_state(model), plus = state, minus = state;
        const double step_m = 1e-8;
        std::vector<double> way(model.unknown.size()), product(way.size());
        for (std::size_t i = 0; i < state.position_m.size(); ++i) {
            state.position_m[i] += 5e-4 * bodies::signed_vector(random);
            const dvec3 w = bodies::signed_vector(random);
            plus.position_m[i] = state.position_m[i] + step_m * w;
            minus.position_m[i] = state.position_m[i] - step_m * w;
            for (int k = 0; k < 3; ++k)
                way[3 * i + k] = w[k];
        }
        linearize(model, state, system);
        CHECK(std::isfinite(system.energy_j));
        CHECK(system.energy_j ==
              doctest::Approx(elastic_energy_j(model, state.position_m)).scale(0.0));
        const double slope_n =
            (elastic_energy_j(model, plus.position_m) - elastic_energy_j(model, minus.position_m)) /
            (2 * step_m);
        CHECK(slope_n ==
              doctest::Approx(bodies::inner(system.internal_n, way)).scale(0.0).epsilon(1e-7));

        multiply(model.all, system.stiffness, way, product);
        std::vector<dvec3> up(way.size() / 3), down(way.size() / 3);
        elastic_forces(model, plus.position_m, up);
        elastic_forces(model, minus.position_m, down);
        double error2 = 0.0;
        for (std::size_t i = 0; i < way.size(); ++i) {
            const int k = static_cast<int>(i % 3);
            const double change = (up[i / 3][k] - down[i / 3][k]) / (2 * step_m);
            error2 += (change - product[i]) * (change - product[i]);
        }
        CHECK(std::sqrt(error2) < 1e-6 * bodies::norm(product));
    }
}

TEST_CASE("a block drawn out between rollers is the homogeneous uniaxial state") {
    // sides free: their stretch t follows from P22 = 0, here by bisection in principal stretches,
    // psi(s, t, t) = mu/2 (J^-2/3 (s^2 + 2 t^2) - 3) + K/2 (J - 1)^2
    const tissue::QuadraticMesh mesh = irregular_box(kBox, 2, 11);
    for (const double poisson : {0.3, 0.49, 0.499}) {
        for (const double s : {0.6, 1.6}) {
            const tissue::Material material = elastic(10e3, poisson);
            const tissue::Elasticity e = elasticity(material, Law::neo_hooke);
            const auto side = [&](double t) {
                const double J = s * t * t;
                return e.mu_pa * std::pow(J, -2.0 / 3.0) * (t * t - s * s) / 3 +
                       e.bulk_pa * (J - 1) * J;
            };
            double low = 0.3, high = 3.0;
            for (int i = 0; i < 60; ++i)
                (side(0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
            const auto uniaxial = [&](const dvec3& x) { return x * dvec3(s, low, low); };
            const auto held = flags(mesh, [](const dvec3& x) {
                return (x.x < 1e-9 || x.x > kBox.x - 1e-9 ? tissue::kHeldX : 0) |
                       (x.y < 1e-9 ? tissue::kHeldY : 0) | (x.z < 1e-9 ? tissue::kHeldZ : 0);
            });
            const auto target = places(mesh, [&](auto& x) { return x * dvec3(s, 1, 1); });
            const auto found =
                reference_bodies::solve(mesh, material, Law::neo_hooke, held, {{}, target});
            CHECK(found.report.converged);
            CHECK(reference_bodies::greatest_error_m(found, uniaxial) < 1e-9 * kBox.x);

            std::vector<dvec3> force(mesh.rest_m.size());
            elastic_forces(found.model, found.state.position_m, force);
            double pull_n = 0.0;
            for (std::size_t i = 0; i < force.size(); ++i)
                pull_n += mesh.rest_m[i].x > kBox.x - 1e-9 ? force[i].x : 0.0;
            // P11 = dpsi/ds, and near nu = 0.5 that of the incompressible solid
            const double J = s * low * low;
            const double exact_pa =
                e.mu_pa * std::pow(J, -2.0 / 3.0) * (s - (s * s + 2 * low * low) / (3 * s)) +
                e.bulk_pa * (J - 1) * J / s;
            CHECK(pull_n == doctest::Approx(exact_pa * kBox.y * kBox.z).scale(0.0).epsilon(1e-8));
            const double incompressible_n = e.mu_pa * (s - 1 / (s * s)) * kBox.y * kBox.z;
            if (poisson == 0.499)
                CHECK(pull_n == doctest::Approx(incompressible_n).scale(0.0).epsilon(0.01));
        }
    }
}

TEST_CASE("setup of a reference body names what is wrong") {
    const tissue::QuadraticMesh mesh = irregular_box(kBox, 1, 1);
    const auto with = [&](const tissue::QuadraticMesh& m, const tissue::Material& material,
                          const std::vector<std::uint8_t>& held) {
        return make_reference(m, material, Law::neo_hooke, held);
    };
    tissue::QuadraticMesh bad = mesh;
    std::swap(bad.tets[3][0], bad.tets[3][1]); // and the edges to 2 and to 3
    std::swap(bad.tets[3][5], bad.tets[3][6]);
    std::swap(bad.tets[3][7], bad.tets[3][8]);
    CHECK_THROWS_WITH_AS(with(bad, elastic(1e3, 0.3), {}), doctest::Contains("tet 3 has volume"),
                         std::invalid_argument);
    bad = mesh;
    bad.tets[2][7] = 99;
    CHECK_THROWS_WITH_AS(with(bad, elastic(1e3, 0.3), {}), doctest::Contains("names node 99 of 27"),
                         std::invalid_argument);
    bad = mesh;
    bad.rest_m.push_back({});
    CHECK_THROWS_WITH_AS(with(bad, elastic(1e3, 0.3), {}), doctest::Contains("node 27 has no mass"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(with(mesh, elastic(1e3, 0.3), {7, 7}), doctest::Contains("for 2 nodes"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(with(mesh, elastic(1e3, 0.3), std::vector<std::uint8_t>(27, 7)),
                         doctest::Contains("nothing can move"), std::invalid_argument);
    CHECK_THROWS_WITH_AS(with(mesh, elastic(1e3, 0.3, 0.0), {}), doctest::Contains("density_kgpm3"),
                         std::invalid_argument);
}

TEST_CASE("a load or place for another number of nodes is refused, and so is a step of no time") {
    const tissue::QuadraticMesh mesh = irregular_box(kBox, 1, 1);
    const auto model = make_reference(mesh, elastic(1e3, 0.3), Law::neo_hooke, {});
    tissue::ReferenceSystem system = make_system(model);
    tissue::ReferenceState state = rest_state(model);
    const std::vector<dvec3> short_list(5);
    CHECK_THROWS_WITH_AS(solve_static(model, {short_list, {}}, {}, system, state),
                         doctest::Contains("forces for 5 nodes"), std::invalid_argument);
    CHECK_THROWS_WITH_AS(
        step(model, {{}, short_list}, 0.01, tissue::TimeRule::midpoint, {}, system, state),
        doctest::Contains("places of held components for 5 nodes"), std::invalid_argument);
    CHECK_THROWS_WITH_AS(step(model, {}, 0.0, tissue::TimeRule::implicit_euler, {}, system, state),
                         doctest::Contains("dt_s = 0"), std::invalid_argument);
}

TEST_CASE("reference statics of a loose body are reported, not invented") {
    const tissue::QuadraticMesh mesh = irregular_box(kBox, 1, 1);
    const auto s =
        reference_bodies::solve(mesh, elastic(1e3, 0.3), Law::neo_hooke, {}, {}, {0, 0, -9.81});
    CHECK_FALSE(s.report.converged);
    CHECK(s.state.position_m == mesh.rest_m);
}
