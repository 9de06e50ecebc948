// A tube as one of the bodies of the tissue loop: what contact is told, in every tier, and the
// modes that the local model gets.
#include "tests/tissue/allocations.h"
#include "tests/tissue/rods.h"
#include "tissue/response/rod_basis.h"
#include "tissue/solver/solid.h"

#include <doctest/doctest.h>
#include <numbers>

using glm::dvec3;
using std::numbers::pi;

namespace {

constexpr double kLength_m = 0.1, kRadius_m = 3e-3, kYoung_pa = 30e3;
constexpr int kEdges = 40, kSides = 8;

// Along x, clamped over an edge beyond either end; a skin of rings 5 mm apart.
struct Tube {
    tissue::RodLine line;
    tissue::ContactSurface skin;
    tissue::Material material = rods::elastic(kYoung_pa);

    Tube() {
        for (int i = -1; i <= kEdges + 1; ++i) {
            line.node_m.emplace_back(kLength_m * i / kEdges, 0.0, 0.0);
            line.held.push_back(i < 1 || i >= kEdges ? 1 : 0);
        }
        line.radius_m.assign(line.node_m.size(), kRadius_m);
        line.hold_m.assign(line.node_m.size(), 0.0);
        for (int ring = 0; ring <= 20; ++ring) {
            for (int k = 0; k < kSides; ++k)
                skin.rest_m.emplace_back(5e-3 * ring, kRadius_m * std::cos(2 * pi * k / kSides),
                                         kRadius_m * std::sin(2 * pi * k / kSides));
        }
        for (std::uint32_t ring = 0; ring < 20; ++ring) {
            for (std::uint32_t k = 0; k < kSides; ++k) {
                const std::uint32_t a = ring * kSides + k, b = ring * kSides + (k + 1) % kSides;
                skin.triangles.push_back({a, a + kSides, b});
                skin.triangles.push_back({b, a + kSides, b + kSides});
            }
        }
    }
    tissue::Solid solid(tissue::Tier tier, double dt_s) const {
        const tissue::TetMesh none;
        return make_solid(tier, {.mesh = none, .line = &line, .skin_m = skin.rest_m}, material,
                          dvec3{0.0}, dt_s);
    }
    /// The uppermost vertex of the middle ring.
    static constexpr std::size_t kTop = 10 * kSides + kSides / 4;
};

double mid_compliance_mpn(tissue::Solid& solid) {
    std::vector<double> block(static_cast<std::size_t>(unknowns(solid)), 0.0);
    block[3 * Tube::kTop + 2] = 1.0;
    solve(solid, 1e-6, {}, block, 1);
    return block[3 * Tube::kTop + 2];
}

} // namespace

TEST_CASE("pressed at mid-span the skin of a clamped tube gives L^3/(192 E I), in every tier") {
    const Tube tube;
    const double expected_mpn =
        std::pow(kLength_m, 3) / (192 * kYoung_pa * pi / 4 * std::pow(kRadius_m, 4));
    for (const tissue::Tier tier :
         {tissue::Tier::linear, tissue::Tier::corotated, tissue::Tier::quadratic}) {
        tissue::Solid solid = tube.solid(tier, rods::kStatics_s);
        CHECK(tier_of(solid) == tier);
        CHECK(mid_compliance_mpn(solid) == doctest::Approx(expected_mpn).scale(0.0).epsilon(0.01));
    }
}

TEST_CASE("steps of a pressed tube end where statics is, with the stress of its outer fibre") {
    const Tube tube;
    Tube heavy = tube;
    heavy.material.damping_mass_1ps = 20.0;
    tissue::Solid solid = heavy.solid(tissue::Tier::corotated, 0.01);
    const double force_n = 2e-4; // so little that it stays straight
    std::vector<double> load(static_cast<std::size_t>(unknowns(solid)), 0.0), du(load.size());
    load[3 * Tube::kTop + 2] = force_n;
    for (int i = 0; i < 500; ++i) {
        free_motion(solid, true, load, du);
        end_step(solid, load, 20e-6, du);
    }
    tissue::Solid still = tube.solid(tissue::Tier::corotated, rods::kStatics_s);
    CHECK(position_m(solid)[Tube::kTop].z - kRadius_m * std::sin(pi / 2) ==
          doctest::Approx(force_n * mid_compliance_mpn(still)).scale(0.0).epsilon(0.01));
    // M = P L/8 in the middle and at the clamps, sigma = M r/I; nodes see the mean around them
    const double fibre_pa = force_n * kLength_m / 8 * kRadius_m / (pi / 4 * std::pow(kRadius_m, 4));
    CHECK(peak_von_mises_pa(solid) == doctest::Approx(fibre_pa).scale(0.0).epsilon(0.1));
    CHECK(elastic_energy_j(solid) ==
          doctest::Approx(0.5 * force_n * force_n * mid_compliance_mpn(still))
              .scale(0.0)
              .epsilon(0.02));
}

TEST_CASE("modes of a tube answer its contact as its own step does, and nothing is allocated") {
    const Tube tube;
    auto solid = tube.solid(tissue::Tier::corotated, 0.01);
    auto& rod = std::get<tissue::RodSolid>(solid);
    // the middle of a triangle at the top
    std::uint32_t at = 0;
    for (std::uint32_t t = 0; t < tube.skin.triangles.size(); ++t) {
        const auto& c = tube.skin.triangles[t];
        if (c[0] == Tube::kTop || c[1] == Tube::kTop)
            at = t;
    }
    tissue::BasisContact contact{.centre = {at, dvec3{1.0 / 3}},
                                 .star = {},
                                 .normal = {0, 0, 1},
                                 .tangent1 = {1, 0, 0},
                                 .tangent2 = {0, 1, 0}};
    for (int k = 0; k < 4; ++k) { // within the triangle, so that each is another point
        dvec3 weight{0.2};
        weight[k % 3] = k < 3 ? 0.6 : 0.5;
        weight /= weight.x + weight.y + weight.z;
        contact.star[static_cast<std::size_t>(k)] = {at, weight};
    }
    auto basis = tissue::make_contact_basis(rod.model.unknowns);
    const std::size_t before = bodies::allocations();
    compute_contact_basis(rod.model, tube.skin, rod.state, rod.system, std::span(&contact, 1),
                          basis);
    refresh_contact_basis(rod.model, rod.state, rod.system, basis);
    CHECK(bodies::allocations() == before);
    REQUIRE(basis.modes >= 5);
    const auto n = static_cast<std::size_t>(rod.model.unknowns);
    const auto& corner = tube.skin.triangles[at];
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> block(n, 0.0);
        for (const auto v : corner)
            block[3 * v + static_cast<std::size_t>(axis)] += 1.0 / 3;
        const std::vector<double> load = block;
        solve(solid, 1e-6, {}, block, 1);
        double exact = 0.0, of_modes = 0.0;
        for (std::size_t i = 0; i < n; ++i)
            exact += load[i] * block[i];
        for (int m = 0; m < basis.modes; ++m) {
            double share = 0.0;
            for (std::size_t i = 0; i < n; ++i)
                share += load[i] * basis.shape[static_cast<std::size_t>(m) * n + i];
            of_modes += share * share / (1e4 + basis.lambda[static_cast<std::size_t>(m)]);
        }
        CHECK(of_modes == doctest::Approx(exact).scale(0.0).epsilon(1e-6));
    }
}
