// tests/tissue/xpbd_test.cpp
// XPBD: how far from neo-Hooke's equilibrium it rests, against the closed form of one tet; that
// small steps bring it there and sweeps do not; that it is damped as implicit Euler is.
#include "tests/tissue/baselines.h"

#include <doctest/doctest.h>

using bodies::elastic;
using glm::dvec3;
using tissue::XpbdModel;

namespace {

constexpr double kHeight_m = 0.008;

// The greatest force that is not balanced, from differences of the energy.
double unbalanced_n(const XpbdModel& model, std::span<const dvec3> load_n,
                    const tissue::BaselineState& state) {
    constexpr double kStep_m = 1e-7;
    double greatest = 0.0;
    tissue::BaselineState moved = state;
    for (std::size_t i = 0; i < load_n.size(); ++i) {
        for (int k = 0; k < 3 && model.body.dof[i] >= 0; ++k) {
            moved.position_m[i][k] = state.position_m[i][k] + kStep_m;
            const double above = tissue::elastic_energy_j(model, moved);
            moved.position_m[i][k] = state.position_m[i][k] - kStep_m;
            const double below = tissue::elastic_energy_j(model, moved);
            moved.position_m[i][k] = state.position_m[i][k];
            greatest =
                std::fmax(greatest, std::abs((above - below) / (2 * kStep_m) - load_n[i][k]));
        }
    }
    return greatest;
}

// Twelve tets on a held face, a corner pulled.
struct Block {
    tissue::TetMesh mesh = tissue::box_mesh({0.02, 0.01, 0.01}, {2, 1, 1});
    std::vector<dvec3> load_n = std::vector<dvec3>(mesh.rest_m.size(), dvec3{0.0});
    XpbdModel model;
    Block() {
        load_n.back() = {0.0, 0.0, 0.004};
        tissue::Material material = elastic(8e3, 0.3);
        material.damping_mass_1ps = 200.0;
        const auto anchored = bodies::anchors(mesh, [](auto x) { return x.x < 1e-9; });
        model = tissue::make_xpbd(mesh, material, anchored);
        model.substeps = 1;
    }
    tissue::BaselineState at_rest(double dt_s) const {
        return baselines::settled(model, load_n, dt_s, 1e-9, 100000);
    }
};

} // namespace

TEST_CASE("an unloaded tet swells by h^2/m mu^2 V/(3 H (lambda + 2 mu))") {
    // Only the apex can move. To first order in t = h^2/m the two projections of a sweep give, at
    // rest,
    //   0 = f_D (1 - t mu V |g_D|^2) + (f_H - t K_H f_D)(1 - t lambda' V |g_H|^2),
    // f_D = mu V/H = -f_H, |g_D|^2 = 1/(3 H^2), |g_H|^2 = 1/H^2, K_H = lambda' V/H^2: what is left
    // is the force t (mu V)^2/(3 H^3), against the stiffness V (lambda + 2 mu)/H^2
    for (const double height_m : {kHeight_m, kHeight_m / 2}) {
        tissue::Material material = elastic(8e3, 0.3);
        material.damping_mass_1ps = 200.0;
        auto model = tissue::make_xpbd(baselines::lone_tet(height_m), material, baselines::kBase);
        model.substeps = 1;
        const double mu = model.body.mu_pa, lambda = model.body.lambda_pa;
        const double volume_m3 = model.body.volume_m3[0], mass_kg = model.body.mass_kg[3];
        for (const double h_s : {2e-5, 4e-5}) {
            const auto state = baselines::settled(model, {}, h_s, 1e-12, 100000);
            const double swollen_m =
                h_s * h_s / mass_kg * mu * mu * volume_m3 / (3 * height_m * (lambda + 2 * mu));
            CHECK(baselines::off(state.position_m[3].z - height_m, swollen_m) < 0.01);
        }
    }
}

TEST_CASE(
    "small steps rest where neo-Hooke's energy balances the load, with the square of the step") {
    const Block block;
    double last = unbalanced_n(block.model, block.load_n, block.at_rest(0.5e-3));
    for (const double dt_s : {0.25e-3, 0.125e-3, 0.0625e-3}) {
        const double now = unbalanced_n(block.model, block.load_n, block.at_rest(dt_s));
        CHECK(baselines::off(last / now, 4.0) < 0.05);
        last = now;
    }
    CHECK(last < 0.02 * 0.004); // of the load
}

TEST_CASE("more sweeps of a coarse step end elsewhere, not nearer") {
    Block block;
    block.model.sweeps = 20;
    const auto some = block.at_rest(1e-3);
    block.model.sweeps = 100;
    const auto many = block.at_rest(1e-3);
    for (std::size_t i = 0; i < some.position_m.size(); ++i)
        CHECK(glm::length(some.position_m[i] - many.position_m[i]) < 1e-8); // the sweeps are done
    const double left_n = unbalanced_n(block.model, block.load_n, many);
    CHECK(left_n > 0.004); // more than the load itself
    CHECK(left_n / unbalanced_n(block.model, block.load_n, block.at_rest(0.25e-3)) > 10);
}

TEST_CASE("a mode of a tet is damped as by implicit Euler of small steps") {
    auto model =
        tissue::make_xpbd(baselines::lone_tet(kHeight_m), elastic(500, 0.3), baselines::kBase);
    model.substeps = 1;
    constexpr double dt_s = 1e-4;
    tissue::Material damped = model.body.material;
    damped.damping_mass_1ps = 200.0;
    auto resting = tissue::make_xpbd(baselines::lone_tet(kHeight_m), damped, baselines::kBase);
    resting.substeps = 1;
    const double rest_m = baselines::settled(resting, {}, dt_s, 1e-12, 100000).position_m[3].z;

    const double stiffness_npm = model.body.volume_m3[0] *
                                 (model.body.lambda_pa + 2 * model.body.mu_pa) /
                                 (kHeight_m * kHeight_m);
    const double omega2 = stiffness_npm / model.body.mass_kg[3];
    tissue::BaselineState state = tissue::rest_state(model.body);
    const double amplitude_m = 1e-6;
    state.position_m[3].z = rest_m + amplitude_m;
    double x = amplitude_m, v = 0.0;
    auto scratch = make_scratch(model);
    for (int i = 0; i < 600; ++i) { // two periods
        step(model, {}, dt_s, scratch, state);
        v = (v - dt_s * omega2 * x) / (1 + dt_s * dt_s * omega2);
        x += dt_s * v;
        CHECK(std::abs(state.position_m[3].z - rest_m - x) < 0.02 * amplitude_m);
    }
    CHECK(std::hypot(x, v / std::sqrt(omega2)) < 0.9 * amplitude_m); // it is damped
}

TEST_CASE("a beam is softer with coarse steps, and reaches the P1 answer as they shrink") {
    // A tenth of the weight, so that neo-Hooke and corotated tets are one law
    baselines::Beam beam({5, 2, 2}, 1e5, 0.45);
    beam.gravity_mps2 *= 0.1;
    auto model = beam.made<XpbdModel>();
    double tip_m[4];
    for (int i = 0; i < 4; ++i) {
        model.substeps = 10 << i;
        tip_m[i] = beam.tip_m(baselines::settled(model, {}, 0.01, 1e-6, 500)).y;
    }
    const double p1_m = beam.tip_m(beam.p1()).y;
    MESSAGE("10, 20, 40, 80 substeps: ", 1e3 * tip_m[0], ", ", 1e3 * tip_m[1], ", ", 1e3 * tip_m[2],
            ", ", 1e3 * tip_m[3], " mm; P1 ", 1e3 * p1_m);
    CHECK(baselines::off((tip_m[1] - tip_m[2]) / (tip_m[2] - tip_m[3]), 4.0) < 0.1);
    CHECK(baselines::off(tip_m[3] + (tip_m[3] - tip_m[2]) / 3, p1_m) < 0.01);
    CHECK(tip_m[0] / p1_m > 1.5);

    // half the step with the same substeps is another material
    model.substeps = 10;
    const double half_m = beam.tip_m(baselines::settled(model, {}, 0.005, 1e-6, 1000)).y;
    CHECK(baselines::off(half_m, tip_m[1]) < 1e-3);

    // forty projections a step: ten substeps of four sweeps are no better than of one
    model.sweeps = 4;
    const double sweeps_m = beam.tip_m(baselines::settled(model, {}, 0.01, 1e-6, 500)).y;
    CHECK(std::abs(sweeps_m - p1_m) > 5 * std::abs(tip_m[2] - p1_m));
}

TEST_CASE("a beam is softer the finer its mesh, beside the P1 answer on each") {
    double soft[2];
    for (const int i : {0, 1}) {
        const baselines::Beam beam({5 << i, 2 << i, 2 << i}, 1e5, 0.45);
        const auto state = baselines::settled(beam.made<XpbdModel>(), {}, 0.01, 1e-5, 500);
        soft[i] = beam.tip_m(state).y / beam.tip_m(beam.p1()).y;
        MESSAGE("tip of P1's: ", soft[i]);
    }
    CHECK(soft[0] > 1.1);
    CHECK(soft[1] > soft[0] + 0.02);
}

TEST_CASE("a tet pushed through its base by XPBD returns to rest") {
    const auto model =
        tissue::make_xpbd(baselines::lone_tet(kHeight_m), elastic(500, 0.3), baselines::kBase);
    tissue::BaselineState state = tissue::rest_state(model.body);
    state.position_m[3].z = -0.5 * kHeight_m;
    const auto report = baselines::run(model, {}, 0.001, 2000, state);
    CHECK(report.inverted == 0);
    CHECK(baselines::off(state.position_m[3].z, kHeight_m) < 0.01);
}
