// tests/tissue/contact_rows_test.cpp
#include "tests/tissue/touched_body.h"

#include <doctest/doctest.h>

using glm::dvec3;

namespace {

const bodies::TouchedBlock& block() {
    static const bodies::TouchedBlock b =
        bodies::touched_block({6, 6, 3}, bodies::elastic(8e3, 0.45));
    return b;
}

} // namespace

TEST_CASE("a row and its value are transposes: d . value(x) = row(d) . x") {
    const bodies::TouchedBlock& b = block();
    const std::vector<double> x = bodies::random_unknowns(b.model, 1);
    for (const double place_m : {0.003, 0.031, 0.077}) {
        const tissue::ContactPoint at = bodies::on_top(b, place_m, 0.08 - place_m);
        const dvec3 d{0.3, -0.4, 0.8};
        std::vector<double> row(x.size(), 0.0);
        tissue::add_row(b.model.dof, b.skin, at, d, 2.0, row);
        CHECK(bodies::inner(row, x) ==
              doctest::Approx(2.0 * glm::dot(d, tissue::row_value(b.model.dof, b.skin, at, x)))
                  .scale(0.0)
                  .epsilon(1e-13));
    }
}

TEST_CASE("a translation moves every contact point by itself where no anchor has a share") {
    const bodies::TouchedBlock& b = block();
    std::vector<double> x(static_cast<std::size_t>(b.model.unknowns));
    const dvec3 shift{1e-3, -2e-3, 5e-4};
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = shift[static_cast<int>(i % 3)];
    const tissue::ContactPoint at = bodies::on_top(b, 0.041, 0.039);
    CHECK(glm::length(tissue::row_value(b.model.dof, b.skin, at, x) - shift) < 1e-17);
    // on the floor, part of the nodes are anchored
    const tissue::ContactSurface all = bodies::skin_of(b.mesh, 0.02);
    const double share =
        glm::length(tissue::vertex_value(b.model.dof, all, 0, x)) / glm::length(shift);
    CHECK(share > 0.05);
    CHECK(share < 0.95);
}

TEST_CASE("a contact point moves as its place on the placed surface does") {
    const bodies::TouchedBlock& b = block();
    // small and without rotation at the frame triangle, which is anchored: offsets do not turn
    const std::vector<double> d = bodies::random_unknowns(b.model, 3);
    const auto state = bodies::moved(b.model, tissue::rest_state(b.model), d, 1e-3);
    std::vector<dvec3> position(b.skin.rest_m.size()), normal(position.size());
    tissue::place_surface(b.skin, tissue::make_skin_frames(b.skin, b.mesh.rest_m), state.position_m,
                          position, normal);
    const tissue::Triangle& frame = b.skin.frame_node.front();
    for (const std::uint32_t node : frame)
        REQUIRE(b.model.dof[node] < 0);
    const tissue::ContactPoint at = bodies::on_top(b, 0.05, 0.03);
    dvec3 moved{0.0};
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = b.skin.triangles[at.triangle][k];
        moved += at.weight[k] * (position[v] - b.skin.rest_m[v]);
    }
    CHECK(glm::length(moved - 1e-3 * tissue::row_value(b.model.dof, b.skin, at, d)) < 1e-15);
}

TEST_CASE("over one step the momentum changes by the impulse of contact and weight") {
    // a free body: no anchors
    const tissue::TetMesh mesh = tissue::box_mesh({0.06, 0.05, 0.04}, {4, 4, 3}, 0.1);
    tissue::Material material = bodies::elastic(8e3, 0.45);
    material.damping_stiffness_s = 3e-3;
    const dvec3 gravity{0, 0, -9.81};
    const auto model = tissue::make_corotated(mesh, material, {}, gravity);
    const tissue::ContactSurface skin = bodies::skin_of(mesh, 0.02);
    auto state =
        bodies::moved(model, tissue::rest_state(model), bodies::random_unknowns(model, 4), 5e-4);
    tissue::CorotatedSystem system = tissue::make_system(model);
    const double dt_s = 0.01;
    const dvec3 force_n{0.4, -0.3, -1.2};
    const std::size_t n = static_cast<std::size_t>(model.unknowns);

    tissue::linearize(model, state, dt_s, system);
    std::vector<double> du(n), push(n, 0.0);
    tissue::free_motion(model, state, system, du);
    tissue::add_row(model.dof, skin, {20, {0.2, 0.5, 0.3}}, force_n, 1.0, push);
    system.factor.solve(push, 1);
    for (std::size_t i = 0; i < n; ++i)
        du[i] += push[i];
    const std::vector<dvec3> before = state.velocity_mps;
    tissue::advance(model, du, dt_s, state);

    dvec3 gained{0.0}, weight_n{0.0};
    for (std::size_t i = 0; i < model.mass_kg.size(); ++i) {
        gained += model.mass_kg[i] * (state.velocity_mps[i] - before[i]);
        weight_n += model.mass_kg[i] * gravity;
    }
    const dvec3 impulse = dt_s * (force_n + weight_n);
    CHECK(glm::length(gained - impulse) < 1e-9 * glm::length(impulse));
}
