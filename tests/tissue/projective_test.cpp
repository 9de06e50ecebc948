// tests/tissue/projective_test.cpp
// Projective dynamics: forces and statics against the corotated solver, and what few iterations do,
// against the closed form of a mode.
#include "tests/tissue/baselines.h"

#include <doctest/doctest.h>

using bodies::elastic;
using glm::dvec3;
using tissue::ProjectiveStart;

namespace {

double greatest_difference_n(const tissue::ProjectiveModel& model,
                             const tissue::BaselineState& state) {
    std::vector<dvec3> ours(state.position_m.size()), theirs(state.position_m.size());
    tissue::elastic_forces(model, state, ours);
    tissue::elastic_forces(model.body, state, theirs);
    double greatest = 0.0;
    for (std::size_t i = 0; i < ours.size(); ++i)
        greatest = std::max(greatest, glm::length(ours[i] - theirs[i]));
    return greatest;
}

// The apex of a lone tet under a small force, |G| = 1/height. Sideways k = V mu |G|^2, along its
// axis k = V (lambda + 2 mu) |G|^2; of |F|^2 the projections make k_L = V (2 mu + 3 lambda) |G|^2
// of both.
struct Mode {
    tissue::ProjectiveModel model;
    double stiffness_npm, mass_kg, share, rate; // share: k h^2/m, rate: of an iteration
    Mode(double height_m, double poisson, bool along)
        : model(tissue::make_projective(baselines::lone_tet(height_m), elastic(500, poisson),
                                        baselines::kBase)) {
        const double mu = model.body.mu_pa, lambda = model.body.lambda_pa;
        const double per_pa = model.body.volume_m3[0] / (height_m * height_m);
        mass_kg = model.body.mass_kg[3];
        stiffness_npm = per_pa * (along ? lambda + 2 * mu : mu);
        const double h2m = 0.01 * 0.01 / mass_kg, taken = per_pa * (2 * mu + 3 * lambda) * h2m;
        share = stiffness_npm * h2m;
        rate = (taken - share) / (1 + taken);
    }
};
constexpr double kDt_s = 0.01;

} // namespace

TEST_CASE("without Poisson's ratio the forces are those of corotated tets, inverted or not") {
    const auto model = tissue::make_projective(baselines::small_box(), elastic(8e3, 0.0), {});
    for (const double noise_m : {1e-3, 1e-2})
        CHECK(greatest_difference_n(model, baselines::shaken(model.body, noise_m, 0, 3)) <
              1e-12 * 8e3 * 1e-4 * noise_m / 1e-3);
}

TEST_CASE("with it they are those of corotated tets to first order in the strain") {
    const auto model = tissue::make_projective(baselines::small_box(), elastic(8e3, 0.45), {});
    const double coarse = greatest_difference_n(model, baselines::shaken(model.body, 4e-5, 0, 3));
    const double fine = greatest_difference_n(model, baselines::shaken(model.body, 2e-5, 0, 3));
    CHECK(baselines::off(coarse / fine, 4.0) < 0.05);
}

TEST_CASE("the nearest shape of rest volume is the nearest, of long, flat and inverted tets") {
    // F = diag(s), R = 1 as long as no two of s add up to less than 0. D is diagonal too: the
    // nearest of all on a grid, which is as near as its spacing squared
    const auto model = tissue::make_projective(baselines::lone_tet(0.008), elastic(7e3, 0.45), {});
    const dvec3 stretches[] = {{1, 1, 3},        {1.2, 1.1, 1.3},  {0.3, 0.5, 0.4}, {1.1, 0.7, 0.1},
                               {1.1, 0.7, -0.5}, {0.5, 0.4, -0.3}, {2, 1.5, -1},    {1, 0.9, -0.8}};
    for (const dvec3& s : stretches) {
        double nearest2 = std::numeric_limits<double>::infinity();
        for (double a = 0.1; a < 3.5; a += 2e-3) {
            for (double b = 0.1; b < 3.5; b += 2e-3) {
                const dvec3 away = dvec3{a, b, 1 / (a * b)} - s;
                nearest2 = std::min(nearest2, glm::dot(away, away));
            }
        }
        tissue::BaselineState state = tissue::rest_state(model.body);
        for (dvec3& x : state.position_m)
            x *= s;
        const double energy_j =
            model.body.volume_m3[0] *
            (model.body.mu_pa * glm::dot(s - 1.0, s - 1.0) + 1.5 * model.body.lambda_pa * nearest2);
        CHECK(baselines::off(tissue::elastic_energy_j(model, state), energy_j) < 1e-3);
    }
}

TEST_CASE("forces of projections are the gradient of their energy") {
    const auto model = tissue::make_projective(baselines::small_box(), elastic(7e3, 0.45), {});
    CHECK(baselines::gradient_error(model, baselines::shaken(model.body, 1e-3, 0, 4)) < 1e-6);
}

TEST_CASE("no iteration raises the potential of the step, from any start") {
    // psi's projections are nearest points: each iteration minimises a bound from above that
    // touches
    for (const double noise_m : {1e-3, 1e-2}) {
        auto model = tissue::make_projective(baselines::small_box(), elastic(7e3, 0.0), {});
        const tissue::BaselineState start = baselines::shaken(model.body, noise_m, 0.1, 4);
        double last = std::numeric_limits<double>::infinity();
        for (model.iterations = 0; model.iterations < 20; ++model.iterations) {
            tissue::BaselineState end = start;
            baselines::run(model, {}, kDt_s, 1, end);
            double potential_j = tissue::elastic_energy_j(model, end);
            for (std::size_t i = 0; i < end.position_m.size(); ++i) {
                const dvec3 off =
                    end.position_m[i] - start.position_m[i] - kDt_s * start.velocity_mps[i];
                potential_j += model.body.mass_kg[i] / (2 * kDt_s * kDt_s) * glm::dot(off, off);
            }
            CHECK(potential_j <= last * (1 + 1e-12));
            last = potential_j;
        }
    }
}

TEST_CASE("with many iterations a step is implicit Euler's of the corotated energy") {
    // ... whose equation, every step converged, is what the report calls residual
    auto model = tissue::make_projective(baselines::small_box(), elastic(8e3, 0.0), {});
    model.iterations = 400;
    tissue::BaselineState state = baselines::shaken(model.body, 1e-3, 0.1, 4);
    const tissue::BaselineState before = state;
    const tissue::BaselineReport report = baselines::run(model, {}, kDt_s, 1, state);
    CHECK(report.relative_residual < 1e-10);
    std::vector<dvec3> force(state.position_m.size());
    tissue::elastic_forces(model.body, state, force);
    for (std::size_t i = 0; i < force.size(); ++i) {
        const dvec3 gained =
            model.body.mass_kg[i] / kDt_s * (state.velocity_mps[i] - before.velocity_mps[i]);
        CHECK(glm::length(gained + force[i]) <
              1e-9 * glm::length(model.body.mass_kg[i] / kDt_s * before.velocity_mps[i]) + 1e-12);
    }
}

TEST_CASE("few iterations from the inertial guess sag too much, by the closed form") {
    for (const double poisson : {0.0, 0.45}) {
        for (const bool along : {false, true}) {
            Mode mode(0.008, poisson, along);
            std::vector<dvec3> load(4, dvec3{0.0});
            load[3] =
                1e-7 * mode.stiffness_npm * (along ? dvec3{0, 0, 1} : dvec3{1, 0, 0}); // 0.1 um
            for (const int n : {1, 2, 5, 50}) {
                mode.model.iterations = n;
                const auto state = baselines::settled(mode.model, load, kDt_s, 1e-13, 20000);
                const double sag_m = glm::length(state.position_m[3] - dvec3{0, 0, 0.008});
                const double power = std::pow(mode.rate, n);
                CHECK(baselines::off(sag_m, 1e-7 * (1 + mode.share * power) / (1 - power)) < 1e-3);
            }
        }
    }
}

TEST_CASE("one iteration from where it was is right at rest and has a damper of h (k_L - k)") {
    Mode mode(0.008, 0.0, false); // k_L = 2 k
    mode.model.iterations = 1;
    mode.model.start = ProjectiveStart::resting;
    const double k = mode.stiffness_npm, m = mode.mass_kg;
    tissue::BaselineState state = tissue::rest_state(mode.model.body);
    state.position_m[3].x = 1e-7;
    double x = 1e-7, v = 0.0;
    auto scratch = make_scratch(mode.model);
    for (int i = 0; i < 20; ++i) {
        step(mode.model, {}, kDt_s, scratch, state);
        // implicit Euler of m a + c v + k x = 0
        const double c = kDt_s * k;
        v = (m * v - kDt_s * k * x) / (m + kDt_s * c + kDt_s * kDt_s * k);
        x += kDt_s * v;
        CHECK(std::abs(state.position_m[3].x - x) < 1e-4 * 1e-7);
    }
    std::vector<dvec3> load(4, dvec3{0.0});
    load[3].x = 1e-7 * k;
    CHECK(baselines::off(baselines::settled(mode.model, load, kDt_s, 1e-13, 20000).position_m[3].x,
                         1e-7) < 1e-5);
}

TEST_CASE("with many iterations a beam rests where linear tetrahedra do, with few it does not") {
    const baselines::Beam beam({10, 2, 2}, 1e5, 0.0);
    auto model = beam.made<tissue::ProjectiveModel>();
    const double p1 = beam.tip_m(beam.p1()).y;
    for (const int iterations : {300, 1}) {
        model.iterations = iterations;
        const double tip = beam.tip_m(baselines::settled(model, {}, kDt_s, 1e-5, 3000)).y;
        MESSAGE(iterations, " iterations: tip ", 1e3 * tip, " mm, P1 ", 1e3 * p1);
        CHECK((std::abs(tip / p1 - 1) < 1e-3) == (iterations > 1));
    }
}

TEST_CASE("a step of another length gets its own factor") {
    const auto model = tissue::make_projective(baselines::small_box(), elastic(8e3, 0.45), {});
    const tissue::BaselineState start = baselines::shaken(model.body, 1e-3, 0.1, 4);
    tissue::BaselineState used = start, fresh = start;
    auto scratch = make_scratch(model);
    step(model, {}, 0.02, scratch, used);
    fresh = used;
    step(model, {}, 0.001, scratch, used);
    baselines::run(model, {}, 0.001, 1, fresh);
    for (std::size_t i = 0; i < used.position_m.size(); ++i)
        CHECK(used.position_m[i] == fresh.position_m[i]);
}

TEST_CASE("ten iterations are not enough where volume counts, and the residual tells") {
    const baselines::Beam beam({10, 2, 2}, 1e5, 0.45);
    auto model = beam.made<tissue::ProjectiveModel>();
    double tip_m[2], residual[2];
    for (const int many : {0, 1}) {
        model.iterations = many ? 200 : 10;
        tissue::BaselineState state = tissue::rest_state(model.body);
        residual[many] =
            baselines::run(model, {}, kDt_s, many ? 100 : 300, state).relative_residual;
        tip_m[many] = beam.tip_m(state).y;
    }
    const double p1_m = beam.tip_m(beam.p1()).y;
    MESSAGE("10 iterations ", 1e3 * tip_m[0], ", 200 ", 1e3 * tip_m[1], ", P1 ", 1e3 * p1_m, " mm");
    MESSAGE("residuals ", residual[0], ", ", residual[1]);
    CHECK(residual[0] > 0.5);
    CHECK(residual[1] < 0.01);
    CHECK(std::abs(tip_m[0] / tip_m[1] - 1) > 0.05);
    // volume is kept, not the linear trace: other large strains than corotated, same small ones
    CHECK(baselines::off(tip_m[1], p1_m) < 0.05);
}

TEST_CASE("a tet pushed through its base by projections returns to rest") {
    tissue::Material material = elastic(7e3, 0.45);
    const double height_m = 0.008;
    const auto model =
        tissue::make_projective(baselines::lone_tet(height_m), material, baselines::kBase);
    tissue::BaselineState state = tissue::rest_state(model.body);
    state.position_m[3].z = -0.5 * height_m;
    CHECK(baselines::run(model, {}, kDt_s, 100, state).inverted == 0);
    CHECK(baselines::off(state.position_m[3].z, height_m) < 1e-6);
}
