// tests/tissue/hyperelastic_test.cpp
#include "tests/tissue/bodies.h"
#include "tissue/material/hyperelastic.h"

#include <doctest/doctest.h>
#include <glm/matrix.hpp>

using glm::dmat3;
using glm::dvec3;

namespace {

constexpr tissue::Law kLaws[]{tissue::Law::neo_hooke, tissue::Law::small_strain};

tissue::Elasticity tissue_of(double poisson, tissue::Law law = tissue::Law::neo_hooke) {
    return tissue::elasticity(bodies::elastic(10e3, poisson), law);
}

dmat3 random_matrix(std::mt19937_64& random) {
    return {bodies::signed_vector(random), bodies::signed_vector(random),
            bodies::signed_vector(random)};
}

// Strains of up to a half or so, turned by up to half a turn.
dmat3 random_gradient(std::mt19937_64& random) {
    const dmat3 turn =
        bodies::rotation(bodies::signed_vector(random), 3.0 * bodies::signed_unit(random));
    return turn * (dmat3(1.0) + 0.25 * random_matrix(random));
}

double inner(const dmat3& a, const dmat3& b) {
    return glm::dot(a[0], b[0]) + glm::dot(a[1], b[1]) + glm::dot(a[2], b[2]);
}

dmat3 contract(const tissue::Tangent& A, const dmat3& H) {
    dmat3 out(0.0);
    for (int i = 0; i < 9; ++i) {
        for (int j = 0; j < 9; ++j)
            out[i / 3][i % 3] += A[i][j] * H[j / 3][j % 3];
    }
    return out;
}

// sigma = P F^T / J
dmat3 cauchy_pa(const tissue::Elasticity& e, const dmat3& F) {
    return tissue::piola_stress_pa(e, F) * glm::transpose(F) / glm::determinant(F);
}

} // namespace

TEST_CASE("the stress is the slope of the energy, the tangent that of the stress") {
    // central differences: error of second order, step^2 = 1e-10 of the third derivative
    constexpr double kStep = 1e-5;
    std::mt19937_64 random(1);
    for (const tissue::Law law : kLaws) {
        for (const double poisson : {0.0, 0.3, 0.49}) {
            const tissue::Elasticity e = tissue_of(poisson, law);
            for (int i = 0; i < 20; ++i) {
                const dmat3 F = random_gradient(random), H = random_matrix(random);
                REQUIRE(glm::determinant(F) > 0.0);
                const dmat3 P = tissue::piola_stress_pa(e, F);
                const double slope = (tissue::energy_density_jpm3(e, F + kStep * H) -
                                      tissue::energy_density_jpm3(e, F - kStep * H)) /
                                     (2 * kStep);
                CHECK(std::abs(slope - inner(P, H)) < 1e-8 * e.bulk_pa);

                const dmat3 change = (tissue::piola_stress_pa(e, F + kStep * H) -
                                      tissue::piola_stress_pa(e, F - kStep * H)) *
                                     (0.5 / kStep);
                const dmat3 error = change - contract(tissue::piola_tangent_pa(e, F), H);
                CHECK(std::sqrt(inner(error, error)) < 1e-7 * e.bulk_pa);
            }
        }
    }
}

TEST_CASE("both laws are Hooke's at rest") {
    const double young = 10e3, nu = 0.3;
    for (const tissue::Law law : kLaws) {
        const tissue::Elasticity e = tissue_of(nu, law);
        CHECK(tissue::energy_density_jpm3(e, dmat3(1.0)) == 0.0);
        const tissue::Tangent A = tissue::piola_tangent_pa(e, dmat3(1.0));
        const double lambda = young * nu / ((1 + nu) * (1 - 2 * nu)), mu = young / (2 * (1 + nu));
        for (int i = 0; i < 9; ++i) {
            for (int j = 0; j < 9; ++j) {
                const int r = i % 3, k = i / 3, c = j % 3, l = j / 3;
                const double hooke =
                    lambda * (r == k) * (c == l) + mu * ((r == c) * (k == l) + (r == l) * (k == c));
                CHECK(std::abs(A[i][j] - hooke) < 1e-11 * young);
            }
        }
    }
}

TEST_CASE("neo-Hooke: uniaxial, equibiaxial and simple shear at constant volume") {
    // closed forms of the incompressible solid; the pressure drops out of the differences
    for (const double poisson : {0.3, 0.49}) {
        const tissue::Elasticity e = tissue_of(poisson);
        for (const double s : {0.5, 0.9, 1.3, 2.0}) {
            const double across = 1 / std::sqrt(s);
            dmat3 F(0.0);
            F[0][0] = s, F[1][1] = F[2][2] = across;
            dmat3 sigma = cauchy_pa(e, F);
            CHECK(sigma[0][0] - sigma[1][1] ==
                  doctest::Approx(e.mu_pa * (s * s - 1 / s)).scale(0.0).epsilon(1e-12));

            F[0][0] = F[1][1] = s, F[2][2] = 1 / (s * s);
            sigma = cauchy_pa(e, F);
            CHECK(sigma[0][0] - sigma[2][2] ==
                  doctest::Approx(e.mu_pa * (s * s - std::pow(s, -4))).scale(0.0).epsilon(1e-12));

            F = dmat3(1.0), F[1][0] = s; // gamma = s
            sigma = cauchy_pa(e, F);
            CHECK(sigma[1][0] == doctest::Approx(e.mu_pa * s).scale(0.0).epsilon(1e-12));
            CHECK(sigma[0][0] - sigma[1][1] ==
                  doctest::Approx(e.mu_pa * s * s).scale(0.0).epsilon(1e-12));
        }
    }
}

TEST_CASE("neo-Hooke: pressure follows the change of volume alone") {
    // psi = K/2 (J - 1)^2 for F = J^1/3 I, hence sigma = K (J - 1) I
    const tissue::Elasticity e = tissue_of(0.3);
    for (const double J : {0.3, 0.8, 1.5}) {
        const dmat3 F(std::cbrt(J));
        CHECK(tissue::energy_density_jpm3(e, F) ==
              doctest::Approx(0.5 * e.bulk_pa * (J - 1) * (J - 1)).scale(0.0).epsilon(1e-12));
        const dmat3 sigma = cauchy_pa(e, F);
        for (int k = 0; k < 3; ++k)
            CHECK(sigma[k][k] == doctest::Approx(e.bulk_pa * (J - 1)).scale(0.0).epsilon(1e-12));
    }
}

TEST_CASE("neo-Hooke: a rotation changes no energy and turns the stress") {
    std::mt19937_64 random(4);
    const tissue::Elasticity e = tissue_of(0.45);
    for (int i = 0; i < 20; ++i) {
        const dmat3 F = random_gradient(random);
        const dmat3 R = bodies::rotation(bodies::signed_vector(random), 6 * i);
        CHECK(tissue::energy_density_jpm3(e, R * F) ==
              doctest::Approx(tissue::energy_density_jpm3(e, F)).scale(0.0).epsilon(1e-12));
        const dmat3 error = tissue::piola_stress_pa(e, R * F) - R * tissue::piola_stress_pa(e, F);
        CHECK(std::sqrt(inner(error, error)) < 1e-12 * e.bulk_pa);
    }
}

TEST_CASE("neo-Hooke: flat and inverted solids have infinite energy") {
    const tissue::Elasticity e = tissue_of(0.45);
    dmat3 F(1.0);
    for (const double s : {0.0, -1.0}) {
        F[2][2] = s;
        CHECK(std::isinf(tissue::energy_density_jpm3(e, F)));
    }
}

TEST_CASE("a projected tangent keeps what is positive and loses what is not") {
    std::mt19937_64 random(7);
    int indefinite = 0;
    for (int i = 0; i < 30; ++i) {
        // compressed by half, where neo-Hooke's tangent has negative eigenvalues
        const dmat3 F = 0.8 * random_gradient(random);
        const tissue::Elasticity e = tissue_of(0.45);
        const tissue::Tangent A = tissue::piola_tangent_pa(e, F);
        tissue::Tangent B = A;
        tissue::project_positive(B);
        tissue::Tangent twice = B;
        tissue::project_positive(twice);
        double change = 0.0, size = 0.0, again = 0.0, cross = 0.0;
        for (int r = 0; r < 9; ++r) {
            for (int c = 0; c < 9; ++c) {
                change = std::max(change, std::abs(B[r][c] - A[r][c]));
                again = std::max(again, std::abs(twice[r][c] - B[r][c]));
                size = std::max(size, std::abs(A[r][c]));
                cross += (B[r][c] - A[r][c]) * B[r][c]; // nearest: B - A is orthogonal to B
            }
        }
        indefinite += change > 1e-9 * size;
        CHECK(again < 1e-12 * size);
        CHECK(std::abs(cross) < 1e-11 * size * size);
        for (int k = 0; k < 50; ++k) {
            const dmat3 H = random_matrix(random);
            CHECK(inner(H, contract(B, H)) > -1e-12 * size * inner(H, H));
            CHECK(inner(H, contract(B, H)) > inner(H, contract(A, H)) - 1e-12 * size * inner(H, H));
        }
    }
    CHECK(indefinite > 5);
}

TEST_CASE("a material out of range is refused by name") {
    CHECK_THROWS_WITH_AS(tissue_of(0.5), doctest::Contains("poisson = 0.5"), std::invalid_argument);
}
