// tests/tissue/follow_tangent_test.cpp
// What a step saves by keeping its linearisation, and what that costs.
#include "tests/tissue/touched_body.h"
#include "tissue/response/contact_basis.h"

#include <cmath>
#include <doctest/doctest.h>

namespace {

struct Scene {
    bodies::TouchedBlock block = bodies::touched_block({4, 4, 2}, bodies::elastic(8e3, 0.45));
    tissue::CorotatedState state = tissue::rest_state(block.model);
    tissue::CorotatedSystem system = tissue::make_system(block.model);
};

// |f_int by the tangent - f_int itself| after moving by `size_m` along one fixed random direction.
double lost_n(double size_m) {
    Scene s;
    const double dt_s = 0.01;
    tissue::linearize(s.block.model, s.state, dt_s, s.system);
    std::vector<double> du = bodies::random_unknowns(s.block.model, 3);
    for (double& d : du)
        d *= size_m;
    tissue::advance(s.block.model, du, dt_s, s.state);
    tissue::follow_tangent(s.block.model, du, s.system);
    const std::vector<double> followed = s.system.internal_n;
    tissue::linearize(s.block.model, s.state, dt_s, s.system);
    double most = 0.0;
    for (std::size_t i = 0; i < du.size(); ++i)
        most = std::max(most, std::abs(followed[i] - s.system.internal_n[i]));
    return most;
}

} // namespace

TEST_CASE("follow tangent: what is lost is of second order in the motion") {
    const double large = lost_n(2e-4), small = lost_n(1e-4);
    REQUIRE(large > 0.0);
    CHECK(large / small > 3.5); // 4, and terms of third order
    CHECK(large / small < 4.5);
}

TEST_CASE("contact basis: refreshed at a later state it has that state's residual and rate") {
    Scene s;
    const double dt_s = 0.01;
    tissue::linearize(s.block.model, s.state, dt_s, s.system);
    const auto at = [&](double x, double y) { return bodies::on_top(s.block, x, y); };
    const tissue::BasisContact contact{
        at(0.04, 0.04),
        {at(0.045, 0.04), at(0.035, 0.04), at(0.04, 0.045), at(0.04, 0.035)},
        {0, 0, 1},
        {1, 0, 0},
        {0, 1, 0}};
    tissue::ContactBasis basis = tissue::make_contact_basis(s.block.model.unknowns);
    tissue::compute_contact_basis(s.block.model, s.block.skin, s.state, s.system,
                                  std::span(&contact, 1), basis);
    REQUIRE(basis.modes > 5);
    std::vector<double> du = bodies::random_unknowns(s.block.model, 4);
    for (double& d : du)
        d *= 1e-5;
    tissue::advance(s.block.model, du, dt_s, s.state);
    tissue::follow_tangent(s.block.model, du, s.system);
    tissue::refresh_contact_basis(s.block.model, s.state, s.system, basis);
    const std::size_t n = static_cast<std::size_t>(s.block.model.unknowns);
    for (int m = 0; m < basis.modes; ++m) {
        double residual = 0.0, rate = 0.0;
        for (std::size_t node = 0; node < s.block.model.dof.size(); ++node) {
            const int d = s.block.model.dof[node];
            for (int k = 0; d >= 0 && k < 3; ++k) {
                const double v = basis.shape[m * n + d + k];
                residual += v * s.system.internal_n[d + k];
                rate += v * s.block.model.mass_kg[node] * s.state.velocity_mps[node][k];
            }
        }
        CHECK(std::abs(basis.residual[m] - residual) < 1e-12 * (1.0 + std::abs(residual)));
        CHECK(std::abs(basis.rate[m] - rate) < 1e-12 * (1.0 + std::abs(rate)));
    }
}
