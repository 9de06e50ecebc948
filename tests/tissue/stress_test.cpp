// tests/tissue/stress_test.cpp
// Von Mises stress of tetrahedra against closed forms, and of a bent beam against beam theory.
#include "tissue/solver/stress.h"

#include "tests/tissue/bodies.h"
#include "tests/tissue/reference_statics.h"

#include <doctest/doctest.h>
#include <glm/matrix.hpp>
#include <numbers>

using glm::dmat3;
using glm::dvec3;

namespace {

constexpr double kYoung_pa = 8e3, kPoisson = 0.4;
constexpr double kShear_pa = kYoung_pa / (2.0 * (1.0 + kPoisson));

tissue::CorotatedModel block(double young_pa = kYoung_pa) {
    return tissue::make_corotated(tissue::box_mesh({0.04, 0.03, 0.03}, {4, 3, 3}, 0.2),
                                  bodies::elastic(young_pa, kPoisson), {});
}

struct Extremes {
    double least = 0.0, most = 0.0;
};

// Over all tets of the block when x = F X + (0.3, -0.1, 0.2).
Extremes stress_pa(const tissue::CorotatedModel& model, const dmat3& F) {
    std::vector<dvec3> x = model.mesh.rest_m;
    for (dvec3& p : x)
        p = F * p + dvec3{0.3, -0.1, 0.2};
    std::vector<double> stress(model.mesh.tets.size());
    tissue::von_mises_pa(model, x, stress);
    const auto [low, high] = std::minmax_element(stress.begin(), stress.end());
    return {*low, *high};
}

dmat3 diagonal(const dvec3& d) {
    return {{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}};
}

void check_uniform(const Extremes& found, double expected_pa) {
    CHECK(found.least == doctest::Approx(expected_pa).scale(0.0).epsilon(1e-11));
    CHECK(found.most == doctest::Approx(expected_pa).scale(0.0).epsilon(1e-11));
}

// From principal stretches, the roots of the eigenvalues of F^T F (Smith 1961):
// vm = 2 mu sqrt(((s1-s2)^2 + (s2-s3)^2 + (s3-s1)^2) / 2).
double by_stretches_pa(const dmat3& F, double mu_pa) {
    const dmat3 C = glm::transpose(F) * F;
    const double mean = (C[0][0] + C[1][1] + C[2][2]) / 3.0;
    const dmat3 B = C - dmat3(mean);
    double size2 = 0.0;
    for (int c = 0; c < 3; ++c)
        size2 += glm::dot(B[c], B[c]) / 6.0;
    const double size = std::sqrt(size2);
    const double cosine = std::clamp(glm::determinant(B) / (2.0 * size2 * size), -1.0, 1.0);
    dvec3 s;
    for (int k = 0; k < 3; ++k) {
        const double angle = (std::acos(cosine) + 2.0 * std::numbers::pi * k) / 3.0;
        s[k] = std::sqrt(mean + 2.0 * size * std::cos(angle));
    }
    const dvec3 d = s - dvec3{s.y, s.z, s.x};
    return 2.0 * mu_pa * std::sqrt(0.5 * glm::dot(d, d));
}

dmat3 gradient(const tissue::TetMesh& mesh, const tissue::Tet& t, const std::vector<dvec3>& x) {
    const auto edges = [&](const std::vector<dvec3>& at) {
        return dmat3{at[t[1]] - at[t[0]], at[t[2]] - at[t[0]], at[t[3]] - at[t[0]]};
    };
    return edges(x) * glm::inverse(edges(mesh.rest_m));
}

} // namespace

TEST_CASE("stress: a bar stretched with free sides has E times its strain in every tet") {
    for (const double strain : {-0.2, 1e-3, 0.1, 0.5}) { // linear in the stretch at any size
        const double side = 1.0 - kPoisson * strain;
        check_uniform(stress_pa(block(), diagonal({1.0 + strain, side, side})),
                      kYoung_pa * std::abs(strain));
    }
}

TEST_CASE("stress: pure shear has root 3 times its shear stress") {
    const double angle = 0.04; // 2 e_xy
    dmat3 F{1.0};
    F[0][1] = F[1][0] = 0.5 * angle;
    check_uniform(stress_pa(block(), F), std::sqrt(3.0) * kShear_pa * angle);
}

TEST_CASE("stress: swelling or shrinking alike in all directions has none") {
    const double bulk_pa = kYoung_pa / (3.0 * (1.0 - 2.0 * kPoisson));
    for (const double size : {0.7, 1.3}) // rounding, of a pressure 3 K (s - 1)
        CHECK(stress_pa(block(), dmat3(size)).most < 1e-12 * 3.0 * bulk_pa);
}

TEST_CASE("stress: turning by any angle about any axis makes none and changes none") {
    const dmat3 stretch = diagonal({1.1, 0.96, 0.96});
    std::mt19937_64 random(2);
    for (int degrees = 1; degrees <= 720; degrees += 31) {
        const dmat3 R = bodies::rotation(bodies::signed_vector(random), degrees * 0.0174532925);
        CHECK(stress_pa(block(), R).most < 1e-12 * kYoung_pa);
        check_uniform(stress_pa(block(), R * stretch), kYoung_pa * 0.1);
    }
}

TEST_CASE("stress: it is proportional to Young's modulus") {
    const dmat3 F{{1.1, 0.1, 0.0}, {-0.2, 0.9, 0.1}, {0.05, 0.0, 1.2}};
    check_uniform(stress_pa(block(7.0 * kYoung_pa), F), 7.0 * stress_pa(block(), F).most);
}

TEST_CASE("stress: an inverted tet has that of its signed stretches, a flat one is finite") {
    // sigma = 2 mu (0.2, 0.1, -1.5) but for pressure
    const double expected_pa =
        2.0 * kShear_pa * std::sqrt(0.5 * (0.1 * 0.1 + 1.6 * 1.6 + 1.7 * 1.7));
    check_uniform(stress_pa(block(), diagonal({1.2, 1.1, -0.5})), expected_pa);
    for (const dmat3& F : {diagonal({1, 1, 0}), diagonal({1, 0, 0}), dmat3(0.0), dmat3(-1.0)})
        CHECK(std::isfinite(stress_pa(block(), F).most));
}

TEST_CASE("stress: linearize keeps the peak of the tets, also of inverted ones") {
    const auto model = block();
    auto system = tissue::make_system(model);
    std::vector<double> stress(model.mesh.tets.size());
    for (const double noise_m : {0.0, 1e-3, 2e-2}) {
        const auto state = bodies::moved(model, tissue::rest_state(model),
                                         bodies::random_unknowns(model, 7), noise_m);
        tissue::linearize(model, state, 0.01, system);
        CHECK((system.inverted > 0) == (noise_m > 0.01));
        tissue::von_mises_pa(model, state.position_m, stress);
        const double peak_pa = *std::max_element(stress.begin(), stress.end());
        CHECK(system.peak_von_mises_pa == doctest::Approx(peak_pa).scale(0.0).epsilon(1e-12));
        CHECK(std::isfinite(peak_pa));
    }
    auto lost = tissue::rest_state(model);
    lost.position_m[0].x = std::numeric_limits<double>::quiet_NaN();
    tissue::linearize(model, lost, 0.01, system);
    CHECK(system.peak_von_mises_pa < 1e-9 * kYoung_pa); // that of the tets that are somewhere
}

TEST_CASE("stress: the top of a bent beam has M c / I, less what linear tetrahedra cannot show") {
    // 0.2 x 0.04 x 0.04 m, clamped at x = 0, under a hundredth of its weight, in -y, nu = 0
    const double young_pa = 100e3, load_npm = 1000.0 * 0.0981 * 0.04 * 0.04;
    const auto fibre_pa = [&](double x_m) {
        const double moment_nm = 0.5 * load_npm * (0.2 - x_m) * (0.2 - x_m);
        return moment_nm * 0.02 / (std::pow(0.04, 4) / 12.0);
    };
    // share of M c / I in the top tets at mid-span, whose centres are at 2/3 and 5/6 of c, the rest
    // is locking; and in the peak, which is at the clamp
    const std::array<double, 2> shown{0.503, 0.752}, peak_shown{0.754, 0.957};
    const std::array<std::array<int, 3>, 2> cells{{{10, 3, 3}, {20, 6, 6}}};
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const tissue::TetMesh mesh = tissue::box_mesh({0.2, 0.04, 0.04}, cells[k]);
        const reference::Beam beam{
            mesh, 0.0, young_pa / 2.0, 1000.0, {0, -0.0981, 0}, bodies::anchors(mesh, [](auto x) {
                return x.x < 1e-9;
            })};
        const auto model = tissue::make_corotated(mesh, bodies::elastic(young_pa, 0.0),
                                                  beam.anchored, beam.gravity_mps2);
        tissue::CorotatedState state = tissue::rest_state(model);
        REQUIRE(tissue::solve_static(model, {}, 1e-10, 20, state).converged);
        const reference::Equilibrium other = reference::solve(beam, 1, 1e-9);
        std::vector<double> stress(mesh.tets.size());
        tissue::von_mises_pa(model, state.position_m, stress);

        double top_pa = 0.0, theory_pa = 0.0, worst_pa = 0.0;
        for (std::size_t e = 0; e < stress.size(); ++e) {
            const dmat3 F = gradient(mesh, mesh.tets[e], other.position_m);
            worst_pa = std::max(worst_pa, std::abs(stress[e] - by_stretches_pa(F, beam.mu_pa)));
            dvec3 centre{0.0};
            for (const std::uint32_t v : mesh.tets[e])
                centre += mesh.rest_m[v] / 4.0;
            if (std::abs(centre.x - 0.1) > 0.02 || centre.y < 0.04 - 0.04 / cells[k][1])
                continue;
            top_pa += stress[e];
            theory_pa += fibre_pa(centre.x);
        }
        const double peak_pa = *std::max_element(stress.begin(), stress.end());
        CHECK(worst_pa < 1e-8 * peak_pa);
        CHECK(top_pa / theory_pa == doctest::Approx(shown[k]).scale(0.0).epsilon(0.005));
        CHECK(peak_pa / fibre_pa(0.0) == doctest::Approx(peak_shown[k]).scale(0.0).epsilon(0.005));
    }
}
