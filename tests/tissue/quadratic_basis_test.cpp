// tests/tissue/quadratic_basis_test.cpp
// The contact basis of a quadratic block, at rest and pressed.
#include "tissue/response/contact_basis.h"

#include "tests/tissue/allocations.h"
#include "tests/tissue/quadratic_bodies.h"
#include "tests/tissue/touched_body.h"
#include "tissue/solver/quadratic_columns.h"

#include <doctest/doctest.h>

using bodies::inner;
using glm::dvec3;

namespace {

constexpr double kStep_s = 0.01, kDelta_m = 0.004;
constexpr dvec3 kSize_m{0.08, 0.08, 0.04};

struct Scene {
    bodies::TouchedBlock block; // for its mesh and skin
    tissue::QuadraticModel model;
    tissue::QuadraticState state;
    tissue::QuadraticSystem system;
    std::array<tissue::BasisContact, 3> contact;
    tissue::ContactBasis basis;
    int n = 0;
};

// Squeezed by `strain` in z, a little more in the middle, at rest.
Scene scene(double strain, double poisson = 0.45) {
    tissue::Material material = bodies::elastic(8e3, poisson);
    material.damping_mass_1ps = 4.0;
    material.damping_stiffness_s = 3e-3;
    bodies::TouchedBlock block{tissue::box_mesh(kSize_m, {4, 4, 2}, 0.15), {}, {}};
    block.skin = bodies::fine_top(block.mesh, kSize_m, 0.035);
    const auto mesh = tissue::quadratic_mesh(block.mesh);
    std::vector<std::uint8_t> held;
    for (const dvec3& x : mesh.rest_m)
        held.push_back(x.z < 1e-9);
    auto model = make_quadratic(mesh, material, held);
    auto state = rest_state(model);
    const double wider = 1.0 / std::sqrt(1.0 - strain); // so that the volume stays
    for (std::size_t i = 0; i < state.position_m.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        const dvec3 X = model.mesh.rest_m[i];
        const double out = 1.0 + (wider - 1.0) * X.z / kSize_m.z;
        state.position_m[i] = {0.04 + out * (X.x - 0.04), 0.04 + out * (X.y - 0.04),
                               (1.0 - strain) * X.z};
    }
    auto system = make_system(model, kStep_s);
    linearize(model, state, system);
    const int n = model.unknowns;
    Scene s{std::move(block),
            std::move(model),
            std::move(state),
            std::move(system),
            {},
            tissue::make_contact_basis(n),
            n};
    constexpr double kAt[3][2] = {{0.041, 0.039}, {0.056, 0.039}, {0.030, 0.058}};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto at = [&](double dx, double dy) {
            return bodies::on_top(s.block, kAt[i][0] + dx, kAt[i][1] + dy);
        };
        s.contact[i] = {at(0, 0),
                        {at(kDelta_m, 0), at(-kDelta_m, 0), at(0, kDelta_m), at(0, -kDelta_m)},
                        {0, 0, 1},
                        {1, 0, 0},
                        {0, 1, 0}};
    }
    return s;
}

void compute(Scene& s, std::size_t contacts) {
    compute_contact_basis(s.model, s.block.skin, s.state, s.system,
                          std::span(s.contact).first(contacts), s.basis);
}

std::vector<double> mode(const Scene& s, int j) {
    return {s.basis.shape.begin() + j * s.n, s.basis.shape.begin() + (j + 1) * s.n};
}

void check_orthonormal_and_diagonal(Scene& s) {
    const double largest = s.basis.lambda[s.basis.modes - 1];
    std::vector<double> k(static_cast<std::size_t>(s.n)), m(k.size());
    for (int i = 0; i < s.basis.modes; ++i) {
        const std::vector<double> v = mode(s, i);
        stiffness_product(s.model, v, s.system, k);
        mass_product(s.model, v, s.system, m);
        for (int j = 0; j < s.basis.modes; ++j) {
            const std::vector<double> u = mode(s, j);
            CHECK(std::abs(inner(m, u) - (i == j ? 1.0 : 0.0)) < 1e-10);
            // K is applied in single precision
            CHECK(std::abs(inner(k, u) - (i == j ? s.basis.lambda[i] : 0.0)) < 1e-5 * largest);
        }
    }
}

std::vector<double> row(const Scene& s, const tissue::ContactPoint& at, const dvec3& d) {
    std::vector<double> h(static_cast<std::size_t>(s.n), 0.0);
    tissue::add_row(s.model.dof, s.block.skin, at, d, 1.0, h);
    return h;
}

// Moves a contact and its star over the skin.
void slide(Scene& s, std::size_t i, double x, double y) {
    const auto at = [&](double dx, double dy) { return bodies::on_top(s.block, x + dx, y + dy); };
    s.contact[i].centre = at(0, 0);
    s.contact[i].star = {at(kDelta_m, 0), at(-kDelta_m, 0), at(0, kDelta_m), at(0, -kDelta_m)};
}

// h^T A^-1 h of the modes over that of the body, in a step of dt.
double share_of_compliance(Scene& s, const std::vector<double>& h) {
    const double of_m = 1.0 / (kStep_s * kStep_s) + 4.0 / kStep_s, of_k = 1.0 + 3e-3 / kStep_s;
    double found = 0.0;
    for (int j = 0; j < s.basis.modes; ++j) {
        const double part = inner(mode(s, j), h);
        found += part * part / (of_m + of_k * s.basis.lambda[j]);
    }
    std::vector<double> x = h;
    const auto report =
        solve_columns(s.model, {.linear_tolerance = 1e-5, .max_linear = 400}, s.system, x, 1);
    CHECK(report.relative_residual <= 1e-5);
    return found / inner(x, h);
}

} // namespace

TEST_CASE("quadratic modes are mass-orthonormal and diagonalise the stiffness") {
    Scene s = scene(0.1);
    for (const std::size_t contacts : {1, 2, 3}) {
        compute(s, contacts);
        CHECK(s.basis.modes == static_cast<int>(11 * contacts));
        check_orthonormal_and_diagonal(s);
    }
    for (auto& c : s.contact)
        c.held = true;
    compute(s, 3);
    CHECK(s.basis.modes == 33);
    check_orthonormal_and_diagonal(s);
}

TEST_CASE("rough columns answer a step's load as the body does, within 1 %, also when squeezed") {
    for (const double strain : {0.0, 0.15, 0.3}) {
        Scene s = scene(strain);
        for (int step = 0; step < 2; ++step) { // without and with modes of a step before
            compute(s, 3);
            for (const auto& contact : s.contact) {
                for (const dvec3& d : {contact.normal, contact.tangent1, contact.tangent2}) {
                    const double share = share_of_compliance(s, row(s, contact.centre, d));
                    CHECK(share > 0.99);
                    CHECK(share < 1.0 + 1e-4); // Galerkin: never softer, but for rounding
                }
                const double share = share_of_compliance(s, row(s, contact.star[0], {0, 0, 1}));
                CHECK(share > 0.99);
                CHECK(share < 1.0 + 1e-4);
            }
        }
    }
}

TEST_CASE("a contact that moves on is solved for alone, as well as all of them at once") {
    using tissue::KeptColumns;
    for (const double strain : {0.0, 0.3}) {
        Scene s = scene(strain);
        compute(s, 3);
        CHECK(s.basis.solved == 33);
        slide(s, 1, 0.057, 0.040); // 1.4 mm, a third of an arm
        s.contact[0].kept = s.contact[2].kept = KeptColumns::all;
        s.contact[1].kept = KeptColumns::about;
        compute(s, 3);
        CHECK(s.basis.solved == 11);
        CHECK(s.basis.modes == 33);
        check_orthonormal_and_diagonal(s);
        for (const auto& contact : s.contact) {
            for (const dvec3& d : {contact.normal, contact.tangent1, contact.tangent2})
                CHECK(share_of_compliance(s, row(s, contact.centre, d)) > 0.99);
            CHECK(share_of_compliance(s, row(s, contact.star[0], {0, 0, 1})) > 0.99);
        }
        // negative control: kept although it is elsewhere
        slide(s, 1, 0.070, 0.020);
        s.contact[1].kept = KeptColumns::all;
        compute(s, 3);
        CHECK(s.basis.solved == 0);
        CHECK(share_of_compliance(s, row(s, s.contact[1].centre, {0, 0, 1})) < 0.95);
    }
}

TEST_CASE("a contact that leaves takes its modes along, and nothing is solved for") {
    Scene s = scene(0.1);
    compute(s, 3);
    s.contact[1] = s.contact[2]; // the second tool has gone
    s.contact[0].slot = 0;
    s.contact[1].slot = 2;
    s.contact[0].kept = s.contact[1].kept = tissue::KeptColumns::all;
    compute(s, 2);
    CHECK(s.basis.solved == 0);
    CHECK(s.basis.modes == 22);
    check_orthonormal_and_diagonal(s);
    for (int i = 0; i < 2; ++i)
        CHECK(share_of_compliance(s, row(s, s.contact[i].centre, {0, 0, 1})) > 0.99);
}

TEST_CASE("solves that start from known modes take fewer iterations to the same answer") {
    Scene s = scene(0.25);
    std::vector<double> b;
    for (const auto& contact : s.contact) {
        for (const dvec3& d : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)}) {
            const std::vector<double> h = row(s, contact.centre, d);
            b.insert(b.end(), h.begin(), h.end());
        }
    }
    std::vector<double> before = b, after = b, x(static_cast<std::size_t>(s.n));
    const auto from_zero = solve_columns(s.model, {}, s.system, before, 9);
    const std::span<const double> first(b.data(), x.size());
    const auto single_from_zero = solve(s.model, {}, first, s.system, x);
    compute(s, 3);
    const auto from_modes = solve_columns(s.model, {}, s.system, after, 9);
    const auto single_from_modes = solve(s.model, {}, first, s.system, x);
    CHECK(from_zero.relative_residual <= 1e-3);
    CHECK(from_modes.relative_residual <= 1e-3);
    CHECK(single_from_modes.relative_residual <= 1e-3);
    CHECK(from_modes.iterations < from_zero.iterations);
    CHECK(single_from_modes.iterations < single_from_zero.iterations);
    for (std::size_t k = 0; k < after.size(); ++k)
        after[k] -= before[k];
    CHECK(bodies::norm(after) < 0.01 * bodies::norm(before)); // tolerance times a condition
    // and no contact is nothing known: the same bits as before
    compute(s, 0);
    after = b;
    solve_columns(s.model, {}, s.system, after, 9);
    CHECK(after == before);
}

TEST_CASE("a quadratic body whose tangent is indefinite has modes all the same") {
    // pressed flat without room to the sides: det F = 0.5
    Scene s = scene(0.0, 0.3);
    for (std::size_t i = 0; i < s.state.position_m.size(); ++i)
        s.state.position_m[i].z *= 0.4;
    linearize(s.model, s.state, s.system);
    REQUIRE(!s.system.recovering);
    for (auto& tangent : s.system.tangent.elastic) { // and ten times its geometric stiffness
        for (auto& point : tangent.point) {
            for (float& bend : point[tissue::QuadraticTangent::kBend])
                bend *= 10.0f;
        }
    }
    compute(s, 3);
    CHECK(s.basis.modes == 33);
    check_orthonormal_and_diagonal(s);
}

TEST_CASE("a quadratic basis allocates nothing, and repeats to the same bits") {
    Scene a = scene(0.2), b = scene(0.2);
    const std::size_t before = bodies::allocations();
    for (int k = 0; k < 3; ++k)
        compute(a, 3);
    CHECK(bodies::allocations() == before);
    for (int k = 0; k < 3; ++k)
        compute(b, 3);
    CHECK(a.basis.shape == b.basis.shape);
    CHECK(a.basis.lambda == b.basis.lambda);
}
