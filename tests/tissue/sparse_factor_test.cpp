// tests/tissue/sparse_factor_test.cpp
#include "tissue/solver/sparse_factor.h"
#include "tissue/solver/sparse_products.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <utility>

namespace {

struct Matrix {
    tissue::SparsePattern pattern;
    std::vector<double> values;
};

// Random symmetric, strictly diagonally dominant, hence positive definite (Gershgorin).
Matrix random_dominant(int size, int per_column, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::vector<double>> dense(size, std::vector<double>(size, 0.0));
    for (int c = 0; c < size; ++c) {
        for (int k = 0; k < per_column && c + 1 < size; ++k) {
            const int r = c + 1 + static_cast<int>(random() % static_cast<unsigned>(size - c - 1));
            dense[r][c] = dense[c][r] = static_cast<double>(random() % 2001) / 1000.0 - 1.0;
        }
    }
    Matrix m;
    m.pattern.size = size;
    m.pattern.column_start = {0};
    for (int c = 0; c < size; ++c) {
        double row_sum = 0.5;
        for (int r = 0; r < size; ++r)
            row_sum += std::abs(dense[r][c]);
        m.pattern.row.push_back(c);
        m.values.push_back(row_sum);
        for (int r = c + 1; r < size; ++r) {
            if (dense[r][c] == 0.0)
                continue;
            m.pattern.row.push_back(r);
            m.values.push_back(dense[r][c]);
        }
        m.pattern.column_start.push_back(static_cast<int>(m.pattern.row.size()));
    }
    return m;
}

// -u'' on n points: 2 on the diagonal, -1 beside it.
Matrix chain(int n) {
    Matrix m;
    m.pattern.size = n;
    m.pattern.column_start = {0};
    for (int c = 0; c < n; ++c) {
        m.pattern.row.push_back(c);
        m.values.push_back(2.0);
        if (c + 1 < n) {
            m.pattern.row.push_back(c + 1);
            m.values.push_back(-1.0);
        }
        m.pattern.column_start.push_back(static_cast<int>(m.pattern.row.size()));
    }
    return m;
}

std::vector<double> random_vector(std::size_t size, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<double> v(size);
    for (double& x : v)
        x = static_cast<double>(random() % 2001) / 1000.0 - 1.0;
    return v;
}

} // namespace

TEST_CASE("a chain under unit load bends to the parabola i (n + 1 - i) / 2") {
    constexpr int n = 200;
    const Matrix m = chain(n);
    tissue::SparseFactor factor(m.pattern);
    REQUIRE(factor.factor(m.values));
    std::vector<double> x(n, 1.0);
    factor.solve(x, 1);
    for (int i = 1; i <= n; ++i) {
        CHECK(x[i - 1] == doctest::Approx(i * (n + 1 - i) / 2.0).scale(0.0).epsilon(1e-11));
    }
}

TEST_CASE("multiply agrees with the dense symmetric matrix") {
    const Matrix m = random_dominant(40, 3, 1);
    std::vector<std::vector<double>> dense(40, std::vector<double>(40, 0.0));
    for (int c = 0; c < 40; ++c) {
        for (int k = m.pattern.column_start[c]; k < m.pattern.column_start[c + 1]; ++k) {
            dense[m.pattern.row[k]][c] = dense[c][m.pattern.row[k]] = m.values[k];
        }
    }
    const std::vector<double> x = random_vector(40, 2);
    std::vector<double> y(40, 99.0);
    tissue::multiply(m.pattern, m.values, x, y);
    for (int r = 0; r < 40; ++r) {
        double expected = 0.0;
        for (int c = 0; c < 40; ++c)
            expected += dense[r][c] * x[c];
        CHECK(y[r] == doctest::Approx(expected).scale(0.0).epsilon(1e-13));
    }
}

TEST_CASE("solutions leave a residual below 1e-10, for one and for many right-hand sides") {
    const int n = 300;
    const Matrix m = random_dominant(n, 4, 5);
    tissue::SparseFactor factor(m.pattern);
    REQUIRE(factor.factor(m.values));
    for (const int columns : {1, 3, 11, 33}) {
        const std::vector<double> b = random_vector(static_cast<std::size_t>(n * columns), 6);
        std::vector<double> x = b, product(n);
        factor.solve(x, columns);
        double error = 0.0, size = 0.0;
        for (int c = 0; c < columns; ++c) {
            tissue::multiply(m.pattern, m.values, std::span(x).subspan(c * n, n), product);
            for (int i = 0; i < n; ++i) {
                error += std::pow(product[i] - b[c * n + i], 2);
                size += std::pow(b[c * n + i], 2);
            }
        }
        CHECK(std::sqrt(error / size) < 1e-10);
    }
}

TEST_CASE("loads of few unknowns are solved for as those of all, alone and beside others") {
    constexpr int kColumns = 9;
    for (const auto& [m, n] : {std::pair{random_dominant(300, 4, 5), 300}, {chain(200), 200}}) {
        tissue::SparseFactor factor(m.pattern);
        REQUIRE(factor.factor(m.values));
        std::mt19937 random(8);
        std::vector<double> few(static_cast<std::size_t>(kColumns * n), 0.0);
        for (int c = 0; c + 1 < kColumns; ++c) { // the last is of no load at all
            for (int k = 0; k <= c % 3; ++k)
                few[c * n + static_cast<int>(random() % static_cast<unsigned>(n))] += 1.0 + k;
        }
        const std::vector<double> full = random_vector(static_cast<std::size_t>(n), 9);
        std::vector<double> x = few, of_full = full, product(n);
        factor.solve(x, kColumns);
        factor.solve(of_full, 1);
        for (int c = 0; c < kColumns; ++c) {
            const std::span column = std::span(x).subspan(c * n, n);
            tissue::multiply(m.pattern, m.values, column, product);
            double left = 0.0, work = 0.0, other = 0.0; // b^T A^-1 f, both ways
            for (int i = 0; i < n; ++i) {
                left = std::max(left, std::abs(product[i] - few[c * n + i]));
                work += full[i] * column[i];
                other += few[c * n + i] * of_full[i];
            }
            CHECK(left < 1e-10);
            CHECK(work == doctest::Approx(other).epsilon(1e-9));
            std::vector<double> alone(few.begin() + c * n, few.begin() + (c + 1) * n);
            factor.solve(alone, 1);
            for (int i = 0; i < n; ++i)
                CHECK(alone[i] == doctest::Approx(column[i]).scale(1.0).epsilon(1e-12));
        }
        CHECK(std::all_of(x.end() - n, x.end(), [](double v) { return v == 0.0; }));
    }
}

TEST_CASE("compliances are those of whole solves, for more columns than go at a time") {
    constexpr int kColumns = 200, n = 300;
    const Matrix m = random_dominant(n, 4, 11);
    tissue::SparseFactor factor(m.pattern);
    tissue::SparseColumns few;
    std::vector<double> out(kColumns, -1.0), load(kColumns * n, 0.0);
    std::mt19937 random(12);
    for (int c = 0; c < kColumns; ++c) {
        for (int k = 0; k < c % 5; ++k) { // none at all, and some twice
            const int at = static_cast<int>(random() % (k == 4 ? 2u : static_cast<unsigned>(n)));
            for (int twice = 0; twice <= k % 2; ++twice) {
                few.add(at, 1.0 + k);
                load[c * n + at] += 1.0 + k;
            }
        }
        few.end_column();
    }
    CHECK(!factor.compliances(few, out)); // not factored yet
    CHECK(out[0] == -1.0);
    REQUIRE(factor.factor(m.values));
    CHECK(!factor.compliances(few, std::span(out).first(kColumns - 1))); // sizes do not fit
    REQUIRE(factor.compliances(few, out));
    std::vector<double> x = load;
    REQUIRE(factor.solve(x, kColumns));
    for (int c = 0; c < kColumns; ++c) {
        double work = 0.0;
        for (int i = 0; i < n; ++i)
            work += load[c * n + i] * x[c * n + i];
        CHECK(out[c] == doctest::Approx(work).epsilon(1e-10));
    }
}

TEST_CASE("compliances of three columns with each other are those of whole solves") {
    constexpr int kPlaces = 70, n = 300; // more than go at a time
    const Matrix m = random_dominant(n, 4, 13);
    tissue::SparseFactor factor(m.pattern);
    tissue::SparseColumns few;
    std::vector<double> load(3 * kPlaces * n, 0.0);
    std::mt19937 random(14);
    for (int c = 0; c < 3 * kPlaces; ++c) {
        for (int k = 0; k < 4; ++k) {
            const int at = static_cast<int>(random() % static_cast<unsigned>(n));
            few.add(at, 1.0 + k);
            load[c * n + at] += 1.0 + k;
        }
        few.end_column();
    }
    std::vector<std::array<double, 6>> out(kPlaces);
    CHECK(!factor.compliances(few, out)); // not factored yet
    REQUIRE(factor.factor(m.values));
    CHECK(!factor.compliances(few, std::span(out).first(kPlaces - 1))); // sizes do not fit
    REQUIRE(factor.compliances(few, out));
    std::vector<double> x = load;
    REQUIRE(factor.solve(x, 3 * kPlaces));
    constexpr int kFirst[]{0, 1, 2, 1, 0, 0}, kSecond[]{0, 1, 2, 2, 2, 1};
    for (int place = 0; place < kPlaces; ++place) {
        for (int k = 0; k < 6; ++k) {
            double work = 0.0;
            for (int i = 0; i < n; ++i)
                work += load[(3 * place + kFirst[k]) * n + i] * x[(3 * place + kSecond[k]) * n + i];
            CHECK(out[place][k] == doctest::Approx(work).scale(1.0).epsilon(1e-10));
        }
    }
}

TEST_CASE("factoring again gives the same bits, also in another object") {
    const Matrix m = random_dominant(250, 4, 9), other = random_dominant(250, 4, 10);
    const std::vector<double> b = random_vector(250 * 7, 11);
    tissue::SparseFactor a(m.pattern);
    std::vector<double> first = b, second = b, third = b;
    REQUIRE(a.factor(m.values));
    a.solve(first, 7);

    std::vector<double> scaled = m.values;
    for (double& v : scaled)
        v *= 3.0;
    REQUIRE(a.factor(scaled));
    REQUIRE(a.factor(m.values));
    a.solve(second, 7);
    CHECK(first == second);

    tissue::SparseFactor fresh(m.pattern);
    REQUIRE(fresh.factor(m.values));
    fresh.solve(third, 7);
    CHECK(first == third);
}

TEST_CASE("an indefinite matrix is reported, and the object still works afterwards") {
    Matrix m = random_dominant(100, 3, 4);
    tissue::SparseFactor factor(m.pattern);
    std::vector<double> indefinite = m.values;
    indefinite[m.pattern.column_start[60]] = -1.0;
    CHECK_FALSE(factor.factor(indefinite));
    indefinite[m.pattern.column_start[60]] = std::nan("");
    CHECK_FALSE(factor.factor(indefinite));
    CHECK(factor.factor(m.values));
}

TEST_CASE("a moved factor keeps its answer") {
    const Matrix m = chain(50);
    tissue::SparseFactor a(m.pattern);
    REQUIRE(a.factor(m.values));
    tissue::SparseFactor b = std::move(a);
    std::vector<double> x(50, 1.0);
    b.solve(x, 1);
    CHECK(x[0] == doctest::Approx(25.0).scale(0.0));
    CHECK(b.factor(m.values));
}

TEST_CASE("vectors side by side are multiplied as if alone, however many, in place too") {
    const Matrix m = random_dominant(97, 5, 3);
    const auto n = static_cast<std::size_t>(m.pattern.size);
    std::vector<double> scratch(2 * tissue::kProductLanes * n, 1.0); // whatever stood there
    for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 33u}) {
        std::vector<std::vector<double>> x, y(count, std::vector<double>(n, 1.0));
        std::vector<const double*> from;
        std::vector<double*> to;
        for (std::size_t j = 0; j < count; ++j)
            x.push_back(random_vector(n, static_cast<unsigned>(10 + j)));
        std::vector<std::vector<double>> in_place = x;
        for (std::size_t j = 0; j < count; ++j) {
            from.push_back(j % 2 ? in_place[j].data() : x[j].data());
            to.push_back(j % 2 ? in_place[j].data() : y[j].data());
        }
        tissue::multiply_each(m.pattern, m.values, from, to, scratch);
        for (std::size_t j = 0; j < count; ++j) {
            std::vector<double> expected(n);
            tissue::multiply(m.pattern, m.values, x[j], expected);
            for (std::size_t i = 0; i < n; ++i)
                CHECK(std::abs(to[j][i] - expected[i]) < 1e-12);
        }
    }
}
