// The derivatives of a rod's bend and twist against differences, and the band factor.
#include "tests/tissue/rods.h"

#include <doctest/doctest.h>
#include <random>

using glm::dvec3;
using tissue::BendStrain;
using tissue::RodFrame;

namespace {

using Step = std::array<double, 8>;

struct Corner {
    dvec3 e_m, f_m;
    RodFrame e, f;
};

Corner corner(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto vector = [&] { return dvec3{any(random), any(random), any(random)}; };
    Corner c{dvec3{1.2, 0, 0} + 0.6 * vector(), dvec3{0.8, 0, 0} + 0.6 * vector(), {}, {}};
    const auto frame = [&](const dvec3& along) {
        const dvec3 t = glm::normalize(along);
        return RodFrame{t, glm::normalize(glm::cross(t, dvec3{0, 0, 1} + 0.5 * vector()))};
    };
    c.e = frame(c.e_m);
    c.f = frame(c.f_m);
    return c;
}

BendStrain strain_after(const Corner& c, const Step& d, double h) {
    const dvec3 e = c.e_m + h * dvec3{d[0], d[1], d[2]}, f = c.f_m + h * dvec3{d[4], d[5], d[6]};
    return tissue::bend_strain(tissue::moved(c.e, glm::normalize(e), h * d[3]),
                               tissue::moved(c.f, glm::normalize(f), h * d[7]));
}

Step direction(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    Step d{};
    for (double& x : d)
        x = any(random);
    return d;
}

} // namespace

TEST_CASE("the strains of a bend have the gradient and the Hessian that differences have") {
    std::mt19937 random(7);
    for (int trial = 0; trial < 100; ++trial) {
        const Corner c = corner(random);
        const Step d = direction(random);
        const double e_m = glm::length(c.e_m), f_m = glm::length(c.f_m);
        const auto gradient = tissue::bend_gradient(c.e, e_m, c.f, f_m);
        const auto hessian = tissue::bend_hessian(c.e, e_m, c.f, f_m);
        constexpr double kFirst = 1e-5, kSecond = 1e-3;
        for (std::size_t s = 0; s < 3; ++s) {
            double slope = 0.0, curve = 0.0;
            for (std::size_t i = 0; i < 8; ++i) {
                slope += gradient[s][i] * d[i];
                for (std::size_t k = 0; k < 8; ++k)
                    curve += hessian[s][i][k] * d[i] * d[k];
            }
            const auto at = [&](double h) { return strain_after(c, d, h)[s]; };
            const double first = (at(kFirst) - at(-kFirst)) / (2 * kFirst);
            const double second = (at(kSecond) - 2 * at(0.0) + at(-kSecond)) / (kSecond * kSecond);
            CHECK(std::abs(slope - first) < 1e-7 * (1.0 + std::abs(first)));
            CHECK(std::abs(curve - second) < 2e-4 * (1.0 + std::abs(second)));
        }
    }
}

TEST_CASE("a bend of 2 atan(1/2) has a curvature of 1, about the axis it is about") {
    const double turn = 2 * std::atan(0.5);
    const RodFrame e{{1, 0, 0}, {0, 1, 0}};
    const auto f = tissue::moved(e, {std::cos(turn), std::sin(turn), 0}, 0.0);
    const BendStrain s = tissue::bend_strain(e, f);
    CHECK(s[0] == doctest::Approx(1.0).scale(0.0).epsilon(1e-12)); // m2 = z
    CHECK(std::abs(s[1]) < 1e-15);
    CHECK(std::abs(s[2]) < 1e-15);
    CHECK(tissue::bend_strain(e, tissue::moved(f, f.tangent, 0.3))[2] ==
          doctest::Approx(0.3).scale(0.0).epsilon(1e-12));
}

TEST_CASE("a folded bend has finite strains and derivatives") {
    const RodFrame e{{1, 0, 0}, {0, 1, 0}}, f{{-1, 0, 0}, {0, 1, 0}};
    for (const double strain : tissue::bend_strain(e, f))
        CHECK(std::abs(strain) < 100.0);
    for (const auto& gradient : tissue::bend_gradient(e, 1.0, f, 1.0)) {
        for (const double g : gradient)
            CHECK(std::isfinite(g));
    }
}

TEST_CASE("a band is solved to rounding, and one that is not positive definite is refused") {
    constexpr int kSize = 40, kBand = 5;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    tissue::BandMatrix a = tissue::make_band(kSize, kBand);
    std::vector<double> x(kSize), b(kSize);
    for (int i = 0; i < kSize; ++i) {
        x[static_cast<std::size_t>(i)] = any(random);
        for (int j = std::max(0, i - kBand); j < i; ++j)
            a.value[a.at(i, j)] = any(random);
        a.value[a.at(i, i)] = 12.0; // above the sum of a row: positive definite (Gershgorin)
    }
    tissue::multiply(a, x, b);
    tissue::BandMatrix l = a;
    CHECK(tissue::factor(l));
    tissue::solve(l, b);
    for (std::size_t i = 0; i < kSize; ++i)
        CHECK(std::abs(b[i] - x[i]) < 1e-13);
    a.value[a.at(20, 20)] = -1.0;
    CHECK_FALSE(tissue::factor(a));
}
