// tests/tissue/baseline_test.cpp
// What holds for every baseline: fall, momentum, rotation, anchors, reports, no allocation.
#include "tests/tissue/allocations.h"
#include "tests/tissue/baselines.h"

#include <doctest/doctest.h>
#include <glm/vector_relational.hpp>

using baselines::make;
using glm::dmat3;
using glm::dvec3;
using tissue::MassSpringModel;
using tissue::ProjectiveModel;
using tissue::TledModel;
using tissue::XpbdModel;

#define EVERY_BASELINE MassSpringModel, TledModel, XpbdModel, ProjectiveModel

namespace {

enum class Tangle { flat, inside_out, pulled_through };

// A loose cube after a second, from a shape that has inverted tets.
template <typename Model> struct Untangled {
    Model model;
    tissue::BaselineState state;
    tissue::BaselineReport report;
    explicit Untangled(Tangle tangle) {
        tissue::Material material = bodies::elastic(5e3, 0.3);
        material.damping_mass_1ps = 20.0;
        model = make<Model>(tissue::box_mesh({0.03, 0.03, 0.03}, {3, 3, 3}, 0.1), material);
        state = tissue::rest_state(model.body);
        for (dvec3& x : state.position_m) {
            if (tangle == Tangle::flat)
                x.z = 0.0;
            if (tangle == Tangle::inside_out)
                x.z = -x.z;
            if (tangle == Tangle::pulled_through && glm::all(glm::greaterThan(x, dvec3(0.02))))
                x -= 0.05;
        }
        report = baselines::run(model, {}, 0.01, 100, state);
    }
};

dvec3 momentum_ns(const tissue::CorotatedModel& body, const tissue::BaselineState& state) {
    dvec3 sum{0.0};
    for (std::size_t i = 0; i < body.mass_kg.size(); ++i)
        sum += body.mass_kg[i] * state.velocity_mps[i];
    return sum;
}
dvec3 centre_m(const tissue::CorotatedModel& body, const tissue::BaselineState& state) {
    dvec3 sum{0.0};
    double mass = 0.0;
    for (std::size_t i = 0; i < body.mass_kg.size(); ++i) {
        sum += body.mass_kg[i] * state.position_m[i];
        mass += body.mass_kg[i];
    }
    return sum / mass;
}
dvec3 spin_nms(const tissue::CorotatedModel& body, const tissue::BaselineState& state) {
    dvec3 sum{0.0};
    for (std::size_t i = 0; i < body.mass_kg.size(); ++i)
        sum += body.mass_kg[i] * glm::cross(state.position_m[i], state.velocity_mps[i]);
    return sum;
}

} // namespace

TEST_CASE_TEMPLATE("a loose body falls as its rule of time says", Model, EVERY_BASELINE) {
    const dvec3 g{1.0, 2.0, -9.81};
    const auto model = make<Model>(baselines::small_box(), bodies::elastic(8e3, 0.45), {}, g);
    tissue::BaselineState state = tissue::rest_state(model.body);
    constexpr double dt_s = 0.01;
    constexpr int steps = 10;
    const tissue::BaselineReport report = baselines::run(model, {}, dt_s, steps, state);
    const double h = dt_s / report.substeps;
    const double n = 1.0 * steps * report.substeps;
    // central differences are exact; symplectic and implicit Euler both have n (n + 1)/2
    const double way_s2 =
        std::is_same_v<Model, TledModel> ? h * h * n * n / 2 : h * h * n * (n + 1) / 2;
    const dvec3 fell =
        centre_m(model.body, state) - centre_m(model.body, tissue::rest_state(model.body));
    CHECK(glm::length(fell - way_s2 * g) < 1e-12);
    CHECK(glm::length(momentum_ns(model.body, state) - 0.012 * n * h * g) < 1e-12);
    // XPBD's projections stir a body that rests, see xpbd_test.cpp
    for (std::size_t i = 0; i < state.position_m.size() && !std::is_same_v<Model, XpbdModel>; ++i)
        CHECK(glm::length(state.position_m[i] - model.body.mesh.rest_m[i] - way_s2 * g) < 1e-11);
}

TEST_CASE_TEMPLATE("a wobbling loose body keeps its momentum", Model, EVERY_BASELINE) {
    const auto model = make<Model>(baselines::small_box(), bodies::elastic(8e3, 0.45));
    tissue::BaselineState state = baselines::shaken(model.body, 1e-4, 0.1, 8);
    const dvec3 before = momentum_ns(model.body, state), spin = spin_nms(model.body, state);
    const tissue::BaselineReport report = baselines::run(model, {}, 0.01, 20, state);
    CHECK(report.finite);
    CHECK(glm::length(momentum_ns(model.body, state) - before) < 1e-11 * glm::length(before));
    // x' = x + h v' with central forces also keeps the moment of momentum; the implicit ones do not
    if (std::is_same_v<Model, MassSpringModel> || std::is_same_v<Model, TledModel>)
        CHECK(glm::length(spin_nms(model.body, state) - spin) < 1e-11 * glm::length(spin));
}

TEST_CASE_TEMPLATE("what happens to a turned body is what happens to the body, turned", Model,
                   EVERY_BASELINE) {
    const auto model = make<Model>(baselines::small_box(), bodies::elastic(8e3, 0.45));
    std::mt19937_64 random(2);
    for (const double angle_rad : {0.2, 1.6, 3.1}) {
        const dmat3 R = bodies::rotation(bodies::signed_vector(random), angle_rad);
        tissue::BaselineState plain = baselines::shaken(model.body, 5e-4, 0.05, 3);
        tissue::BaselineState turned = plain;
        for (dvec3& x : turned.position_m)
            x = R * x;
        for (dvec3& v : turned.velocity_mps)
            v = R * v;
        baselines::run(model, {}, 0.005, 5, plain);
        baselines::run(model, {}, 0.005, 5, turned);
        for (std::size_t i = 0; i < plain.position_m.size(); ++i)
            CHECK(glm::length(turned.position_m[i] - R * plain.position_m[i]) < 1e-10);
    }
}

TEST_CASE_TEMPLATE("anchored nodes stay, a pushed one yields, a step allocates nothing", Model,
                   EVERY_BASELINE) {
    const tissue::TetMesh mesh = baselines::small_box();
    const auto anchored = bodies::anchors(mesh, [](auto x) { return x.x < 1e-9; });
    const auto model = make<Model>(mesh, bodies::elastic(8e3, 0.45), anchored);
    std::vector<dvec3> load(mesh.rest_m.size(), dvec3{0.0});
    load.back() = {0.0, 0.0, 0.01};
    tissue::BaselineState state = tissue::rest_state(model.body);
    auto scratch = make_scratch(model);
    step(model, load, 0.01, scratch, state);
    const std::size_t before = bodies::allocations();
    tissue::BaselineReport report;
    for (int i = 0; i < 10; ++i)
        report = step(model, load, 0.01, scratch, state);
    CHECK(bodies::allocations() == before);
    CHECK(report.finite);
    CHECK(report.inverted == 0);
    CHECK(std::isnan(report.relative_residual) != std::is_same_v<Model, ProjectiveModel>);
    CHECK(state.position_m.back().z - mesh.rest_m.back().z > 1e-4);
    for (std::size_t i = 0; i < anchored.size(); ++i) {
        if (anchored[i] != 0)
            CHECK(state.position_m[i] == mesh.rest_m[i]);
    }
}

TEST_CASE_TEMPLATE("mass damping takes a loose body's speed as its rule says", Model,
                   EVERY_BASELINE) {
    tissue::Material material = bodies::elastic(8e3, 0.45);
    material.damping_mass_1ps = 5.0;
    auto model = make<Model>(baselines::small_box(), material);
    if constexpr (std::is_same_v<Model, ProjectiveModel>) {
        model.start = tissue::ProjectiveStart::resting; // the other one is right at once
        model.iterations = 1;
    }
    tissue::BaselineState state = tissue::rest_state(model.body);
    for (dvec3& v : state.velocity_mps)
        v = {0.3, 0.0, 0.0};
    const dvec3 before = momentum_ns(model.body, state);
    const tissue::BaselineReport report = baselines::run(model, {}, 0.01, 10, state);
    const double ah = 5.0 * 0.01 / report.substeps;
    const double each =
        std::is_same_v<Model, TledModel> ? (1 - ah / 2) / (1 + ah / 2) : 1 / (1 + ah);
    CHECK(glm::length(momentum_ns(model.body, state) -
                      std::pow(each, 10 * report.substeps) * before) < 1e-11 * glm::length(before));
}

TEST_CASE_TEMPLATE("what is not a number is told, what cannot be is refused", Model,
                   EVERY_BASELINE) {
    const auto model = make<Model>(baselines::small_box(), bodies::elastic(8e3, 0.45));
    tissue::BaselineState state = tissue::rest_state(model.body);
    state.velocity_mps[3].y = NAN;
    CHECK_FALSE(baselines::run(model, {}, 0.01, 1, state).finite);
    CHECK_THROWS_WITH_AS(make<Model>(baselines::small_box(), bodies::elastic(8e3, 0.5)),
                         doctest::Contains("0.5"), std::invalid_argument);
}

TEST_CASE_TEMPLATE("inverted tets return", Model, XpbdModel, ProjectiveModel) {
    for (const Tangle tangle : {Tangle::flat, Tangle::inside_out, Tangle::pulled_through}) {
        const Untangled<Model> body(tangle);
        CHECK(body.report.inverted == 0);
        const tissue::TetMesh& mesh = body.model.body.mesh;
        CHECK(baselines::off(tissue::volume_m3(mesh, body.state.position_m),
                             tissue::volume_m3(mesh, mesh.rest_m)) < 0.02);
    }
}

TEST_CASE_TEMPLATE("inverted tets do not return, or are no longer numbers", Model, MassSpringModel,
                   TledModel) {
    for (const Tangle tangle : {Tangle::flat, Tangle::inside_out, Tangle::pulled_through}) {
        const Untangled<Model> body(tangle);
        CHECK((!body.report.finite || body.report.inverted > 0));
        // springs have no wall at det F = 0: they rest, but on the wrong side
        CHECK(body.report.finite == std::is_same_v<Model, MassSpringModel>);
    }
}

TEST_CASE("the power iteration finds the greatest of known frequencies") {
    const auto body = tissue::make_corotated(baselines::small_box(), bodies::elastic(8e3, 0.3), {});
    // K = M diag(1..n): the eigenvalues are 1..n, close together at the top
    const auto product = [&](std::span<const double> u, std::span<double> f) {
        for (std::size_t i = 0; i < body.dof.size(); ++i) {
            for (int k = 0; k < 3; ++k)
                f[body.dof[i] + k] = body.mass_kg[i] * (body.dof[i] + k + 1) * u[body.dof[i] + k];
        }
    };
    const double exact = std::sqrt(1.0 * body.unknowns);
    CHECK(baselines::off(tissue::greatest_frequency_radps(body, product), exact) < 1e-4);
}

TEST_CASE("a step has as many substeps as it needs") {
    CHECK(tissue::substep_count(0.01, 0.02) == 1);
    CHECK(tissue::substep_count(0.01, 0.01 / 7) == 7);
    CHECK(tissue::substep_count(0.01, 0.0099 / 7) == 8);
}
