// A tube as a rod beside the same full cylinder in the reference solver: both ends held, the middle
// pushed aside. Where a rod is enough, and where it is not.
#include "tests/tissue/cylinders.h"
#include "tests/tissue/reference_bodies.h"
#include "tests/tissue/rods.h"

#include <doctest/doctest.h>
#include <initializer_list>

using glm::dvec3;

namespace {

constexpr double kRadius_m = 3e-3;

// Force across that holds the middle cross-section, which does not deform in that direction,
// `aside_m` away. Half of the length is meshed, up to the plane of symmetry.
double solid_force_n(double length_m, double aside_m) {
    const int cells = static_cast<int>(std::lround(0.5 * length_m / kRadius_m / 0.8));
    cylinders::Rings rings{.radius_m = {0.02 * kRadius_m, 0.6 * kRadius_m, kRadius_m},
                           .segments = 8,
                           .arc_rad = 2 * std::numbers::pi};
    for (int i = 0; i <= cells; ++i)
        rings.z_m.push_back(0.5 * length_m * i / cells);
    const auto mesh = cylinders::mesh(rings);
    const auto middle = [&](const dvec3& x) { return x.z > 0.5 * length_m - 1e-9; };
    const auto held = reference_bodies::flags(mesh, [&](const dvec3& x) {
        return x.z < 1e-9 ? tissue::kHeld : middle(x) ? tissue::kHeldX | tissue::kHeldZ : 0;
    });
    const auto model = tissue::make_reference(mesh, rods::elastic(), tissue::Law::neo_hooke, held);
    auto state = rest_state(model);
    auto system = make_system(model);
    for (int part = 1; part <= 4; ++part) {
        const auto to_m = reference_bodies::places(mesh, [&](const dvec3& x) {
            return x + (middle(x) ? dvec3{aside_m * part / 4, 0, 0} : dvec3{0.0});
        });
        CHECK(solve_static(model, {{}, to_m}, {.tolerance = 1e-8}, system, state).converged);
    }
    std::vector<dvec3> force_n(mesh.rest_m.size());
    elastic_forces(model, state.position_m, force_n);
    double sum_n = 0.0;
    for (std::size_t i = 0; i < force_n.size(); ++i)
        sum_n += middle(mesh.rest_m[i]) ? 2 * force_n[i].x : 0.0;
    return sum_n;
}

// The same of the rod: the force under which its middle goes there.
double rod_force_n(double length_m, double aside_m) {
    const tissue::RodModel model =
        rods::straight({.length_m = length_m, .radius_m = kRadius_m, .edges = 40, .both = true});
    tissue::RodSystem system = make_system(model);
    double low_n = 0.0, high_n = 10.0;
    for (int i = 0; i < 40; ++i) {
        const double force_n = 0.5 * (low_n + high_n);
        tissue::RodState state = rest_state(model);
        rods::step(model, rods::kStatics_s, rods::load_at(model, 21, {0, force_n, 0}), system,
                   state);
        (state.position_m[21].y < aside_m ? low_n : high_n) = force_n;
    }
    return low_n;
}

// At some ways aside, of the radius: the force, and the stiffness from one to the next, of the rod
// over that of the solid.
struct Ratio {
    double force = 0.0, stiffness = 0.0;
};
std::vector<Ratio> ratios(double slenderness, std::initializer_list<double> aside) {
    const double length_m = slenderness * kRadius_m;
    double rod_before_n = 0.0, solid_before_n = 0.0;
    std::vector<Ratio> all;
    for (const double part : aside) {
        const double rod_n = rod_force_n(length_m, part * kRadius_m);
        const double solid_n = solid_force_n(length_m, part * kRadius_m);
        all.push_back({rod_n / solid_n, (rod_n - rod_before_n) / (solid_n - solid_before_n)});
        MESSAGE("L/r ", slenderness, ", aside ", part, " r: force ", all.back().force,
                ", stiffness ", all.back().stiffness);
        rod_before_n = rod_n;
        solid_before_n = solid_n;
    }
    return all;
}

// What a hand tells apart: 7 % of a force, 15 % of a stiffness.
void check_same(const std::vector<Ratio>& all) {
    for (const Ratio& r : all) {
        CHECK(std::abs(r.force - 1.0) < 0.07);
        CHECK(std::abs(r.stiffness - 1.0) < 0.15);
    }
}

} // namespace

TEST_CASE("a rod of 33 radii, as the vessels of find-tubes, is the solid to 4 radii aside") {
    check_same(ratios(33.0, {0.3, 1.0, 2.0, 4.0}));
}

TEST_CASE("a rod of 24 radii is the solid to 2 radii aside") {
    check_same(ratios(24.0, {0.3, 1.0, 2.0}));
}

TEST_CASE("a rod of 16 radii is the solid while little is bent, one of 10 never is") {
    check_same(ratios(16.0, {0.3}));
    // Kirchhoff's rods do not shear: 48 E I/(kappa G A L^2) = 38.7 (r/L)^2 of the bending is
    // missing, less what held ends, which cannot warp, take from it
    const Ratio r = ratios(10.0, {0.3}).front();
    CHECK(r.force > 1.1);
    CHECK(r.force < 1.387);
}
