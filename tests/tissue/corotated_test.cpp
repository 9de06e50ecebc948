// tests/tissue/corotated_test.cpp
// The corotated step against closed forms and invariants.
#include "tests/tissue/bodies.h"

#include <doctest/doctest.h>
#include <glm/matrix.hpp>

using bodies::elastic;
using glm::dmat3;
using glm::dvec3;

namespace {

dvec3 sum_of(const std::vector<dvec3>& v) {
    dvec3 sum{0.0};
    for (const dvec3& x : v)
        sum += x;
    return sum;
}

std::vector<dvec3> forces(const tissue::CorotatedModel& model, const tissue::CorotatedState& s) {
    std::vector<dvec3> f(model.dof.size());
    tissue::elastic_forces(model, s, f);
    return f;
}

// One tet on an equilateral base, its apex above the centroid: `height_m` high, base anchored.
tissue::CorotatedModel lone_tet(const tissue::Material& material, double height_m) {
    const double r = 0.01, root3 = std::sqrt(3.0);
    const tissue::TetMesh mesh{
        {{r, 0, 0}, {-r / 2, r * root3 / 2, 0}, {-r / 2, -r * root3 / 2, 0}, {0, 0, height_m}},
        {{0, 1, 2, 3}}};
    return tissue::make_corotated(mesh, material, std::vector<std::uint8_t>{1, 1, 1, 0});
}

} // namespace

TEST_CASE("free fall is implicit Euler's: v = g n dt, x = g dt^2 n (n + 1) / 2") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.02, 0.02, 0.02}, {2, 2, 2});
    const dvec3 g{1.0, 2.0, -9.81};
    const auto model = tissue::make_corotated(mesh, elastic(8e3, 0.45), {}, g);
    tissue::CorotatedState state = tissue::rest_state(model);
    tissue::CorotatedSystem system = tissue::make_system(model);
    constexpr int n = 30;
    constexpr double dt_s = 0.01;
    for (int i = 0; i < n; ++i)
        bodies::step(model, state, system, dt_s);
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
        CHECK(glm::length(state.velocity_mps[i] - g * (n * dt_s)) < 1e-11);
        CHECK(glm::length(state.position_m[i] - mesh.rest_m[i] -
                          g * (dt_s * dt_s * n * (n + 1) / 2)) < 1e-12);
    }
}

TEST_CASE("a stretched bar pulls with E strain A, its sides are free at Poisson's contraction") {
    const double young_pa = 8e3, poisson = 0.4, strain = 0.05;
    const tissue::TetMesh mesh = tissue::box_mesh({0.04, 0.02, 0.02}, {4, 2, 2}, 0.1);
    const auto model = tissue::make_corotated(mesh, elastic(young_pa, poisson), {});
    tissue::CorotatedState state = tissue::rest_state(model);
    for (dvec3& x : state.position_m) {
        x *= dvec3(1 + strain, 1 - poisson * strain, 1 - poisson * strain);
    }
    const std::vector<dvec3> f = forces(model, state);
    dvec3 end{0.0};
    for (std::size_t i = 0; i < f.size(); ++i) {
        if (mesh.rest_m[i].x > 0.04 - 1e-9)
            end += f[i];
        const bool inside = mesh.rest_m[i].x > 1e-9 && mesh.rest_m[i].x < 0.04 - 1e-9;
        if (inside)
            CHECK(glm::length(f[i]) < 1e-14);
    }
    CHECK(end.x == doctest::Approx(young_pa * strain * 0.02 * 0.02).scale(0.0).epsilon(1e-12));
    CHECK(std::abs(end.y) + std::abs(end.z) < 1e-14);
}

TEST_CASE("a rigid rotation by 1 to 720 degrees about any axis makes no force") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.02, 0.02, 0.02}, {2, 2, 2}, 0.2);
    const double young_pa = 10e3;
    const auto model = tissue::make_corotated(mesh, elastic(young_pa, 0.45), {});
    std::mt19937_64 random(1);
    for (int degrees = 1; degrees <= 720; degrees += 17) {
        const dmat3 R = bodies::rotation(bodies::signed_vector(random), degrees * 0.0174532925);
        tissue::CorotatedState state = tissue::rest_state(model);
        for (dvec3& x : state.position_m)
            x = R * x + dvec3(0.3, -0.1, 0.2);
        for (const dvec3& f : forces(model, state)) {
            CHECK(glm::length(f) < 1e-9 * young_pa * 0.02 * 0.02);
        }
    }
}

TEST_CASE("internal forces have no resultant and no moment, inverted or not") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.03, 0.02, 0.02}, {3, 2, 2}, 0.1);
    const auto model = tissue::make_corotated(mesh, elastic(10e3, 0.45), {});
    for (const double noise_m : {1e-3, 2e-2}) {
        const auto state = bodies::moved(model, tissue::rest_state(model),
                                         bodies::random_unknowns(model, 3), noise_m);
        const std::vector<dvec3> f = forces(model, state);
        double size = 0.0;
        dvec3 moment{0.0};
        for (std::size_t i = 0; i < f.size(); ++i) {
            size += glm::length(f[i]);
            moment += glm::cross(state.position_m[i], f[i]);
        }
        CHECK(glm::length(sum_of(f)) < 1e-13 * size);
        CHECK(glm::length(moment) < 1e-13 * size * 0.05);
    }
}

TEST_CASE("a free body keeps its linear momentum while it wobbles") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.03, 0.02, 0.02}, {3, 2, 2}, 0.1);
    tissue::Material material = elastic(10e3, 0.45);
    material.damping_stiffness_s = 3e-3; // stiffness damping is internal too
    const auto model = tissue::make_corotated(mesh, material, {});
    tissue::CorotatedState state =
        bodies::moved(model, tissue::rest_state(model), bodies::random_unknowns(model, 3), 1e-3);
    std::mt19937_64 random(8);
    for (dvec3& v : state.velocity_mps)
        v = 0.1 * bodies::signed_vector(random);
    const auto momentum = [&] {
        dvec3 sum{0.0};
        for (std::size_t i = 0; i < model.mass_kg.size(); ++i) {
            sum += model.mass_kg[i] * state.velocity_mps[i];
        }
        return sum;
    };
    tissue::CorotatedSystem system = tissue::make_system(model);
    for (int i = 0; i < 20; ++i) {
        const dvec3 before = momentum();
        CHECK(bodies::step(model, state, system, 0.01).relative_residual < 1e-10);
        CHECK(glm::length(momentum() - before) < 1e-9 * glm::length(before));
    }
}

TEST_CASE("a mode loses 1/sqrt(1 + (w dt)^2) of its amplitude per step, and no more") {
    // the apex of a lone tet bounces along its axis: K = V (lambda + 2 mu) / h^2
    const double height_m = 0.008;
    for (const double dt_s : {1e-3, 5e-3, 20e-3}) {
        const auto model = lone_tet(elastic(500.0, 0.3), height_m);
        const double stiffness_npm =
            model.volume_m3[0] * (model.lambda_pa + 2 * model.mu_pa) / (height_m * height_m);
        const double w2 = stiffness_npm / model.mass_kg[3];
        tissue::CorotatedState state = tissue::rest_state(model);
        tissue::CorotatedSystem system = tissue::make_system(model);
        state.position_m[3].z += 1e-3; // along the axis the tet is linear until it turns over
        const auto energy = [&] {
            const double u = state.position_m[3].z - height_m;
            return w2 * u * u + state.velocity_mps[3].z * state.velocity_mps[3].z;
        };
        for (int i = 0; i < 4; ++i) {
            const double before = energy();
            bodies::step(model, state, system, dt_s);
            CHECK(
                std::sqrt(energy() / before) ==
                doctest::Approx(1.0 / std::sqrt(1.0 + w2 * dt_s * dt_s)).scale(0.0).epsilon(1e-10));
        }
    }
}

TEST_CASE("Rayleigh damping acts with alpha M + beta K") {
    // implicit Euler of m u'' + c u' + k u = 0 on the same mode
    const double height_m = 0.008, dt_s = 4e-3, alpha = 7.0, beta = 5e-3;
    tissue::Material material = elastic(500.0, 0.3);
    material.damping_mass_1ps = alpha;
    material.damping_stiffness_s = beta;
    const auto model = lone_tet(material, height_m);
    const double w2 = model.volume_m3[0] * (model.lambda_pa + 2 * model.mu_pa) /
                      (height_m * height_m) / model.mass_kg[3];
    tissue::CorotatedState state = tissue::rest_state(model);
    tissue::CorotatedSystem system = tissue::make_system(model);
    state.position_m[3].z += 1e-6;
    double u = 1e-6, v = 0.0;
    for (int i = 0; i < 10; ++i) {
        v = (v - dt_s * w2 * u) / (1 + dt_s * (alpha + beta * w2) + dt_s * dt_s * w2);
        u += dt_s * v;
        bodies::step(model, state, system, dt_s);
        // epsilon of a double at 8 mm is 1e-12 of the amplitude
        CHECK(std::abs(state.position_m[3].z - height_m - u) < 1e-10 * 1e-6 + 1e-17);
        CHECK(state.velocity_mps[3].z == doctest::Approx(v).scale(0.0).epsilon(1e-8));
    }
}

TEST_CASE("a cube with its vertices in a ball, or flattened, or turned inside out, recovers") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.03, 0.03, 0.03}, {3, 3, 3}, 0.1);
    tissue::Material material = elastic(10e3, 0.45);
    material.damping_mass_1ps = 4.0;
    material.damping_stiffness_s = 3e-3;
    const auto model = tissue::make_corotated(mesh, material, {});
    const double rest_volume_m3 = tissue::volume_m3(mesh, mesh.rest_m);
    for (int shape = 0; shape < 3; ++shape) {
        tissue::CorotatedState state = tissue::rest_state(model);
        std::mt19937_64 random(static_cast<std::uint64_t>(shape) + 1);
        for (dvec3& x : state.position_m) {
            if (shape == 0)
                x = 0.015 * bodies::signed_vector(random);
            if (shape == 1)
                x.z = 0.0;
            if (shape == 2)
                x.z = -x.z;
        }
        tissue::CorotatedSystem system = tissue::make_system(model);
        const double start_j = tissue::elastic_energy_j(model, state);
        double highest_j = 0.0;
        for (int i = 0; i < 50; ++i) { // one second
            bodies::step(model, state, system, 0.02);
            REQUIRE(system.factored);
            highest_j = std::max(highest_j, tissue::elastic_energy_j(model, state) +
                                                bodies::kinetic_energy_j(model, state));
        }
        CHECK(highest_j <= start_j);
        CHECK(system.inverted == 0);
        CHECK(tissue::volume_m3(mesh, state.position_m) ==
              doctest::Approx(rest_volume_m3).scale(0.0).epsilon(1e-3));
        CHECK(tissue::elastic_energy_j(model, state) < 1e-4 * start_j);
    }
}

TEST_CASE("an inverted tet takes its warped stiffness without touching the others") {
    const auto model = lone_tet(elastic(500.0, 0.3), 0.008);
    tissue::CorotatedState state = tissue::rest_state(model);
    tissue::CorotatedSystem exact = tissue::make_system(model), warped = tissue::make_system(model);
    for (const double height_m : {0.006, -0.006}) {
        state.position_m[3] = {0.001, 0.0, height_m};
        tissue::linearize(model, state, 1e-3, exact, true);
        tissue::linearize(model, state, 1e-3, warped, false);
        CHECK(exact.exact_tangent);
        CHECK(exact.inverted == (height_m < 0 ? 1 : 0));
        CHECK((exact.stiffness == warped.stiffness) == (height_m < 0));
    }
}

TEST_CASE("a state that is not finite is reported and moves nothing") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.02, 0.02, 0.02}, {2, 2, 2});
    const auto model = tissue::make_corotated(mesh, elastic(8e3, 0.45), {});
    tissue::CorotatedState state = tissue::rest_state(model);
    state.position_m[5].y = std::nan("");
    tissue::CorotatedSystem system = tissue::make_system(model);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns), 1.0);
    tissue::linearize(model, state, 0.01, system);
    CHECK_FALSE(system.factored);
    CHECK(tissue::free_motion(model, state, system, du).relative_residual == 1.0);
    CHECK(bodies::norm(du) == 0.0);
}

TEST_CASE("an indefinite exact tangent is replaced by the warped one, and said") {
    // squeezed to a third the block would buckle: without mass its exact tangent is indefinite
    const tissue::TetMesh mesh = tissue::box_mesh({0.01, 0.01, 0.08}, {1, 1, 8});
    const auto flags = bodies::anchors(mesh, [](auto x) { return x.z < 1e-9 || x.z > 0.0799; });
    const auto model = tissue::make_corotated(mesh, elastic(8e3, 0.3), flags);
    tissue::CorotatedState state = tissue::rest_state(model);
    for (dvec3& x : state.position_m)
        x.z /= 3.0;
    tissue::CorotatedSystem system = tissue::make_system(model);
    tissue::linearize(model, state, bodies::kStatics, system);
    CHECK_FALSE(system.exact_tangent);
    CHECK(system.factored);
    CHECK(system.inverted == 0);
    tissue::linearize(model, tissue::rest_state(model), bodies::kStatics, system);
    CHECK(system.exact_tangent);
}

TEST_CASE("the same state gives the same bits, whatever the system did before") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.03, 0.02, 0.02}, {3, 2, 2}, 0.1);
    const auto model = tissue::make_corotated(mesh, elastic(10e3, 0.45), {});
    const auto start =
        bodies::moved(model, tissue::rest_state(model), bodies::random_unknowns(model, 3), 1e-3);
    tissue::CorotatedSystem used = tissue::make_system(model), fresh = tissue::make_system(model);
    tissue::CorotatedState a = tissue::rest_state(model), b = start;
    for (int i = 0; i < 5; ++i)
        bodies::step(model, a, used, 0.02);
    a = start;
    for (int i = 0; i < 5; ++i) {
        bodies::step(model, a, used, 0.01);
        bodies::step(model, b, fresh, 0.01);
    }
    CHECK(a.position_m == b.position_m);
    CHECK(a.velocity_mps == b.velocity_mps);
}
