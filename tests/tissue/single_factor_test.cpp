// tests/tissue/single_factor_test.cpp
// The single-precision solve beside CHOLMOD's.
#include "tests/tissue/quadratic_bodies.h"

#include <doctest/doctest.h>

using bodies::elastic;

TEST_CASE("a solve in single precision is CHOLMOD's to single precision") {
    for (const int cells : {1, 2, 3, 5}) {
        const auto mesh =
            tissue::quadratic_mesh(tissue::box_mesh({0.1, 0.1, 0.1}, {cells, cells, cells}));
        const auto model =
            make_quadratic(mesh, elastic(20e3, 0.3), quadratic_bodies::held_at_x0(mesh));
        auto system = make_system(model, 0.01);
        const auto n = static_cast<std::size_t>(model.unknowns);
        std::mt19937_64 random(1);
        std::vector<double> b;
        for (std::size_t k = 0; k < n; ++k)
            b.push_back(bodies::signed_unit(random));
        std::vector<float> x(n);
        for (std::size_t k = 0; k < n; ++k)
            x[k] = static_cast<float>(b[system.single.order[k]]);
        solve(system.single, x, system.lines);
        CHECK(system.exact.solve(b, 1));
        double off2 = 0.0;
        for (std::size_t k = 0; k < n; ++k) {
            const double d = x[k] - b[system.single.order[k]];
            off2 += d * d;
        }
        // 6e-8 times a condition of some hundreds
        CHECK(std::sqrt(off2) < 1e-4 * bodies::norm(b));
    }
}

TEST_CASE("a factor that is none has no supernodes") {
    tissue::SparsePattern pattern{1, {0, 1}, {0}};
    tissue::SparseFactor factor(pattern);
    CHECK_THROWS_WITH_AS(factor.supernodes(), doctest::Contains("1 unknowns"), std::runtime_error);
}
