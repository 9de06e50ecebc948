// tests/tissue/prony_test.cpp
// One viscoelastic point: its law, its memory, and what it takes out of a motion.
#include "tissue/material/prony.h"

#include "tests/tissue/bodies.h"

#include <complex>
#include <doctest/doctest.h>
#include <numbers>

using glm::dmat3;
using glm::dvec3;
using tissue::Law;
using tissue::Symmetric;

namespace {

constexpr Law kLaws[]{Law::neo_hooke, Law::small_strain};

tissue::Material viscous(double poisson = 0.45) {
    tissue::Material m = bodies::elastic(9e3, poisson);
    m.prony = {{0.3, 0.5}, {0.2, 8.0}};
    return m;
}

// G(t)/G0
double relaxed_share(const tissue::Material& m, double t_s) {
    double share = 1.0;
    for (const auto& [g, tau] : m.prony)
        share -= g * (1 - std::exp(-t_s / tau));
    return share;
}

dmat3 random_gradient(std::mt19937_64& random, double size) {
    dmat3 F(1.0);
    for (int c = 0; c < 3; ++c)
        F[c] += size * bodies::signed_vector(random);
    return F;
}

double inner(const dmat3& a, const dmat3& b) {
    return glm::dot(a[0], b[0]) + glm::dot(a[1], b[1]) + glm::dot(a[2], b[2]);
}

// A point on its way.
struct Point {
    tissue::Material material;
    tissue::Elasticity e;
    dmat3 F{1.0};
    std::vector<Symmetric> memory;

    Point(const tissue::Material& m, Law law)
        : material(m), e(elasticity(m, law)), memory(m.prony.size(), tissue::kUnit) {}

    void go(double dt_s, const dmat3& to) {
        const auto step = prony_step(material, dt_s);
        remember(step, relaxed(e.law, F), relaxed(e.law, to), memory);
        F = to;
    }
    tissue::PronyStep at_once() const { return prony_step(material, 0.0); }
    dmat3 stress_pa() const {
        return piola_stress_pa(e, shear_pa(at_once(), memory, relaxed(e.law, F)), F);
    }
    double stored_jpm3() const { return stored_density_jpm3(e, at_once(), memory, F); }
};

} // namespace

TEST_CASE("stress and tangent of a point with a memory are derivatives of its energy") {
    std::mt19937_64 random(3);
    for (const Law law : kLaws) {
        const auto e = elasticity(viscous(), law);
        const dmat3 F = random_gradient(random, 0.3);
        const Symmetric M{3.1e3, 1.2e3, 2.2e3, 0.4e3, -0.7e3, 0.3e3};
        const dmat3 P = piola_stress_pa(e, M, F);
        const auto A = piola_tangent_pa(e, M, F);
        for (int i = 0; i < 9; ++i) {
            dmat3 up = F, down = F;
            up[i / 3][i % 3] += 1e-5;
            down[i / 3][i % 3] -= 1e-5;
            const double slope =
                (energy_density_jpm3(e, M, up) - energy_density_jpm3(e, M, down)) / 2e-5;
            CHECK(std::abs(slope - P[i / 3][i % 3]) < 1e-7 * e.bulk_pa);
            const dmat3 dP = (piola_stress_pa(e, M, up) - piola_stress_pa(e, M, down)) / 2e-5;
            for (int j = 0; j < 9; ++j) {
                CHECK(std::abs(dP[j / 3][j % 3] - A[j][i]) < 1e-7 * e.bulk_pa);
                CHECK(std::abs(A[i][j] - A[j][i]) < 1e-12 * e.bulk_pa);
            }
        }
    }
}

TEST_CASE("a modulus that is the same in all directions is the elastic law") {
    std::mt19937_64 random(5);
    for (const Law law : kLaws) {
        const auto e = elasticity(viscous(), law);
        const Symmetric M{e.mu_pa, e.mu_pa, e.mu_pa, 0, 0, 0};
        const dmat3 F = random_gradient(random, 0.3);
        const double energy = energy_density_jpm3(e, F);
        CHECK(std::abs(energy_density_jpm3(e, M, F) - energy) < 1e-12 * energy);
        const dmat3 off = piola_stress_pa(e, M, F) - piola_stress_pa(e, F);
        CHECK(std::sqrt(inner(off, off)) < 1e-12 * e.bulk_pa);
        const auto A = piola_tangent_pa(e, M, F), expected = piola_tangent_pa(e, F);
        for (int i = 0; i < 81; ++i)
            CHECK(std::abs(A[i / 9][i % 9] - expected[i / 9][i % 9]) < 1e-12 * e.bulk_pa);
    }
}

TEST_CASE("held after a step of strain of any size, shear stress follows the series") {
    std::mt19937_64 random(7);
    for (const Law law : kLaws) {
        for (const double size : {1e-3, 0.1, 0.4}) {
            Point point(viscous(), law);
            point.go(0.0, random_gradient(random, size)); // volume changes too
            auto volume_alone = point.e;
            volume_alone.mu_pa = 0.0;
            const dmat3 of_volume = piola_stress_pa(volume_alone, point.F);
            const dmat3 start = piola_stress_pa(point.e, point.F) - of_volume;
            double t = 0.0;
            for (double dt = 1e-3; t < 100; dt *= 3) {
                point.go(dt, point.F);
                t += dt;
                const dmat3 off =
                    point.stress_pa() - of_volume - relaxed_share(point.material, t) * start;
                CHECK(inner(off, off) < 1e-20 * inner(start, start) + 1e-30 * point.e.bulk_pa);
            }
        }
    }
}

TEST_CASE("what is known before a step gives the stress after it, wherever it leads") {
    std::mt19937_64 random(13);
    for (const Law law : kLaws) {
        Point point(viscous(), law);
        for (const double dt : {1e-3, 0.1, 1.0, 30.0}) {
            const dmat3 to = random_gradient(random, 0.3);
            const auto before =
                shear_pa(prony_step(point.material, dt), point.memory, relaxed(law, point.F));
            point.go(dt, to);
            const dmat3 expected = piola_stress_pa(point.e, before, to);
            const dmat3 off = point.stress_pa() - expected;
            CHECK(inner(off, off) < 1e-24 * inner(expected, expected));
        }
    }
}

TEST_CASE("strain that grows steadily is remembered exactly in steps of any size") {
    // e = rate t N, N traceless: A = I - 2 rate N [t - tau (1 - exp(-t/tau))]
    const dmat3 N{1, 0.5, 0, 0.5, -0.4, 0.2, 0, 0.2, -0.6};
    const double end = 3.0, rate = 1e-2;
    for (const int steps : {1, 2, 30}) {
        Point point(viscous(), Law::small_strain);
        for (int i = 1; i <= steps; ++i)
            point.go(end / steps, dmat3(1.0) + rate * end * i / steps * N);
        for (std::size_t k = 0; k < 2; ++k) {
            const double tau = point.material.prony[k].time_s;
            const double along = -2 * rate * (end - tau * (1 - std::exp(-end / tau)));
            CHECK(point.memory[k][0] == doctest::Approx(1 + along).epsilon(1e-13));
            CHECK(point.memory[k][3] == doctest::Approx(0.5 * along).epsilon(1e-13));
            CHECK(point.memory[k][5] == 0.0);
        }
    }
}

TEST_CASE("work that is not stored is lost, never gained, and as the law says") {
    // dissipation g mu/(2 tau) tr(A B + (A B)^-1 - 2 I), summed over the way by Simpson's rule
    std::mt19937_64 random(11);
    Point point(viscous(), Law::neo_hooke);
    constexpr int kParts = 200;
    double lost_most = 0.0;
    for (int way = 0; way < 20; ++way) {
        const dmat3 from = point.F, to = random_gradient(random, 0.25);
        const double time = std::pow(10.0, 1.5 * bodies::signed_unit(random));
        const double stored = point.stored_jpm3();
        const auto loss = [&] {
            const dmat3 C = glm::transpose(point.F) * point.F;
            const dmat3 B = C / std::cbrt(glm::determinant(C));
            double sum = 0.0;
            for (std::size_t k = 0; k < point.memory.size(); ++k) {
                const Symmetric& a = point.memory[k];
                const dmat3 AB = dmat3{a[0], a[3], a[5], a[3], a[1], a[4], a[5], a[4], a[2]} * B;
                const dmat3 back = glm::inverse(AB);
                for (int i = 0; i < 3; ++i) {
                    sum += point.material.prony[k].share * point.e.mu_pa /
                           (2 * point.material.prony[k].time_s) * (AB[i][i] + back[i][i] - 2);
                }
            }
            return sum;
        };
        double work = 0.0, lost = 0.0;
        for (int i = 0; i < kParts; ++i) {
            const double rate0 = loss();
            const dmat3 before = point.stress_pa(), F0 = point.F;
            point.go(0.5 * time / kParts, from + (to - from) * ((i + 0.5) / kParts));
            const double rate1 = loss();
            const dmat3 middle = point.stress_pa();
            point.go(0.5 * time / kParts, from + (to - from) * ((i + 1.0) / kParts));
            work += inner(before + 4.0 * middle + point.stress_pa(), point.F - F0) / 6;
            lost += time / kParts * (rate0 + 4 * rate1 + loss()) / 6;
        }
        const double missing = work - (point.stored_jpm3() - stored);
        CHECK(missing > 0.0);
        CHECK(missing == doctest::Approx(lost).epsilon(1e-3).scale(0.0));
        lost_most = std::max(lost_most, lost / stored);
    }
    CHECK(lost_most > 0.05); // it is not a small thing
}

TEST_CASE("under a small oscillation a point has the modulus of its series") {
    for (const double hz : {0.1, 1.0, 10.0}) {
        Point point(viscous(), Law::neo_hooke);
        const double w = 2 * std::numbers::pi * hz, size = 1e-4;
        constexpr int kSteps = 64;
        const int settle = std::max(1, static_cast<int>(50 * hz)) * kSteps; // 50 s
        std::complex<double> modulus = 0.0;
        for (int i = 1; i <= settle + kSteps; ++i) {
            const double angle = 2 * std::numbers::pi * i / kSteps;
            dmat3 F(1.0);
            F[1][0] = size * std::sin(angle);
            point.go(1 / (hz * kSteps), F);
            if (i > settle)
                modulus += 2.0 / kSteps * point.stress_pa()[1][0] / size *
                           std::complex<double>(std::sin(angle), std::cos(angle));
        }
        std::complex<double> expected = relaxed_share(point.material, 1e9);
        for (const auto& [g, tau] : point.material.prony)
            expected += g * std::complex(0.0, w * tau) / std::complex(1.0, w * tau);
        expected *= point.e.mu_pa;
        // (w dt)^2/12 of the modulus is what a straight line between samples misses
        CHECK(modulus.real() == doctest::Approx(expected.real()).epsilon(1e-3).scale(0.0));
        CHECK(modulus.imag() == doctest::Approx(expected.imag()).epsilon(2e-3).scale(0.0));
    }
}

TEST_CASE("the memory of what is pressed flat or inside out stays finite and positive") {
    const auto check = [](const dmat3& F) {
        const Symmetric s = relaxed(Law::neo_hooke, F);
        for (const double x : s)
            CHECK(std::isfinite(x));
        CHECK(s[0] + s[1] + s[2] <= 75.0 * (1 + 1e-12));
        CHECK(s[0] * s[1] - s[3] * s[3] > 0.0);
    };
    for (const double flat : {1e-2, 1e-5, 0.0, -1e-5, -1.0}) {
        dmat3 F(1.0);
        F[2][2] = flat;
        F[1][2] = 0.3;
        check(F);
    }
    check(dmat3(0.0));
}

TEST_CASE("a series that cannot be is named") {
    const auto check = [](std::vector<tissue::PronyTerm> terms, const char* what) {
        auto m = viscous();
        m.prony = std::move(terms);
        CHECK_THROWS_WITH_AS(prony_step(m, 0.01), doctest::Contains(what), std::invalid_argument);
    };
    check({{0.0, 1.0}}, "prony term 0 takes 0.0");
    check({{0.5, 1.0}, {0.5, 2.0}}, "prony term 1 takes 0.5");
    check({{std::nan(""), 1.0}}, "prony term 0 takes");
    check({{0.5, 0.0}}, "time_s = 0.0");
    check({{0.5, 1.0 / 0.0}}, "time_s = inf");
    check(std::vector<tissue::PronyTerm>(5, {0.1, 1.0}), "5 terms: at most 4");
}
