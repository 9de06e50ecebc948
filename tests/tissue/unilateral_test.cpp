// tests/tissue/unilateral_test.cpp
// Forces that only push, found by products with their matrix alone: the conditions that define them
// hold, and an independent solver, projected Gauss-Seidel on the whole matrix, finds the same.
#include "tissue/response/unilateral.h"

#include <doctest/doctest.h>
#include <random>

namespace {

struct Problem {
    std::size_t n;
    std::vector<double> B, q; // row by row
    std::vector<double> last, y_of_moves;

    Problem(std::size_t size, std::size_t factors, unsigned seed)
        : n(size), B(size * size), q(size) {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal;
        std::vector<double> L(n * factors);
        for (double& x : L)
            x = normal(random);
        for (std::size_t i = 0; i < n; ++i) {
            q[i] = normal(random);
            for (std::size_t j = 0; j < n; ++j) {
                B[i * n + j] = i == j;
                for (std::size_t k = 0; k < factors; ++k)
                    B[i * n + j] += L[i * factors + k] * L[j * factors + k];
            }
        }
        last = y_of_moves = std::vector<double>(n);
    }
    std::vector<double> times(std::span<const double> d) const {
        std::vector<double> out(n);
        for (std::size_t i = 0; i < n; ++i)
            out[i] = tissue::product_of(std::span(B).subspan(i * n, n), d);
        return out;
    }
    void product(std::span<const double> d, std::span<double> out) {
        const std::vector<double> Bd = times(d);
        std::copy(Bd.begin(), Bd.end(), out.begin());
        last.assign(d.begin(), d.end());
    }
    void move(double share) {
        for (std::size_t i = 0; i < n; ++i)
            y_of_moves[i] += share * last[i];
    }
    std::vector<double> gauss_seidel() const {
        std::vector<double> y(n);
        for (int sweep = 0; sweep < 20000; ++sweep) {
            for (std::size_t i = 0; i < n; ++i) {
                const double g = q[i] + tissue::product_of(std::span(B).subspan(i * n, n), y);
                y[i] = std::max(0.0, y[i] - g / B[i * n + i]);
            }
        }
        return y;
    }
};

struct Solved {
    std::vector<double> y, gradient;
    tissue::UnilateralReport report;
};

Solved solve(Problem& problem, std::vector<double> start, int most = 500) {
    Solved out{std::move(start), {}, {}};
    out.gradient = problem.times(out.y);
    for (std::size_t i = 0; i < problem.n; ++i)
        out.gradient[i] += problem.q[i];
    problem.y_of_moves = out.y;
    tissue::UnilateralScratch scratch = tissue::make_unilateral_scratch(problem.n + 3);
    const std::vector<double> weight(problem.n, 1.0);
    out.report =
        tissue::solve_unilateral(problem, weight, 1e-11, most, scratch, out.y, out.gradient);
    return out;
}

} // namespace

TEST_CASE("unilateral: rows that do not feel each other push with what is missing, or not at all") {
    Problem problem(12, 0, 1);
    const Solved solved = solve(problem, std::vector<double>(12));
    for (std::size_t i = 0; i < problem.n; ++i)
        CHECK(solved.y[i] == doctest::Approx(std::max(0.0, -problem.q[i])).epsilon(1e-12));
}

TEST_CASE("unilateral: the answer is that of projected Gauss-Seidel, from any start") {
    for (const unsigned seed : {1u, 2u, 3u, 4u}) {
        for (const std::size_t factors : {3u, 12u, 40u}) {
            CAPTURE(seed);
            CAPTURE(factors);
            Problem problem(40, factors, seed);
            const std::vector<double> expected = problem.gauss_seidel();
            std::vector<double> start(40);
            for (const double from : {0.0, 3.0}) {
                std::fill(start.begin(), start.end(), from);
                const Solved solved = solve(problem, start);
                CHECK(solved.report.residual <= 1e-11);
                double worst = 0.0, moved = 0.0, pushing = 0.0;
                for (std::size_t i = 0; i < problem.n; ++i) {
                    worst = std::max(worst, std::abs(solved.y[i] - expected[i]));
                    moved = std::max(moved, std::abs(solved.y[i] - problem.y_of_moves[i]));
                    pushing += solved.y[i] > 0.0;
                }
                CHECK(worst < 1e-9);
                CHECK(moved < 1e-12); // what the bodies were moved by belongs to the forces
                CHECK(pushing > 5.0);
                CHECK(pushing < 35.0);
            }
        }
    }
}

TEST_CASE("unilateral: forces that are right cost no product, and few products do most of it") {
    Problem problem(40, 12, 7);
    const Solved solved = solve(problem, std::vector<double>(40));
    CHECK(solve(problem, solved.y).report.products == 0);
    // of 1 + 12 different eigenvalues: conjugate gradients need 13 products on each face
    CHECK(solved.report.products < 120);
}
