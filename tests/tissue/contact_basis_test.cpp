// tests/tissue/contact_basis_test.cpp
#include "tissue/response/contact_basis.h"

#include "tests/tissue/allocations.h"
#include "tests/tissue/touched_body.h"

#include <doctest/doctest.h>

using bodies::inner;
using bodies::norm;
using glm::dvec3;

namespace {

constexpr double kDelta_m = 0.005; // half a cell

struct Scene {
    bodies::TouchedBlock block;
    tissue::CorotatedState state;
    tissue::CorotatedSystem system;
};

// A block pressed a little out of shape and moving, linearised for steps of `dt_s`.
Scene scene(double dt_s) {
    tissue::Material material = bodies::elastic(8e3, 0.45);
    material.damping_mass_1ps = 4.0;
    material.damping_stiffness_s = 3e-3;
    bodies::TouchedBlock b = bodies::touched_block({7, 7, 4}, material);
    auto state = bodies::moved(b.model, tissue::rest_state(b.model),
                               bodies::random_unknowns(b.model, 1), 4e-4);
    std::mt19937_64 random(2);
    for (std::size_t i = 0; i < b.mesh.rest_m.size(); ++i) {
        if (b.model.dof[i] >= 0)
            state.velocity_mps[i] = 0.1 * bodies::signed_vector(random);
    }
    tissue::CorotatedSystem system = tissue::make_system(b.model);
    tissue::linearize(b.model, state, dt_s, system);
    return {std::move(b), std::move(state), std::move(system)};
}

tissue::BasisContact contact(const bodies::TouchedBlock& b, double x_m, double y_m) {
    const auto at = [&](double dx, double dy) { return bodies::on_top(b, x_m + dx, y_m + dy); };
    return {at(0, 0),
            {at(kDelta_m, 0), at(-kDelta_m, 0), at(0, kDelta_m), at(0, -kDelta_m)},
            {0, 0, 1},
            {1, 0, 0},
            {0, 1, 0}};
}

std::vector<double> mode(const tissue::ContactBasis& basis, int n, int j) {
    return {basis.shape.begin() + j * n, basis.shape.begin() + (j + 1) * n};
}

std::vector<double> times_mass(const tissue::CorotatedModel& model, std::vector<double> v) {
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        for (int k = 0; model.dof[i] >= 0 && k < 3; ++k)
            v[model.dof[i] + k] *= model.mass_kg[i];
    }
    return v;
}

std::vector<double> row(const Scene& s, const tissue::ContactPoint& at, const dvec3& d) {
    std::vector<double> h(static_cast<std::size_t>(s.block.model.unknowns), 0.0);
    tissue::add_row(s.block.model.dof, s.block.skin, at, d, 1.0, h);
    return h;
}

// How much of y is not in the basis, in the mass norm.
double outside(const Scene& s, const tissue::ContactBasis& basis, const std::vector<double>& y) {
    const int n = s.block.model.unknowns;
    const std::vector<double> my = times_mass(s.block.model, y);
    std::vector<double> rest = y;
    for (int j = 0; j < basis.modes; ++j) {
        const std::vector<double> v = mode(basis, n, j);
        const double share = inner(v, my);
        for (int i = 0; i < n; ++i)
            rest[i] -= share * v[i];
    }
    return std::sqrt(inner(rest, times_mass(s.block.model, rest)) / inner(y, my));
}

void check_orthonormal_and_diagonal(const Scene& s, const tissue::ContactBasis& basis) {
    const int n = s.block.model.unknowns;
    const double largest = basis.lambda[basis.modes - 1];
    std::vector<double> kv(static_cast<std::size_t>(n));
    for (int i = 0; i < basis.modes; ++i) {
        if (i > 0)
            CHECK(basis.lambda[i] >= basis.lambda[i - 1]);
        const std::vector<double> vi = mode(basis, n, i);
        const std::vector<double> mv = times_mass(s.block.model, vi);
        tissue::multiply(s.block.model.pattern, s.system.stiffness, vi, kv);
        for (int j = 0; j < basis.modes; ++j) {
            const std::vector<double> vj = mode(basis, n, j);
            CHECK(std::abs(inner(mv, vj) - (i == j ? 1.0 : 0.0)) < 1e-10);
            CHECK(std::abs(inner(kv, vj) - (i == j ? basis.lambda[i] : 0.0)) < 1e-9 * largest);
        }
    }
}

} // namespace

TEST_CASE("modes are mass-orthonormal and diagonalise the stiffness, for one to three contacts") {
    Scene s = scene(0.01);
    tissue::ContactBasis basis = tissue::make_contact_basis(s.block.model.unknowns);
    const std::vector<tissue::BasisContact> three{contact(s.block, 0.041, 0.039),
                                                  contact(s.block, 0.056, 0.039),
                                                  contact(s.block, 0.030, 0.058)};
    for (std::size_t count = 1; count <= 3; ++count) {
        tissue::compute_contact_basis(s.block.model, s.block.skin, s.state, s.system,
                                      std::span(three).first(count), basis);
        CHECK(basis.modes == static_cast<int>(11 * count));
        check_orthonormal_and_diagonal(s, basis);
    }
}

TEST_CASE("the answers to all loads and their moments lie in the basis") {
    Scene s = scene(0.02);
    tissue::ContactBasis basis = tissue::make_contact_basis(s.block.model.unknowns);
    const std::vector<tissue::BasisContact> two{contact(s.block, 0.041, 0.039),
                                                contact(s.block, 0.050, 0.044)};
    tissue::compute_contact_basis(s.block.model, s.block.skin, s.state, s.system, two, basis);
    for (const tissue::BasisContact& c : two) {
        for (const tissue::ContactPoint& star : c.star) {
            std::vector<double> y = row(s, star, c.normal);
            s.system.factor.solve(y, 1);
            CHECK(outside(s, basis, y) < 1e-8);
        }
        for (const dvec3& d : {c.normal, c.tangent1, c.tangent2}) {
            std::vector<double> y = row(s, c.centre, d);
            const int moments = d == c.normal ? 3 : 2;
            for (int k = 0; k < moments; ++k) {
                s.system.factor.solve(y, 1);
                CHECK(outside(s, basis, y) < 1e-8);
                y = times_mass(s.block.model, y);
            }
        }
    }
    // a load elsewhere does not
    std::vector<double> y = row(s, bodies::on_top(s.block, 0.01, 0.07), {0, 0, 1});
    s.system.factor.solve(y, 1);
    CHECK(outside(s, basis, y) > 0.1);
}

TEST_CASE("a held point has more moments instead of a star, beside one that is not held") {
    Scene s = scene(0.01);
    tissue::ContactBasis basis = tissue::make_contact_basis(s.block.model.unknowns);
    std::vector<tissue::BasisContact> two{contact(s.block, 0.056, 0.039),
                                          contact(s.block, 0.030, 0.058)};
    two[1].held = true;
    for (int order = 0; order < 2; ++order) {
        tissue::compute_contact_basis(s.block.model, s.block.skin, s.state, s.system, two, basis);
        CHECK(basis.modes == 22);
        check_orthonormal_and_diagonal(s, basis);
        for (const tissue::BasisContact& c : two) {
            for (const dvec3& d : {c.normal, c.tangent1, c.tangent2}) {
                std::vector<double> y = row(s, c.centre, d);
                const int moments = d == c.normal ? 3 : c.held ? 4 : 2;
                for (int k = 0; k < moments; ++k) {
                    s.system.factor.solve(y, 1);
                    CHECK(outside(s, basis, y) < 1e-7); // roundoff grows from moment to moment
                    y = times_mass(s.block.model, y);
                }
            }
            std::vector<double> y = row(s, c.star[0], c.normal);
            s.system.factor.solve(y, 1);
            CHECK((outside(s, basis, y) < 1e-8) == !c.held);
        }
        std::swap(two[0], two[1]);
    }
}

TEST_CASE("static modes reproduce the static response at the contact and at its star") {
    Scene s = scene(bodies::kStatics);
    tissue::ContactBasis basis = tissue::make_contact_basis(s.block.model.unknowns);
    const std::vector<tissue::BasisContact> one{contact(s.block, 0.041, 0.039)};
    tissue::compute_contact_basis(s.block.model, s.block.skin, s.state, s.system, one, basis);
    const int n = s.block.model.unknowns;
    for (const tissue::ContactPoint& at : {one[0].centre, one[0].star[1]}) {
        const std::vector<double> h = row(s, at, {0, 0, 1});
        std::vector<double> expected = h;
        s.system.factor.solve(expected, 1);
        std::vector<double> found(h.size(), 0.0);
        for (int j = 0; j < basis.modes; ++j) {
            const std::vector<double> v = mode(basis, n, j);
            const double q = inner(v, h) / basis.lambda[j];
            for (int i = 0; i < n; ++i)
                found[i] += q * v[i];
        }
        for (int i = 0; i < n; ++i)
            found[i] -= expected[i];
        CHECK(norm(found) < 1e-6 * norm(expected));
    }
}

TEST_CASE("columns of another factor serve: only a contact that moved on is solved for anew") {
    using tissue::KeptColumns;
    Scene s = scene(0.01);
    tissue::ContactBasis basis = tissue::make_contact_basis(s.block.model.unknowns);
    std::vector<tissue::BasisContact> three{contact(s.block, 0.041, 0.039),
                                            contact(s.block, 0.056, 0.039),
                                            contact(s.block, 0.030, 0.058)};
    const auto compute = [&] {
        tissue::compute_contact_basis(s.block.model, s.block.skin, s.state, s.system, three, basis);
    };
    compute();
    CHECK(basis.solved == 33);
    // out of shape by a few hundredths, so that K is another
    s.state =
        bodies::moved(s.block.model, s.state, bodies::random_unknowns(s.block.model, 5), 4e-4);
    tissue::linearize(s.block.model, s.state, 0.01, s.system);
    const auto answer = [&](const tissue::BasisContact& c, const dvec3& d) {
        const std::vector<double> h = row(s, c.centre, d);
        std::vector<double> exact = h;
        s.system.factor.solve(exact, 1);
        double of_modes = 0.0;
        for (int j = 0; j < basis.modes; ++j) {
            const double load = inner(mode(basis, s.block.model.unknowns, j), h);
            of_modes += load * load /
                        (1e4 + 4.0 * 1e2 + (1.0 + 3e-3 * 1e2) * basis.lambda[j]); // of_m, of_k
        }
        return of_modes / inner(h, exact);
    };
    three[0].kept = three[2].kept = KeptColumns::space;
    three[1] = contact(s.block, 0.060, 0.036);
    for (const KeptColumns known : {KeptColumns::about, KeptColumns::none}) {
        three[1].kept = known; // all of its moments at once, or one after the other
        compute();
        CHECK(basis.solved == 11);
        CHECK(basis.modes == 33);
        check_orthonormal_and_diagonal(s, basis);
        for (const tissue::BasisContact& c : three) {
            for (const dvec3& d : {c.normal, c.tangent1, c.tangent2}) {
                CHECK(answer(c, d) > 0.98);
                CHECK(answer(c, d) < 1.0 + 1e-9); // a Galerkin basis is never too soft
            }
        }
    }
    // negative control: loads of the old factor make neither these modes nor these frequencies
    const std::array<double, tissue::kMaxBasis> right = basis.lambda;
    three[0].kept = three[1].kept = three[2].kept = KeptColumns::all;
    compute();
    CHECK(basis.solved == 0);
    CHECK(std::abs(basis.lambda[32] / right[32] - 1.0) > 1e-6);
}

TEST_CASE("residual and rate are V^T (f_int - f_ext) and V^T M v") {
    Scene s = scene(0.01);
    tissue::ContactBasis basis = tissue::make_contact_basis(s.block.model.unknowns);
    const std::vector<tissue::BasisContact> one{contact(s.block, 0.041, 0.039)};
    tissue::compute_contact_basis(s.block.model, s.block.skin, s.state, s.system, one, basis);
    const int n = s.block.model.unknowns;
    std::vector<double> velocity(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < s.block.model.dof.size(); ++i) {
        for (int k = 0; s.block.model.dof[i] >= 0 && k < 3; ++k) {
            velocity[s.block.model.dof[i] + k] = s.state.velocity_mps[i][k];
        }
    }
    const std::vector<double> momentum = times_mass(s.block.model, velocity);
    for (int j = 0; j < basis.modes; ++j) {
        const std::vector<double> v = mode(basis, n, j);
        CHECK(std::abs(basis.residual[j] - inner(v, s.system.internal_n)) <
              1e-12 * norm(v) * norm(s.system.internal_n));
        CHECK(std::abs(basis.rate[j] - inner(v, momentum)) < 1e-12 * norm(v) * norm(momentum));
    }
}

TEST_CASE("a second tool at the same place adds nothing, one a little aside adds all") {
    Scene s = scene(0.01);
    tissue::ContactBasis basis = tissue::make_contact_basis(s.block.model.unknowns);
    const auto rank = [&](double apart_m) {
        const std::vector<tissue::BasisContact> two{contact(s.block, 0.041, 0.039),
                                                    contact(s.block, 0.041 + apart_m, 0.039)};
        tissue::compute_contact_basis(s.block.model, s.block.skin, s.state, s.system, two, basis);
        check_orthonormal_and_diagonal(s, basis);
        return basis.modes;
    };
    CHECK(rank(0.0) == 11);
    CHECK(rank(0.0013) == 22);
    // the second tool's centre is the first one's star point: one load fewer
    CHECK(rank(kDelta_m) == 20);
}

TEST_CASE("a contact on anchored tissue has no modes, and spoils none") {
    Scene s = scene(0.01);
    // a row of nothing but an anchored node
    const std::uint32_t corner = s.block.skin.triangles[0][0];
    tissue::ContactSurface skin = s.block.skin;
    for (std::uint32_t k = skin.row_start[corner]; k < skin.row_start[corner + 1]; ++k) {
        skin.row_node[k] = 0;
    }
    tissue::BasisContact stuck = contact(s.block, 0.041, 0.039);
    stuck.centre = {0, {1, 0, 0}};
    stuck.star.fill(stuck.centre);
    REQUIRE(s.block.model.dof[0] < 0);
    tissue::ContactBasis basis = tissue::make_contact_basis(s.block.model.unknowns);
    const std::vector<tissue::BasisContact> both{stuck, contact(s.block, 0.041, 0.039)};
    tissue::compute_contact_basis(s.block.model, skin, s.state, s.system, std::span(both).first(1),
                                  basis);
    CHECK(basis.modes == 0);
    tissue::compute_contact_basis(s.block.model, skin, s.state, s.system, both, basis);
    CHECK(basis.modes == 11);
    check_orthonormal_and_diagonal(s, basis);
    tissue::compute_contact_basis(s.block.model, skin, s.state, s.system, {}, basis);
    CHECK(basis.modes == 0);
}

TEST_CASE("step and basis allocate nothing of ours, and repeat to the same bits") {
    Scene s = scene(0.01);
    const std::vector<tissue::BasisContact> two{contact(s.block, 0.041, 0.039),
                                                contact(s.block, 0.056, 0.039)};
    tissue::ContactBasis a = tissue::make_contact_basis(s.block.model.unknowns), b = a;
    std::vector<double> du(static_cast<std::size_t>(s.block.model.unknowns));
    const std::size_t before = bodies::allocations();
    tissue::compute_contact_basis(s.block.model, s.block.skin, s.state, s.system, two, a);
    tissue::linearize(s.block.model, s.state, 0.01, s.system);
    tissue::free_motion(s.block.model, s.state, s.system, du);
    tissue::compute_contact_basis(s.block.model, s.block.skin, s.state, s.system, two, b);
    CHECK(bodies::allocations() == before);
    CHECK(a.modes == b.modes);
    CHECK(a.shape == b.shape);
    CHECK(a.lambda == b.lambda);
    tissue::rest_state(s.block.model);
    CHECK(bodies::allocations() > before); // it does count
}
