// tests/tissue/descent_test.cpp
// Inverted bodies: what the end of a step promises of energy, momentum and rest, and that it does
// nothing where nothing is inverted.
#include "tissue/solver/descent.h"

#include "tests/tissue/allocations.h"
#include "tests/tissue/tangled.h"

#include <doctest/doctest.h>

using bodies::elastic;
using glm::dvec3;
using tangled::Body;
using tangled::Shape;

namespace {

// Rounding of an energy that is summed over some hundred tets.
constexpr double kRounding = 1e-12;

double after_a_second(Body& body, double dt_s) {
    double before_j = body.energy_j(), gained = 0.0;
    const double start_j = before_j;
    body.begin(dt_s);
    for (int i = 0; i < static_cast<int>(std::lround(1.0 / dt_s)); ++i) {
        const tissue::StepEnd end = body.step();
        REQUIRE(body.system.factored);
        CHECK(end.iterations <= tissue::kMaxDescent);
        const double now_j = body.energy_j();
        gained = std::max(gained, (now_j - before_j) / start_j);
        before_j = now_j;
    }
    return gained;
}

} // namespace

TEST_CASE("inverted bodies gain energy in no step and are at rest volume within a second") {
    // 1 s and 1e-3 of the volume as in the published failure scenes of simulators of soft tissue
    for (const double poisson : {0.0, 0.3, 0.45, 0.49}) {
        for (const double dt_s : {5e-3, 10e-3, 20e-3}) {
            std::mt19937_64 random(static_cast<std::uint64_t>(1e3 * (poisson + dt_s)));
            tissue::Material material = elastic(10e3, poisson);
            material.damping_mass_1ps = 4.0;
            material.damping_stiffness_s = 3e-3;
            for (int i = 0; i < tangled::kFew; ++i) {
                for (const Shape shape : tangled::kShapes) {
                    CAPTURE(poisson);
                    CAPTURE(dt_s);
                    CAPTURE(static_cast<int>(shape));
                    Body body(tangled::cube(random()), material);
                    tangled::throw_about(body, shape, random);
                    CHECK(after_a_second(body, dt_s) < kRounding);
                    CHECK(body.system.inverted == 0);
                    CHECK(body.volume_error() < 1e-3);
                }
            }
        }
    }
}

TEST_CASE("so do fast ones, soft ones, undamped ones, and those held on one side") {
    std::mt19937_64 random(5);
    for (int i = 0; i < tangled::kCases; ++i) {
        for (const bool held : {false, true}) {
            const tissue::TetMesh mesh = tangled::cube(random());
            const auto bottom = bodies::anchors(mesh, [&](auto x) { return held && x.z < 1e-9; });
            Body body(mesh, elastic(i % 2 == 0 ? 1e3 : 50e3, 0.45), bottom);
            tangled::throw_about(body, Shape::thrown, random);
            for (std::size_t k = 0; k < body.state.velocity_mps.size(); ++k)
                if (body.model.dof[k] >= 0)
                    body.state.velocity_mps[k] = bodies::signed_vector(random);
            CHECK(after_a_second(body, 0.01) < kRounding);
            CHECK(body.system.inverted == 0);
            CHECK(body.volume_error() < 0.05); // soft ones still swing: nothing damps but the step
        }
    }
}

TEST_CASE("a tet whose apex races through its base does not speed up where force turns over") {
    // Below minus its own height what pulled the apex back pushes it on. The minimiser of the step
    // gains energy there, however well it is found: v' is shortened, see (2) in the header.
    const double h_m = 0.01;
    const tissue::TetMesh mesh{{{0, 0, 0}, {h_m, 0, 0}, {0, h_m, 0}, {0, 0, h_m}}, {{0, 1, 2, 3}}};
    for (const double aside : {0.0, 0.1}) {
        Body body(mesh, elastic(2e3, 0.3), std::vector<std::uint8_t>{1, 1, 1, 0});
        body.state.position_m[3] = h_m * dvec3{aside, 0.5 * aside, -0.95};
        body.state.velocity_mps[3] = {0.0, 0.0, -3.0};
        const double before_j = body.energy_j();
        body.begin(1e-3);
        const tissue::StepEnd end = body.step();
        CHECK(body.state.position_m[3].z < -h_m);
        CHECK(end.relative_residual < 0.1);
        CHECK(end.speed_share < 1.0);
        CHECK(end.speed_share > 0.0);
        CHECK(body.energy_j() <= before_j * (1.0 + kRounding));
    }
}

TEST_CASE("a lone tet anywhere, at any speed, under any load: momentum and energy add up") {
    // one tet meets every corner of the energy, and most shares of the line search
    const double h_m = 0.01, dt_s = 5e-3;
    const tissue::TetMesh mesh{{{0, 0, 0}, {h_m, 0, 0}, {0, h_m, 0}, {0, 0, h_m}}, {{0, 1, 2, 3}}};
    std::mt19937_64 random(6);
    int descents = 0;
    for (int i = 0; i < 200 * tangled::kCases; ++i) {
        const double young_pa = std::pow(10.0, 3.0 + 1.5 * bodies::signed_unit(random));
        const dvec3 g = i % 3 == 0 ? 20.0 * bodies::signed_vector(random) : dvec3{0.0};
        const bool held = i % 2 == 0;
        const std::uint8_t anchor = held ? 1 : 0;
        Body body(mesh, elastic(young_pa, 0.24 + 0.24 * bodies::signed_unit(random)),
                  std::vector<std::uint8_t>{anchor, anchor, anchor, 0}, g);
        const double push_n = young_pa * h_m * h_m;
        body.load_n.assign(body.du.size(), 0.0);
        dvec3 push{0.0};
        for (std::size_t k = 0; k < 4; ++k) {
            const std::int32_t dof = body.model.dof[k];
            if (dof < 0)
                continue;
            body.state.position_m[k] = 2.0 * h_m * bodies::signed_vector(random);
            body.state.velocity_mps[k] = 2.0 * bodies::signed_vector(random);
            for (int axis = 0; axis < 3; ++axis) {
                body.load_n[dof + axis] = push_n * bodies::signed_unit(random);
                push[axis] += body.load_n[dof + axis];
            }
        }
        body.begin(dt_s);
        for (int k = 0; k < 5; ++k) {
            const dvec3 momentum_ns = body.momentum_ns() + dt_s * (push + body.descent.mass_kg * g);
            const double before_j = body.energy_j();
            const tissue::CorotatedState from = body.state;
            const tissue::StepEnd end = body.step();
            descents += end.iterations > 0;
            if (!held)
                CHECK(glm::length(body.momentum_ns() - momentum_ns) <
                      1e-9 * (glm::length(momentum_ns) + dt_s * push_n));
            double work_j = bodies::inner(body.load_n, body.du);
            for (std::size_t n = 0; n < 4; ++n)
                work_j += body.model.mass_kg[n] *
                          glm::dot(g, body.state.position_m[n] - from.position_m[n]);
            if (body.state.recovering)
                CHECK(body.energy_j() - before_j - work_j <=
                      kRounding * (before_j + std::abs(work_j)) + body.descent.roundoff_j);
        }
    }
    CHECK(descents > 100 * tangled::kCases);
}

TEST_CASE("a descent keeps linear momentum, and angular momentum as implicit Euler does") {
    // L' - L = dt sum m v' x v at a minimiser. Short of it, dt sum x' x grad E comes on top, which
    // is within dt |x'| |grad E|, and |grad E| is what the report says it is.
    std::mt19937_64 random(11);
    constexpr double kStep_s = 0.01;
    for (int i = 0; i < 2 * tangled::kCases; ++i) {
        Body body(tangled::cube(random()), elastic(10e3, 0.45));
        tangled::throw_about(body, i % 2 == 0 ? Shape::thrown : Shape::inside_out, random);
        for (dvec3& v : body.state.velocity_mps)
            v = dvec3{0.5, -0.2, 0.1} + 0.5 * bodies::signed_vector(random);
        body.begin(kStep_s);
        const tissue::CorotatedState before = body.state;
        const dvec3 momentum_ns = body.momentum_ns();
        double start_n = 0.0; // |grad E(0)| = |M v/dt - f_int|
        for (std::size_t k = 0; k < before.velocity_mps.size(); ++k)
            for (int axis = 0; axis < 3; ++axis)
                start_n += std::pow(body.model.mass_kg[k] / kStep_s * before.velocity_mps[k][axis] -
                                        body.system.internal_n[body.model.dof[k] + axis],
                                    2);
        start_n = std::sqrt(start_n);

        const tissue::StepEnd end = body.step();
        REQUIRE(end.iterations > 0);
        REQUIRE(end.speed_share == 1.0);
        CHECK(glm::length(body.momentum_ns() - momentum_ns) < 1e-9 * glm::length(momentum_ns));
        dvec3 turned{0.0}; // L' - L - dt sum m v' x v
        double reach2 = 0.0;
        for (std::size_t k = 0; k < before.velocity_mps.size(); ++k) {
            const double m = body.model.mass_kg[k];
            const dvec3 v = before.velocity_mps[k], v2 = body.state.velocity_mps[k];
            turned += m * (glm::cross(body.state.position_m[k], v2) -
                           glm::cross(before.position_m[k], v) - kStep_s * glm::cross(v2, v));
            reach2 += glm::dot(body.state.position_m[k], body.state.position_m[k]);
        }
        CHECK(glm::length(turned) <=
              kStep_s * std::sqrt(reach2) * end.relative_residual * start_n + 1e-15);
    }
}

TEST_CASE("nothing inverted, little gained: a step ends by advance and linearize, bit for bit") {
    std::mt19937_64 random(7);
    tissue::Material material = elastic(10e3, 0.45);
    material.damping_stiffness_s = 3e-3;
    Body body(tangled::cube(1), material);
    tissue::CorotatedSystem system = tissue::make_system(body.model);
    body.state =
        bodies::moved(body.model, body.state, bodies::random_unknowns(body.model, 4), 1e-3);
    for (std::size_t k = 0; k < body.state.velocity_mps.size(); ++k) // 0.4 radians a step
        body.state.velocity_mps[k] = glm::cross(dvec3{0, 0, 40.0}, body.state.position_m[k]) +
                                     0.1 * bodies::signed_vector(random);
    tissue::CorotatedState state = body.state;
    std::vector<double> du(body.du.size());
    body.begin(0.01);
    tissue::linearize(body.model, state, 0.01, system);
    for (int i = 0; i < 20; ++i) {
        CHECK(body.step().iterations == 0);
        CHECK_FALSE(body.state.recovering);
        tissue::free_motion(body.model, state, system, du);
        tissue::advance(body.model, du, 0.01, state);
        tissue::linearize(body.model, state, 0.01, system);
        REQUIRE(system.inverted == 0);
        CHECK(state.position_m == body.state.position_m);
        CHECK(state.velocity_mps == body.state.velocity_mps);
        CHECK(system.matrix == body.system.matrix);
        CHECK(system.internal_n == body.system.internal_n);
    }
}

TEST_CASE("thrown about under a constant load, a body comes to the rest that statics finds") {
    tissue::Material material = elastic(10e3, 0.45);
    material.damping_mass_1ps = 4.0;
    material.damping_stiffness_s = 3e-3;
    std::mt19937_64 random(9);
    for (int i = 0; i < tangled::kCases; ++i) {
        const tissue::TetMesh mesh = tangled::cube(random());
        Body body(mesh, material, bodies::anchors(mesh, [](auto x) { return x.z < 1e-9; }));
        body.load_n.assign(body.du.size(), 0.0);
        for (std::size_t k = 0; k < mesh.rest_m.size(); ++k)
            if (mesh.rest_m[k].z > 0.03 - 1e-9)
                body.load_n[body.model.dof[k] + 2] = -0.02; // 16 nodes: 0.3 N on 9 cm2
        tissue::CorotatedState resting = tissue::rest_state(body.model);
        REQUIRE(tissue::solve_static(body.model, body.load_n, 1e-10, 50, resting).converged);

        tangled::throw_about(body, Shape::thrown, random);
        body.begin(0.01);
        double before_j = body.energy_j();
        const double start_j = before_j;
        for (int k = 0; k < 200; ++k) {
            body.step();
            const double now_j = body.energy_j();
            CHECK(now_j - before_j <= bodies::inner(body.load_n, body.du) + kRounding * start_j);
            before_j = now_j;
        }
        double apart_m = 0.0;
        for (std::size_t k = 0; k < mesh.rest_m.size(); ++k)
            apart_m =
                std::max(apart_m, glm::distance(body.state.position_m[k], resting.position_m[k]));
        CHECK(apart_m < 1e-6); // a thousandth of what the load does
    }
}

TEST_CASE("a free body thrown about falls with its centre of mass as implicit Euler does") {
    const dvec3 g{0.0, 0.0, -9.81};
    Body body(tangled::cube(3), elastic(10e3, 0.45), {}, g);
    std::mt19937_64 random(3);
    tangled::throw_about(body, Shape::thrown, random);
    body.begin(0.01);
    for (int i = 1; i <= 20; ++i) {
        body.step();
        const dvec3 speed_mps = body.momentum_ns() / body.descent.mass_kg;
        CHECK(glm::length(speed_mps - 0.01 * i * g) < 1e-9 * 0.01 * i * glm::length(g));
    }
}

TEST_CASE("a descent allocates nothing of ours and repeats to the same bits") {
    Body one(tangled::cube(2), elastic(10e3, 0.45)), two = Body(one.model.mesh, one.model.material);
    std::mt19937_64 random(2);
    tangled::throw_about(two, Shape::inside_out, random); // leaves its scratch behind
    two.begin(0.02);
    two.step();
    tangled::throw_about(one, Shape::thrown, random);
    two.state = one.state;
    one.begin(0.02);
    two.begin(0.02);
    const std::size_t before = bodies::allocations();
    CHECK(one.step().iterations > 0);
    CHECK(bodies::allocations() == before);
    two.step();
    CHECK(one.state.position_m == two.state.position_m);
    CHECK(one.state.velocity_mps == two.state.velocity_mps);
}

TEST_CASE("a state that is not finite ends its step without a descent") {
    Body body(tangled::cube(1), elastic(10e3, 0.45));
    body.state.position_m[5].y = std::nan("");
    body.begin(0.01);
    const tissue::StepEnd end = body.step();
    CHECK(end.iterations == 0);
    CHECK_FALSE(body.system.factored);
}

TEST_CASE("a strip on the edge of buckling is not thrown by its all but singular tangent") {
    // long, thin, held at both ends and shortened along itself by `strain`: where its tangent
    // ceases to be positive definite, Newton's step under a small load aside is as long as one
    // likes
    const dvec3 size_m{0.1, 0.01, 0.004};
    const tissue::TetMesh mesh = tissue::box_mesh(size_m, {20, 2, 1});
    const auto ends =
        bodies::anchors(mesh, [&](dvec3 x) { return x.x < 1e-9 || x.x > size_m.x - 1e-9; });
    const auto at_strain = [&](double strain) {
        Body body(mesh, elastic(10e3, 0.45), ends);
        for (dvec3& x : body.state.position_m)
            x.x *= 1.0 - strain;
        body.load_n.assign(body.du.size(), 0.0);
        for (std::size_t i = 0; i < mesh.rest_m.size(); ++i)
            if (body.model.dof[i] >= 0)
                body.load_n[body.model.dof[i] + 2] = 1e-5;
        body.begin(0.05);
        return body;
    };
    double below = 0.0, above = 0.5;
    REQUIRE(at_strain(below).system.exact_tangent);
    REQUIRE_FALSE(at_strain(above).system.exact_tangent);
    int thrown = 0, caught = 0;
    while (above - below > 1e-12) {
        const double strain = 0.5 * (below + above);
        Body body = at_strain(strain);
        const bool definite = body.system.exact_tangent;
        (definite ? below : above) = strain;
        Body bare = at_strain(strain);
        tissue::free_motion(bare.model, bare.state, bare.system, bare.du, bare.load_n);
        tissue::advance(bare.model, bare.du, 0.05, bare.state);
        const double before_j = body.energy_j();
        thrown += bare.energy_j() > 2.0 * before_j + bodies::inner(bare.load_n, bare.du);
        caught += body.step().iterations > 0;
        CHECK(body.energy_j() < 1.2 * before_j + bodies::inner(body.load_n, body.du));
        CHECK(body.system.inverted == 0);
        for (std::size_t i = 0; i < mesh.rest_m.size(); ++i)
            CHECK(glm::distance(body.state.position_m[i], mesh.rest_m[i]) < 0.05);
    }
    CHECK(thrown > 3); // negative control: the bare step goes there
    CHECK(caught >= thrown);
}
