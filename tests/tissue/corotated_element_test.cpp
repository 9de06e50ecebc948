// tests/tissue/corotated_element_test.cpp
// Derivatives: force against energy, tangent against force.
#include "tissue/solver/corotated_element.h"

#include "tests/tissue/bodies.h"

#include <doctest/doctest.h>
#include <glm/matrix.hpp>

using bodies::inner;
using bodies::norm;

namespace {

struct Bent {
    tissue::CorotatedModel model;
    tissue::CorotatedState state;
};

// A block bent, twisted and stretched; `noise_m` on top of it. No tet is inverted.
Bent bent_block(double poisson, double strain, double noise_m) {
    const tissue::TetMesh mesh = tissue::box_mesh({0.04, 0.03, 0.03}, {4, 3, 3}, 0.1);
    Bent b{tissue::make_corotated(mesh, bodies::elastic(8e3, poisson),
                                  bodies::anchors(mesh, [](auto x) { return x.x < 1e-9; })),
           {}};
    b.state = tissue::rest_state(b.model);
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
        const glm::dvec3 x = mesh.rest_m[i];
        if (x.x < 1e-9)
            continue;
        const glm::dmat3 twist = bodies::rotation({1, 0, 0}, strain * 40.0 * x.x);
        b.state.position_m[i] =
            twist * glm::dvec3{x.x * (1 + strain), x.y * (1 - 0.3 * strain), x.z} +
            glm::dvec3{0, strain * 25.0 * x.x * x.x, -strain * 10.0 * x.x * x.x};
    }
    b.state = bodies::moved(b.model, b.state, bodies::random_unknowns(b.model, 5), noise_m);
    return b;
}

// f(+h) - f(-h) over 2h along d.
std::vector<double> force_difference(const Bent& b, const std::vector<double>& d, double h) {
    tissue::CorotatedSystem system = tissue::make_system(b.model);
    tissue::linearize(b.model, bodies::moved(b.model, b.state, d, h), 0.01, system);
    std::vector<double> difference = system.internal_n;
    tissue::linearize(b.model, bodies::moved(b.model, b.state, d, -h), 0.01, system);
    for (std::size_t i = 0; i < difference.size(); ++i) {
        difference[i] = (difference[i] - system.internal_n[i]) / (2 * h);
    }
    return difference;
}

double tangent_error(const Bent& b, bool exact) {
    tissue::CorotatedSystem system = tissue::make_system(b.model);
    tissue::linearize(b.model, b.state, 0.01, system, exact);
    CHECK(system.inverted == 0);
    CHECK(system.exact_tangent == exact);
    const std::vector<double> d = bodies::random_unknowns(b.model, 9);
    const std::vector<double> expected = force_difference(b, d, 1e-7);
    std::vector<double> product(d.size());
    tissue::multiply(b.model.pattern, system.stiffness, d, product);
    for (std::size_t i = 0; i < product.size(); ++i)
        product[i] -= expected[i];
    return norm(product) / norm(expected);
}

} // namespace

TEST_CASE("force is the gradient of the energy, at rest, at large and at inverted shapes") {
    // central difference over h = 1e-6 m of cells of 10 mm: truncation (h/l)^2 = 1e-8, and
    // roundoff eps E/(h f) below 1e-9
    for (const double noise_m : {1e-5, 1.5e-3, 8e-3}) {
        const Bent b = bent_block(0.45, 0.2, noise_m);
        tissue::CorotatedSystem system = tissue::make_system(b.model);
        tissue::linearize(b.model, b.state, 0.01, system);
        if (noise_m > 5e-3)
            CHECK(system.inverted > 0);
        std::vector<double> d = bodies::random_unknowns(b.model, 6);
        const double h = 1e-6;
        const double up = tissue::elastic_energy_j(b.model, bodies::moved(b.model, b.state, d, h));
        const double down =
            tissue::elastic_energy_j(b.model, bodies::moved(b.model, b.state, d, -h));
        const double along = inner(system.internal_n, d);
        CHECK(std::abs((up - down) / (2 * h) - along) < 1e-6 * norm(system.internal_n) * norm(d));
    }
}

TEST_CASE("the exact tangent is the derivative of the force, also at large deformation") {
    // h = 1e-7 m in 10 mm cells: truncation (h/l)^2 = 1e-10, roundoff 1e-16 l/h = 1e-11, both
    // times the number of nodes that meet: 1e-8 is ten times the sum
    for (const double poisson : {0.0, 0.3, 0.45, 0.49}) {
        CHECK(tangent_error(bent_block(poisson, 0.0, 0.0), true) < 1e-8);
        CHECK(tangent_error(bent_block(poisson, 0.2, 1e-4), true) < 1e-8);
        CHECK(tangent_error(bent_block(poisson, 0.3, 1.2e-3), true) < 1e-8);
    }
}

TEST_CASE("the warped tangent is the derivative at rest only") {
    CHECK(tangent_error(bent_block(0.45, 0.0, 0.0), false) < 1e-8);
    CHECK(tangent_error(bent_block(0.45, 0.2, 1e-4), false) > 1e-3);
}

TEST_CASE("the warped tangent is R Ke R^T of the linear tetrahedron") {
    const Bent b = bent_block(0.4, 0.3, 1e-3);
    const double lambda = b.model.lambda_pa, mu = b.model.mu_pa;
    tissue::CorotatedSystem system = tissue::make_system(b.model);
    tissue::linearize(b.model, b.state, 0.01, system, false);
    const std::vector<double> d = bodies::random_unknowns(b.model, 4);
    std::vector<double> product(d.size()), expected(d.size(), 0.0);
    tissue::multiply(b.model.pattern, system.stiffness, d, product);

    // per tet: f_a = V R sigma(R^T grad d) G_a, Hooke's law in the tet's own frame
    for (std::size_t e = 0; e < b.model.mesh.tets.size(); ++e) {
        const tissue::Tet& t = b.model.mesh.tets[e];
        const auto& G = b.model.gradient_1pm[e];
        glm::dmat3 F(0.0), gradient(0.0);
        for (int a = 0; a < 4; ++a) {
            const int k = b.model.dof[t[a]];
            const glm::dvec3 da = k < 0 ? glm::dvec3{0.0} : glm::dvec3{d[k], d[k + 1], d[k + 2]};
            F += glm::outerProduct(b.state.position_m[t[a]], G[a]);
            gradient += glm::outerProduct(da, G[a]);
        }
        const glm::dmat3 R = tissue::closest_rotation(F);
        const glm::dmat3 local = glm::transpose(R) * gradient;
        const glm::dmat3 strain = 0.5 * (local + glm::transpose(local));
        const double trace = strain[0][0] + strain[1][1] + strain[2][2];
        const glm::dmat3 stress = 2.0 * mu * strain + lambda * trace * glm::dmat3(1.0);
        for (int a = 0; a < 4; ++a) {
            const int k = b.model.dof[t[a]];
            const glm::dvec3 f = b.model.volume_m3[e] * (R * (stress * G[a]));
            for (int c = 0; k >= 0 && c < 3; ++c)
                expected[k + c] += f[c];
        }
    }
    for (std::size_t i = 0; i < d.size(); ++i)
        product[i] -= expected[i];
    CHECK(norm(product) < 1e-12 * norm(expected));
}
