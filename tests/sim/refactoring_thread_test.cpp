// tests/sim/refactoring_thread_test.cpp
// A quadratic body steps on while another thread makes its next factor: for the thread sanitizer,
// and that it makes no difference to the steps when the other thread is done.
#include "tests/tissue/quadratic_bodies.h"
#include "tissue/solver/quadratic_refactor.h"

#include <algorithm>
#include <doctest/doctest.h>

namespace {

// Twelve steps of a body let go bent; the factor is begun in the second, taken in the eighth.
std::vector<glm::dvec3> stepped(bool wait_at_once) {
    const auto mesh = quadratic_bodies::curved_box(3);
    const auto model =
        make_quadratic(mesh, bodies::elastic(20e3, 0.3), quadratic_bodies::held_at_x0(mesh));
    auto system = make_system(model, 0.01);
    auto state = rest_state(model);
    const auto to = quadratic_bodies::bent(state.position_m, 5);
    for (std::size_t i = 0; i < to.size(); ++i) {
        if (model.dof[i] >= 0)
            state.position_m[i] = to[i];
    }
    tissue::Refactoring job = make_refactoring(model);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns));
    for (int step = 0; step < 12; ++step) {
        linearize(model, state, system);
        REQUIRE_FALSE(system.recovering);
        free_motion(model, {}, system, du);
        advance(model, system, du, state);
        if (step == 1) {
            REQUIRE(begin_refactoring(model, system, job));
            if (wait_at_once)
                job.made.wait();
        }
        if (step == 7)
            CHECK(take_refactoring(job, system));
    }
    return state.position_m;
}

} // namespace

TEST_CASE("refactoring: steps are the same to the bit, whenever the other thread is done") {
    CHECK(std::ranges::equal(stepped(false), stepped(true)));
}

TEST_CASE("refactoring: what is destroyed while its thread works waits for it") {
    const auto mesh = quadratic_bodies::curved_box(3);
    const auto model =
        make_quadratic(mesh, bodies::elastic(20e3, 0.3), quadratic_bodies::held_at_x0(mesh));
    auto system = make_system(model, 0.01);
    linearize(model, rest_state(model), system);
    for (int i = 0; i < 5; ++i) {
        tissue::Refactoring job = make_refactoring(model);
        REQUIRE(begin_refactoring(model, system, job));
    }
    CHECK(system.single.size == model.unknowns); // that of rest, untouched
}
