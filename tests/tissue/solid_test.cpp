// tests/tissue/solid_test.cpp
// Bodies of all tiers by their common signature, pressed through footprint rows: against linear
// statics on the same shapes and beds, the converged reference solver, and exact solves.
#include "tests/tissue/touched_body.h"
#include "tissue/mesh/quadratic_mesh.h"
#include "tissue/reference/reference.h"
#include "tissue/response/contact_basis.h"
#include "tissue/response/linear_statics.h"
#include "tissue/solver/measures.h"
#include "tissue/solver/solid.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

namespace {

using glm::dvec3;
using tissue::Tier;

constexpr double kStep_s = 1e-2;
const dvec3 kSize_m{0.08, 0.08, 0.04};
const tissue::Material kTissue{
    .young_pa = 8e3, .poisson = 0.45, .damping_mass_1ps = 20.0, .source = ""};

tissue::TetMesh block_mesh(const std::array<int, 3>& cells) {
    return tissue::box_mesh(kSize_m, cells, 0.15);
}

std::vector<std::uint8_t> clamped_below(const tissue::TetMesh& mesh) {
    return bodies::anchors(mesh, [](const dvec3& x) { return x.z < 1e-9; });
}

// Held below by springs instead, nothing anchored.
std::vector<tissue::BedSample> bed_below(const tissue::TetMesh& mesh) {
    return tissue::make_bed(
        mesh, [](const dvec3& x) { return x.z < 0.013; }, 12e-3);
}

// A press in the middle of the top, spread over linear shapes' nodes: any load serves here.
std::vector<double> press(std::span<const dvec3> rest_m, std::span<const std::int32_t> dofs,
                          const dvec3& force_n) {
    std::vector<double> load(3 * rest_m.size(), 0.0);
    std::vector<double> weight(rest_m.size(), 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < rest_m.size(); ++i) {
        const double r = glm::distance(rest_m[i], {0.04, 0.035, 0.04}) / 0.02;
        weight[i] = dofs[i] >= 0 && rest_m[i].z > 0.04 - 1e-9 ? std::max(0.0, 1.0 - r * r) : 0.0;
        sum += weight[i];
    }
    std::size_t last = 0;
    for (std::size_t i = 0; i < rest_m.size(); ++i) {
        for (int k = 0; dofs[i] >= 0 && k < 3; ++k) {
            load[dofs[i] + k] = weight[i] / sum * force_n[k];
            last = std::max(last, static_cast<std::size_t>(dofs[i] + k + 1));
        }
    }
    load.resize(last);
    return load;
}

// Steps under a constant load as the tissue loop makes them: as if a contact solve had found it.
tissue::SolidReport press_steps(tissue::Solid& solid, std::span<const double> load_n, int steps) {
    const auto n = static_cast<std::size_t>(tissue::unknowns(solid));
    std::vector<double> du(n), answer(n);
    tissue::SolidReport worst;
    for (int s = 0; s < steps; ++s) {
        const tissue::SolidReport free = tissue::free_motion(solid, true, {}, du);
        std::copy(load_n.begin(), load_n.end(), answer.begin());
        const double residual = tissue::solve(solid, 1e-3, {}, answer, 1);
        for (std::size_t i = 0; i < n; ++i)
            du[i] += answer[i];
        worst = tissue::end_step(solid, load_n, 0.0, du);
        worst.linear_residual = std::max({residual, free.linear_residual, worst.linear_residual});
    }
    return worst;
}

std::vector<double> moved(const tissue::Solid& solid) {
    std::vector<double> u(static_cast<std::size_t>(tissue::unknowns(solid)));
    const auto rest = tissue::rest_m(solid), now = tissue::position_m(solid);
    const auto dofs = tissue::dofs(solid);
    for (std::size_t i = 0; i < dofs.size(); ++i) {
        for (int k = 0; dofs[i] >= 0 && k < 3; ++k)
            u[dofs[i] + k] = now[i][k] - rest[i][k];
    }
    return u;
}

double inner(std::span<const double> a, std::span<const double> b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

// Largest difference, of the largest entry.
double off(std::span<const double> a, std::span<const double> truth) {
    double most = 0.0, size = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        most = std::max(most, std::abs(a[i] - truth[i]));
        size = std::max(size, std::abs(truth[i]));
    }
    return most / size;
}

} // namespace

TEST_CASE("solid: how roughly a change of load is answered does not show once the load stays") {
    const tissue::TetMesh mesh = block_mesh({5, 5, 3});
    const std::vector<tissue::BedSample> bed = bed_below(mesh);
    const std::vector<std::uint8_t> loose(mesh.rest_m.size(), 0);
    for (const Tier tier : {Tier::corotated, Tier::quadratic}) {
        CAPTURE(tissue::name_of(tier));
        const auto settled = [&](double wrong) {
            tissue::Solid solid =
                tissue::make_solid(tier, {mesh, loose, bed}, kTissue, dvec3{0.0}, kStep_s);
            const std::vector<double> load =
                press(tissue::rest_m(solid), tissue::dofs(solid), {0.05, 0.0, -0.2});
            const auto n = static_cast<std::size_t>(tissue::unknowns(solid));
            std::vector<double> du(n), answer(n), before(n);
            for (int step = 0; step < 400; ++step) {
                tissue::free_motion(solid, true, before, du);
                std::fill(answer.begin(), answer.end(), 0.0);
                for (std::size_t i = 0; i < load.size(); ++i)
                    answer[i] = load[i] - before[i];
                tissue::solve(solid, 1e-3, {}, answer, 1);
                for (std::size_t i = 0; i < n; ++i)
                    du[i] += wrong * answer[i];
                std::copy(load.begin(), load.end(), before.begin());
                tissue::end_step(solid, load, 20e-6, du);
            }
            return moved(solid);
        };
        const std::vector<double> truth = settled(1.0);
        CHECK(off(settled(0.7), truth) < 1e-3);
    }
}

TEST_CASE("solid: under a small press on a bed, linear statics of the same shapes is found") {
    const tissue::TetMesh mesh = block_mesh({5, 5, 3});
    const std::vector<tissue::BedSample> bed = bed_below(mesh);
    const std::vector<std::uint8_t> loose(mesh.rest_m.size(), 0);
    for (const Tier tier : {Tier::linear, Tier::corotated, Tier::quadratic}) {
        CAPTURE(tissue::name_of(tier));
        const int order = tier == Tier::quadratic ? 2 : 1;
        const auto statics = tissue::make_linear_statics(mesh, order, kTissue.poisson, loose, bed);
        tissue::Solid solid =
            tissue::make_solid(tier, {mesh, loose, bed}, kTissue, dvec3{0.0}, kStep_s);
        REQUIRE(tissue::tier_of(solid) == tier);
        REQUIRE(tissue::unknowns(solid) == statics.unknowns);
        // 0.2 mN moves the top by some hundredths of a millimetre: 0.1 % of an element
        const std::vector<double> load =
            press(tissue::rest_m(solid), tissue::dofs(solid), {5e-5, 0.0, -2e-4});
        std::vector<double> truth = load;
        for (double& f : truth)
            f /= kTissue.young_pa;
        tissue::SparseFactor factor(statics.pattern);
        REQUIRE(factor.factor(statics.stiffness_m));
        // linear_statics numbers nodes by edge, the quadratic mesh too: the same order is needed
        factor.solve(truth, 1);
        press_steps(solid, load, 400);
        const double energy = inner(truth, load);
        CHECK(inner(moved(solid), load) == doctest::Approx(energy).epsilon(2e-3).scale(0.0));
    }
}

TEST_CASE("solid: a hard press on quadratic tissue settles where the converged solver does") {
    const tissue::TetMesh mesh = block_mesh({4, 4, 2});
    const std::vector<std::uint8_t> clamped = clamped_below(mesh);
    tissue::Solid solid =
        tissue::make_solid(Tier::quadratic, {mesh, clamped, {}}, kTissue, dvec3{0.0}, kStep_s);
    const auto& body = std::get<tissue::QuadraticSolid>(solid);
    const std::vector<double> load =
        press(tissue::rest_m(solid), tissue::dofs(solid), {0.4, 0.1, -2.0});
    const tissue::SolidReport last = press_steps(solid, load, 300);
    CHECK(last.residual < 1e-3);
    CHECK(last.linear_residual < 1e-3);

    std::vector<std::uint8_t> held(body.model.mesh.rest_m.size(), 0);
    std::vector<dvec3> force_n(held.size(), dvec3{0.0});
    for (std::size_t i = 0; i < held.size(); ++i) {
        held[i] = body.model.dof[i] < 0 ? tissue::kHeld : 0;
        for (int k = 0; held[i] == 0 && k < 3; ++k)
            force_n[i][k] = load[body.model.dof[i] + k];
    }
    const auto model =
        tissue::make_reference(body.model.mesh, kTissue, tissue::Law::neo_hooke, held);
    tissue::ReferenceSystem system = tissue::make_system(model);
    tissue::ReferenceState state = tissue::rest_state(model);
    REQUIRE(tissue::solve_static(model, {force_n, {}}, {}, system, state).converged);
    std::vector<double> truth(load.size());
    double deepest_m = 0.0;
    for (std::size_t i = 0; i < held.size(); ++i) {
        for (int k = 0; held[i] == 0 && k < 3; ++k)
            truth[body.model.dof[i] + k] = state.position_m[i][k] - model.mesh.rest_m[i][k];
        deepest_m = std::max(deepest_m, model.mesh.rest_m[i].z - state.position_m[i].z);
    }
    // the peak stress of the loop, and of the measures, which go their own way to it
    tissue::TissueLog log = tissue::make_tissue_log(body.model);
    const double peak_pa = tissue::measure(body.model, body.state, {}, 0.0, log).peak_von_mises_pa;
    CHECK(tissue::peak_von_mises_pa(solid) == doctest::Approx(peak_pa).epsilon(1e-3).scale(0.0));
    CHECK(deepest_m > 6e-3); // it is a hard press: a fifth of the thickness
    CHECK(off(moved(solid), truth) < 2e-3);
}

TEST_CASE("solid: only the tiers that turn can be turned") {
    // a free block spun by its velocities: half a turn a second for a quarter of a turn
    const tissue::TetMesh mesh = block_mesh({2, 2, 1});
    const tissue::Material undamped{.young_pa = 8e3,
                                    .poisson = 0.45,
                                    .damping_mass_1ps = 0.0,
                                    .damping_stiffness_s = 0.0,
                                    .source = ""};
    const std::vector<std::uint8_t> loose(mesh.rest_m.size(), 0);
    const auto turned_edge = [&](Tier tier) {
        tissue::Solid solid =
            tissue::make_solid(tier, {mesh, loose, {}}, undamped, dvec3{0.0}, kStep_s);
        const dvec3 middle = 0.5 * kSize_m;
        std::visit(
            [&](auto& s) {
                for (std::size_t i = 0; i < s.state.velocity_mps.size(); ++i)
                    s.state.velocity_mps[i] =
                        glm::cross(dvec3{0, 0, M_PI}, s.state.position_m[i] - middle);
            },
            solid);
        const auto n = static_cast<std::size_t>(tissue::unknowns(solid));
        std::vector<double> du(n), load(n, 0.0);
        if (auto* s = std::get_if<tissue::CorotatedSolid>(&solid))
            tissue::linearize(s->model, s->state, kStep_s, s->system);
        for (int i = 0; i < 50; ++i) {
            tissue::free_motion(solid, false, {}, du);
            tissue::end_step(solid, load, 0.0, du);
        }
        const auto x = tissue::position_m(solid);
        return glm::distance(x[0], x[1]) / glm::distance(mesh.rest_m[0], mesh.rest_m[1]);
    };
    // implicit Euler loses spin and the spin stretches a little; the linear law swells by far more
    CHECK(std::abs(turned_edge(Tier::corotated) - 1.0) < 0.03);
    CHECK(std::abs(turned_edge(Tier::quadratic) - 1.0) < 0.03);
    CHECK(std::abs(turned_edge(Tier::linear) - 1.0) > 0.1);
}

TEST_CASE("solid: modes of quadratic tissue yield under the contact as exact solves say") {
    const tissue::TetMesh mesh = block_mesh({4, 4, 2});
    const std::vector<std::uint8_t> clamped = clamped_below(mesh);
    tissue::Solid solid =
        tissue::make_solid(Tier::quadratic, {mesh, clamped, {}}, kTissue, dvec3{0.0}, kStep_s);
    auto& body = std::get<tissue::QuadraticSolid>(solid);
    const tissue::ContactSurface skin = bodies::fine_top(mesh, kSize_m, 0.025);
    const bodies::TouchedBlock top{mesh, {}, skin};
    const auto at = [&](double x, double y) { return bodies::on_top(top, x, y); };
    const tissue::BasisContact contact{
        .centre = at(0.041, 0.037),
        .star = {at(0.045, 0.037), at(0.037, 0.037), at(0.041, 0.041), at(0.041, 0.033)},
        .normal = {0, 0, 1},
        .tangent1 = {1, 0, 0},
        .tangent2 = {0, 1, 0}};
    tissue::ContactBasis basis = tissue::make_contact_basis(tissue::unknowns(solid));
    const auto n = static_cast<std::size_t>(tissue::unknowns(solid));
    // at rest; pressed by millimetres; and ten steps later, pressed harder, by the modes of then
    for (const double force_n : {0.0, 1.0, 1.2}) {
        CAPTURE(force_n);
        const bool follows = force_n > 1.0;
        const std::vector<double> load =
            press(tissue::rest_m(solid), tissue::dofs(solid), {0.0, 0.0, -force_n});
        press_steps(solid, load, follows ? 10 : 60);
        if (follows)
            tissue::follow_contact_basis(body.model, body.state, body.system, basis);
        else
            tissue::compute_contact_basis(body.model, skin, body.state, body.system,
                                          std::span(&contact, 1), basis);
        REQUIRE(basis.modes == tissue::kModesPerContact);
        const double rate = 1.0 / kStep_s;
        for (const dvec3& d : {contact.normal, contact.tangent1, contact.tangent2}) {
            std::vector<double> row(n, 0.0), answer(n);
            tissue::add_row(body.model.dof, skin, contact.centre, d, 1.0, row);
            const tissue::QuadraticOptions exact{.linear_tolerance = 1e-5};
            tissue::solve(body.model, exact, row, body.system, answer);
            const double truth_mpn = inner(row, answer);
            double modes_mpn = 0.0;
            for (int m = 0; m < basis.modes; ++m) {
                const double s = inner(row, std::span(basis.shape).subspan(m * n, n));
                const double stiff = 1.0 + kTissue.damping_stiffness_s * rate;
                modes_mpn +=
                    s * s /
                    (rate * rate + kTissue.damping_mass_1ps * rate + stiff * basis.lambda[m]);
            }
            // a Galerkin space can only be stiffer, and its error counts squared
            CHECK(modes_mpn < truth_mpn * (1.0 + 1e-4));
            CHECK(modes_mpn > truth_mpn * 0.99);
        }
    }
}
