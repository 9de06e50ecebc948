// tests/tissue/small_eigen_test.cpp
#include "tissue/response/small_eigen.h"

#include "tests/tissue/bodies.h"

#include <doctest/doctest.h>

namespace {

// B^T B + shift I of a random square B: positive definite.
tissue::SmallMatrix random_positive(int size, double shift, unsigned seed) {
    std::mt19937_64 random(seed);
    tissue::SmallMatrix b, m;
    for (int j = 0; j < size; ++j) {
        for (int k = 0; k < size; ++k)
            b[j][k] = bodies::signed_unit(random);
    }
    for (int i = 0; i < size; ++i) {
        for (int j = 0; j < size; ++j) {
            m[i][j] = i == j ? shift : 0.0;
            for (int k = 0; k < size; ++k)
                m[i][j] += b[i][k] * b[j][k];
        }
    }
    return m;
}

} // namespace

TEST_CASE("eigenvectors are orthonormal, ascending, and rebuild their matrix") {
    for (const int size : {1, 2, 3, 11, 33, 36}) {
        const tissue::SmallMatrix m = random_positive(size, 1e-3, 5);
        tissue::SmallMatrix u = m;
        std::array<double, tissue::kSmall> value{};
        const int sweeps = tissue::positive_eigen(u, size, value);
        CHECK(sweeps > 0);
        CHECK(sweeps < 12);
        for (int i = 0; i < size; ++i) {
            if (i > 0)
                CHECK(value[i] >= value[i - 1]);
            for (int j = 0; j < size; ++j) {
                double inner = 0.0, rebuilt = 0.0;
                for (int k = 0; k < size; ++k) {
                    inner += u[i][k] * u[j][k];
                    rebuilt += u[k][i] * value[k] * u[k][j];
                }
                CHECK(std::abs(inner - (i == j ? 1.0 : 0.0)) < 1e-13);
                CHECK(std::abs(rebuilt - m[i][j]) < 1e-13 * value[size - 1]);
            }
        }
    }
}

TEST_CASE("eigenvalues of the second difference are 4 sin^2(k pi / (2 (n + 1)))") {
    constexpr int n = 20;
    tissue::SmallMatrix m;
    for (int i = 0; i < n; ++i) {
        m[i][i] = 2.0;
        if (i > 0)
            m[i][i - 1] = m[i - 1][i] = -1.0;
    }
    std::array<double, tissue::kSmall> value{};
    tissue::positive_eigen(m, n, value);
    for (int k = 1; k <= n; ++k) {
        const double s = std::sin(k * std::acos(-1.0) / (2 * (n + 1)));
        CHECK(value[k - 1] == doctest::Approx(4 * s * s).scale(0.0).epsilon(1e-13));
    }
}

TEST_CASE("a matrix that is not positive definite is reported") {
    tissue::SmallMatrix m = random_positive(5, 0.1, 2);
    m[2][2] = -1.0;
    std::array<double, tissue::kSmall> value{};
    CHECK(tissue::positive_eigen(m, 5, value) == 0);
}

TEST_CASE("pivoting stays within a group and drops what an earlier group already holds") {
    // Gram matrix of e0 | e0 again, small e1 | e1 + e2, e0 + e1
    const double small = 1e-4, s = std::sqrt(0.5);
    const std::array<std::array<double, 3>, 5> v{
        {{1, 0, 0}, {1, 0, 0}, {0, small, 0}, {0, s, s}, {s, s, 0}}};
    tissue::SmallMatrix m;
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j) {
            for (int k = 0; k < 3; ++k)
                m[i][j] += v[i][k] * v[j][k];
        }
    }
    const tissue::SmallMatrix gram = m;
    const std::array<int, 3> groups{1, 2, 2};
    std::array<int, tissue::kSmall> kept{};
    REQUIRE(tissue::pivoted_cholesky(m, 5, groups, 1e-12, kept) == 3);
    CHECK(kept[0] == 0);
    CHECK(kept[1] == 2); // the small one comes before any of the last group
    CHECK(kept[2] == 3);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            double rebuilt = 0.0;
            for (int k = 0; k < 3; ++k)
                rebuilt += m[k][i] * m[k][j];
            CHECK(std::abs(rebuilt - gram[kept[i]][kept[j]]) < 1e-15);
        }
    }
}
