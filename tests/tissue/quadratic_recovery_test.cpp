// tests/tissue/quadratic_recovery_test.cpp
// Quadratic bodies from hard starts: inside out, and where the tangent is indefinite.
#include "tests/tissue/quadratic_bodies.h"
#include "tissue/solver/quadratic_points.h"

#include <doctest/doctest.h>

using bodies::elastic;
using glm::dvec3;
using quadratic_bodies::curved_box;
using quadratic_bodies::greatest_distance_m;
using quadratic_bodies::held_at_x0;
using quadratic_bodies::random_vectors;
using quadratic_bodies::step;

TEST_CASE("a held body whose nodes start anywhere returns to rest") {
    for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
        const auto mesh = curved_box(seed);
        const auto held = held_at_x0(mesh);
        const auto model = make_quadratic(mesh, elastic(20e3, 0.45), held);
        auto system = make_system(model, 0.01);
        auto state = rest_state(model);
        const auto anywhere = random_vectors(held.size(), 0.1, seed);
        for (std::size_t i = 0; i < held.size(); ++i) {
            if (held[i] == 0)
                state.position_m[i] = anywhere[i];
        }
        CHECK(step(model, {}, system, state).recovering);
        tissue::QuadraticReport report;
        for (int i = 0; i < 500; ++i)
            report = step(model, {}, system, state);
        CHECK_FALSE(report.recovering);
        CHECK(greatest_distance_m(state.position_m, mesh.rest_m) < 1e-4 * 0.1);
    }
}

TEST_CASE("a free body turned inside out gets back its shape where it is and as it lies") {
    const auto mesh = curved_box(2);
    auto material = elastic(20e3, 0.45);
    material.damping_mass_1ps = 10.0;
    const auto model = make_quadratic(mesh, material, {});
    auto system = make_system(model, 0.01);
    auto state = rest_state(model);
    const glm::dmat3 R = bodies::rotation({1, 2, 3}, 2.5);
    dvec3 rest_centre{0.0}, centre{0.0};
    for (dvec3& x : state.position_m) {
        rest_centre += x;
        // mirrored along its shortest side: R is the rotation nearest to that
        x = dvec3{5, 6, 7} + R * dvec3{x.x, x.y, -x.z};
    }
    CHECK(step(model, {}, system, state).recovering);
    tissue::QuadraticReport report;
    for (int i = 0; i < 500; ++i)
        report = step(model, {}, system, state);
    CHECK_FALSE(report.recovering);
    for (const dvec3& x : state.position_m)
        centre += x;
    const auto nodes = static_cast<double>(mesh.rest_m.size());
    centre /= nodes;
    rest_centre /= nodes;
    CHECK(report.min_det_f == doctest::Approx(1.0).scale(0.0).epsilon(1e-3));
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
        // it is not symmetric, so it turns a little on the way
        const dvec3 there = R * (mesh.rest_m[i] - rest_centre);
        CHECK(glm::length(state.position_m[i] - centre - there) < 0.2 * 0.1);
        CHECK(glm::length(state.position_m[i] - centre) ==
              doctest::Approx(glm::length(there)).scale(0.0).epsilon(1e-2));
    }
}

TEST_CASE("without its geometric stiffness the tangent is positive, however deformed") {
    const auto mesh = curved_box(2);
    const auto model = make_quadratic(mesh, elastic(20e3, 0.3), {});
    auto system = make_system(model, 0.01);
    const dvec3 stretch[]{{0.5, -0.7, 0.5}, {-0.3, -0.4, -0.3}, {0.6, 0.5, 0.7}};
    int seen = 0, indefinite = 0;
    for (unsigned seed = 0; seed < 40; ++seed) {
        std::vector<double> moved(model.weight_n.size(), 0.0);
        const auto shake = random_vectors(mesh.rest_m.size(), 4e-3, seed);
        for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
            // pressed flat, pressed from all sides, or blown up
            const dvec3 u = shake[i] + mesh.rest_m[i] * stretch[seed % 3];
            for (int c = 0; c < 3; ++c)
                moved[4 * i + c] = u[c];
        }
        const auto sums =
            stresses(model, moved, {}, system.internal_n, system.tangent, system.stretch);
        if (!(sums.min_det_f > 0.0))
            continue;
        ++seen;
        const auto curvature = [&](unsigned way) {
            std::fill(system.q.begin(), system.q.end(), 0.0f);
            std::fill(system.p.begin(), system.p.end(), 0.0f);
            // all nodes, or a spin, whose curvature in a compressed body is negative
            const auto d = random_vectors(mesh.rest_m.size(), 1.0, way);
            for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
                const dvec3 x =
                    mesh.rest_m[i] + dvec3{moved[4 * i], moved[4 * i + 1], moved[4 * i + 2]};
                const dvec3 to = way % 2 == 0 ? d[i] : glm::cross(d[0], x);
                for (int c = 0; c < 3; ++c)
                    system.p[4 * i + c] = static_cast<float>(to[c]);
            }
            add_tangent_product(model, system.tangent, 1.0f, system.p, system.q);
            double sum = 0.0;
            for (std::size_t i = 0; i < system.p.size(); ++i)
                sum += double(system.p[i]) * double(system.q[i]);
            return sum;
        };
        for (unsigned way = 0; way < 100; ++way)
            indefinite += curvature(way) < 0.0;
        for (auto& tangent : system.tangent.elastic) {
            for (auto& point : tangent.point)
                point[tissue::QuadraticTangent::kBend].fill(0.0f);
        }
        for (unsigned way = 0; way < 100; ++way)
            CHECK(curvature(way) > 0.0);
    }
    CHECK(seen > 10);
    CHECK(indefinite > 0); // or nothing was shown
}
