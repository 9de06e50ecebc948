// tests/tissue/quadratic_refactor_test.cpp
// A factor at the tangent where a quadratic body is: the assembled matrix beside the product that
// is never assembled, and what it saves.
#include "tissue/solver/quadratic_refactor.h"

#include "tests/tissue/quadratic_bodies.h"
#include "tissue/solver/quadratic_columns.h"

#include <cmath>
#include <doctest/doctest.h>

namespace {

struct Bent {
    tissue::QuadraticModel model;
    tissue::QuadraticState state;
    tissue::QuadraticSystem system;
    tissue::Material material;
};

// Damped, in a bed, held at one face, bent so that A stays positive definite.
Bent bent(bool remembers) {
    const auto mesh = quadratic_bodies::curved_box(3);
    tissue::Material material = bodies::elastic(20e3, 0.3);
    material.damping_mass_1ps = 3.0;
    material.damping_stiffness_s = 2e-3;
    if (remembers)
        material.prony = {{0.4, 0.05}};
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
    return {std::move(model), std::move(state), std::move(system), material};
}

std::vector<double> wave(int n) {
    std::vector<double> x(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = std::sin(1.0 + 0.7 * static_cast<double>(i));
    return x;
}

bool refactor(const tissue::QuadraticModel& model, tissue::QuadraticSystem& system,
              tissue::Refactoring& job) {
    begin_refactoring(model, system, job);
    return take_refactoring(job, system);
}

bool refactor(const tissue::QuadraticModel& model, tissue::QuadraticSystem& system) {
    tissue::Refactoring job = make_refactoring(model);
    return refactor(model, system, job);
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

TEST_CASE("refactor: the assembled matrix is the one that is multiplied by, with a memory too") {
    for (const bool remembers : {false, true}) {
        CAPTURE(remembers);
        Bent b = bent(remembers);
        const std::vector<double> x = wave(b.model.unknowns);
        std::vector<double> k(x.size()), m(x.size()), assembled(x.size());
        stiffness_product(b.model, x, b.system, k);
        mass_product(b.model, x, b.system, m);
        tissue::Refactoring job = make_refactoring(b.model);
        REQUIRE(refactor(b.model, b.system, job));
        tissue::multiply(b.model.pattern, job.matrix, x, assembled);
        const double rate = 1.0 / b.system.dt_s;
        for (std::size_t i = 0; i < x.size(); ++i) {
            k[i] = (rate * rate + b.material.damping_mass_1ps * rate) * m[i] +
                   (1.0 + b.material.damping_stiffness_s * rate) * k[i];
        }
        CHECK(off(assembled, k) < 1e-6); // tangents are kept in single precision
    }
}

TEST_CASE("refactor: where it was made one iteration is enough, and the answer is the same") {
    Bent b = bent(false);
    const std::vector<double> load = wave(b.model.unknowns);
    std::vector<double> before(load.size()), after(load.size());
    const tissue::QuadraticOptions tight{.linear_tolerance = 1e-5};
    const int many = solve(b.model, {}, load, b.system, before).iterations;
    solve(b.model, tight, load, b.system, before);
    REQUIRE(refactor(b.model, b.system));
    CHECK(many > 8);
    CHECK(solve(b.model, {}, load, b.system, after).iterations <= 2);
    solve(b.model, tight, load, b.system, after);
    CHECK(off(after, before) < 1e-4);
    std::vector<double> columns(load);
    CHECK(solve_columns(b.model, tight, b.system, columns, 1).relative_residual <= 1e-5);
    CHECK(off(columns, before) < 1e-4);
}

TEST_CASE("refactor: turned as a whole, the body needs no more iterations than before") {
    Bent b = bent(false);
    REQUIRE(refactor(b.model, b.system));
    // a free body would only turn; a held one is turned with what holds it
    const double c = std::cos(1.1), s = std::sin(1.1);
    const glm::dmat3 turn{{c, s, 0.0}, {-s, c, 0.0}, {0.0, 0.0, 1.0}};
    auto free = make_quadratic(b.model.mesh, b.material, {});
    auto system = make_system(free, 0.01);
    auto state = rest_state(free);
    state.position_m = quadratic_bodies::bent(state.position_m, 5);
    linearize(free, state, system);
    REQUIRE(refactor(free, system));
    const std::vector<double> load = wave(free.unknowns);
    std::vector<double> x(load.size());
    const int here = solve(free, {}, load, system, x).iterations;
    for (glm::dvec3& at : state.position_m)
        at = turn * at;
    linearize(free, state, system);
    const int turned = solve(free, {}, load, system, x).iterations;
    CHECK(here <= 2);
    CHECK(turned <= here + 1);
}

TEST_CASE("refactor: what is taken later, elsewhere, leads on from where it was begun") {
    Bent b = bent(false);
    tissue::Refactoring job = make_refactoring(b.model);
    REQUIRE(begin_refactoring(b.model, b.system, job));
    CHECK_FALSE(begin_refactoring(b.model, b.system, job)); // one is at work
    const std::vector<double> load = wave(b.model.unknowns);
    std::vector<double> x(load.size());
    for (std::size_t i = 0; i < b.state.position_m.size(); ++i) { // on half way home
        if (b.model.dof[i] >= 0)
            b.state.position_m[i] = 0.5 * (b.state.position_m[i] + b.model.mesh.rest_m[i]);
    }
    linearize(b.model, b.state, b.system);
    REQUIRE(take_refactoring(job, b.system));
    const int elsewhere = solve(b.model, {}, load, b.system, x).iterations;
    REQUIRE(refactor(b.model, b.system, job));
    CHECK(solve(b.model, {}, load, b.system, x).iterations <= elsewhere);
    linearize(b.model, b.state, b.system); // warps by F of now, and finds itself at no warp
    CHECK(solve(b.model, {}, load, b.system, x).iterations <= 2);
    CHECK_FALSE(take_refactoring(job, b.system)); // nothing was begun
}

TEST_CASE("refactor: a body that is inside out keeps the factor of its rest") {
    Bent b = bent(false);
    b.state.position_m = b.model.mesh.rest_m;
    b.state.position_m[b.model.mesh.tets[0][0]] += glm::dvec3{1.0, 1.0, 1.0};
    b.state.position_m[b.model.mesh.tets[5][1]] -= glm::dvec3{1.0, 0.5, 1.0};
    linearize(b.model, b.state, b.system);
    REQUIRE(b.system.recovering);
    CHECK_FALSE(refactor(b.model, b.system));
}

TEST_CASE(
    "refactor: how long it takes is counted: longer for more, in more steps if they are short") {
    const auto steps = [](int cells, double dt_s) {
        const auto mesh = reference_bodies::irregular_box({0.1, 0.08, 0.06}, cells, 1);
        const auto model =
            make_quadratic(mesh, bodies::elastic(20e3, 0.3), quadratic_bodies::held_at_x0(mesh));
        return steps_to_refactor(model, make_system(model, dt_s).single, dt_s);
    };
    CHECK(steps(2, 0.02) == 2);
    CHECK(steps(3, 1e-4) > steps(2, 1e-4));
    CHECK(steps(4, 1e-4) > steps(3, 1e-4));
    CHECK(steps(4, 1e-5) > 5 * steps(4, 1e-4));
}
