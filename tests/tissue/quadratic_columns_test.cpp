// tests/tissue/quadratic_columns_test.cpp
// Sixteen columns side by side beside one at a time.
#include "tissue/solver/quadratic_columns.h"

#include "tests/tissue/allocations.h"
#include "tests/tissue/quadratic_bodies.h"

#include <doctest/doctest.h>

using bodies::elastic;

namespace {

struct Scene {
    tissue::QuadraticModel model;
    tissue::QuadraticSystem system;
    std::size_t n = 0;
};

// A bent, damped body in a bed, linearised for steps of 10 ms. At nu 0.45 its tangent is
// indefinite.
Scene scene(double poisson = 0.3) {
    const auto mesh = quadratic_bodies::curved_box(3);
    tissue::Material material = elastic(20e3, poisson);
    material.damping_mass_1ps = 3.0;
    material.damping_stiffness_s = 2e-3;
    std::vector<tissue::BedSample> bed;
    for (std::uint32_t t = 0; t < 8; ++t)
        bed.push_back({t, {0.2, 0.3, 0.1, 0.4}, 2e-3});
    auto model =
        make_quadratic(mesh, material, quadratic_bodies::held_at_x0(mesh), glm::dvec3(0.0), bed);
    auto system = make_system(model, 0.01);
    auto state = rest_state(model);
    const auto to = quadratic_bodies::bent(state.position_m, 5);
    for (std::size_t i = 0; i < to.size(); ++i) {
        if (model.dof[i] >= 0)
            state.position_m[i] = to[i];
    }
    linearize(model, state, system);
    REQUIRE(!system.recovering);
    const auto n = static_cast<std::size_t>(model.unknowns);
    return {std::move(model), std::move(system), n};
}

std::vector<double> random_block(std::size_t n, int columns, unsigned seed) {
    std::mt19937_64 random(seed);
    std::vector<double> block(n * static_cast<std::size_t>(columns));
    for (double& x : block)
        x = bodies::signed_unit(random);
    return block;
}

std::span<double> column(std::vector<double>& block, std::size_t n, int j) {
    return {block.data() + static_cast<std::size_t>(j) * n, n};
}

double off(std::span<const double> a, std::span<const double> b) {
    double off2 = 0.0, size2 = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        off2 += (a[k] - b[k]) * (a[k] - b[k]);
        size2 += b[k] * b[k];
    }
    return std::sqrt(off2 / size2);
}

} // namespace

TEST_CASE("a factor solves sixteen columns as it solves one, to single precision") {
    for (const int cells : {1, 2, 3, 5}) {
        const auto mesh =
            tissue::quadratic_mesh(tissue::box_mesh({0.1, 0.1, 0.1}, {cells, cells, cells}));
        const auto model =
            make_quadratic(mesh, elastic(20e3, 0.3), quadratic_bodies::held_at_x0(mesh));
        auto system = make_system(model, 0.01);
        const auto n = static_cast<std::size_t>(model.unknowns);
        const std::vector<double> b = random_block(n, 16, 7);
        for (std::size_t k = 0; k < n; ++k) {
            for (std::size_t j = 0; j < 16; ++j)
                system.block.ordered[k].lane[j] = static_cast<float>(b[j * n + k]);
        }
        solve_block(system.single, system.block.ordered);
        for (std::size_t j = 0; j < 16; ++j) {
            std::vector<float> one(b.begin() + static_cast<std::ptrdiff_t>(j * n),
                                   b.begin() + static_cast<std::ptrdiff_t>((j + 1) * n));
            solve(system.single, one, system.lines);
            double off2 = 0.0, size2 = 0.0;
            for (std::size_t k = 0; k < n; ++k) {
                const double d = one[k] - system.block.ordered[k].lane[j];
                off2 += d * d;
                size2 += one[k] * one[k];
            }
            CHECK(off2 < 1e-10 * size2); // 6e-8 times a condition of some hundreds, squared
            CHECK(size2 > 0.0);
        }
    }
}

TEST_CASE("products with any number of columns are those with one") {
    Scene s = scene();
    for (const int columns : {1, 9, 16, 17, 33}) {
        std::vector<double> x = random_block(s.n, columns, 11), k(x.size()), m(x.size()), one(s.n);
        stiffness_products(s.model, x, columns, s.system, k);
        mass_products(s.model, x, columns, s.system, m);
        for (int j = 0; j < columns; ++j) {
            stiffness_product(s.model, column(x, s.n, j), s.system, one);
            CHECK(off(column(k, s.n, j), one) < 1e-6);
            mass_product(s.model, column(x, s.n, j), s.system, one);
            CHECK(off(column(m, s.n, j), one) < 1e-14);
        }
    }
}

TEST_CASE("any number of columns is solved to the tolerance, as one at a time") {
    Scene s = scene();
    const double of_m = 1.0 / (0.01 * 0.01) + s.model.material.damping_mass_1ps / 0.01;
    const double of_k = 1.0 + s.model.material.damping_stiffness_s / 0.01;
    const tissue::QuadraticOptions options{.linear_tolerance = 1e-4};
    for (const int columns : {1, 9, 16, 17, 33}) {
        std::vector<double> b = random_block(s.n, columns, 13), x = b, k(b.size()), m(b.size()),
                            one(s.n), residual(static_cast<std::size_t>(columns));
        const auto report = solve_columns(s.model, options, s.system, x, columns, residual);
        CHECK(report.relative_residual <= 1e-4);
        CHECK(!report.projected);
        stiffness_products(s.model, x, columns, s.system, k);
        mass_products(s.model, x, columns, s.system, m);
        for (int j = 0; j < columns; ++j) {
            for (std::size_t i = 0; i < s.n; ++i)
                one[i] = of_k * column(k, s.n, j)[i] + of_m * column(m, s.n, j)[i];
            const double true_residual = off(one, column(b, s.n, j));
            // the residual that is carried along drifts by what single precision rounds
            CHECK(true_residual < 1.2e-4);
            CHECK(residual[static_cast<std::size_t>(j)] <= report.relative_residual);
            const auto single = solve(s.model, options, column(b, s.n, j), s.system, one);
            CHECK(off(column(x, s.n, j), one) < 2e-3); // tolerance times a condition of tens
            CHECK(single.relative_residual <= 1e-4);
        }
    }
}

TEST_CASE("columns on which A is indefinite are solved with less geometric stiffness") {
    Scene s = scene(0.45);
    std::vector<double> x = random_block(s.n, 9, 13), one(s.n);
    const std::vector<double> b = x;
    const auto report = solve_columns(s.model, {}, s.system, x, 9);
    CHECK(report.projected);
    CHECK(report.relative_residual <= 1e-3);
    // and the tangent stays so: others find the same body
    std::vector<double> again = b;
    CHECK(!solve_columns(s.model, {}, s.system, again, 9).projected);
    CHECK(again == x);
    CHECK(!solve(s.model, {}, column(again, s.n, 0), s.system, one).projected);
}

TEST_CASE("a column's answer does not depend on its neighbours, to the bit") {
    Scene s = scene();
    std::vector<double> b = random_block(s.n, 16, 17), x = b;
    // neighbours that need nothing, much and little
    std::fill_n(column(x, s.n, 3).begin(), s.n, 0.0);
    for (double& v : column(x, s.n, 4))
        v *= 1e-12;
    std::vector<double> smooth(s.n);
    stiffness_product(s.model, column(b, s.n, 5), s.system, smooth);
    std::copy(smooth.begin(), smooth.end(), column(x, s.n, 5).begin());
    const std::vector<double> before = x;
    solve_columns(s.model, {}, s.system, x, 16);
    for (const int j : {0, 3, 4, 5, 15}) {
        std::vector<double> alone(before.begin() + j * static_cast<std::ptrdiff_t>(s.n),
                                  before.begin() + (j + 1) * static_cast<std::ptrdiff_t>(s.n));
        solve_columns(s.model, {}, s.system, alone, 1);
        CHECK(std::equal(alone.begin(), alone.end(), column(x, s.n, j).begin()));
    }
    CHECK(std::all_of(column(x, s.n, 3).begin(), column(x, s.n, 3).end(),
                      [](double v) { return v == 0.0; }));
}

TEST_CASE("solves and products of many columns allocate nothing") {
    Scene s = scene();
    std::vector<double> x = random_block(s.n, 33, 19), y(x.size());
    const std::size_t before = bodies::allocations();
    solve_columns(s.model, {}, s.system, x, 33);
    precondition_columns(s.model, s.system, x, 33);
    stiffness_products(s.model, x, 33, s.system, y);
    mass_products(s.model, x, 33, s.system, y);
    CHECK(bodies::allocations() == before);
}
