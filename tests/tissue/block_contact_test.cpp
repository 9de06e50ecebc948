// tests/tissue/block_contact_test.cpp
// Contact with a coarse block as tools feel it: stiffness belongs to the tissue, not to the mesh.
// Block 80 x 80 x 40 mm, E 6 kPa, nu 0.45, bottom clamped. The skin is 4 mm over tets of 8 to
// 13 mm; a contact point mixes the rows of three skin vertices.
#include "tests/tissue/pressed_block.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

namespace {

constexpr int kNormal = 2, kTangent = 0;
constexpr double kTips_m[] = {1.5e-3, 2.5e-3, 5e-3};
constexpr double kMiddle_m = 40e-3;

const block::PressedBlock& coarse() {
    static const block::PressedBlock pressed = block::pressed_box({.08, .08, .04}, {7, 7, 3});
    return pressed;
}

const block::PressedBlock& finer() {
    static const block::PressedBlock pressed = block::pressed_box({.08, .08, .04}, {10, 10, 5});
    return pressed;
}

double relative_error(double value, double truth) {
    return std::abs(value - truth) / std::abs(truth);
}

} // namespace

TEST_CASE("block: normal stiffness is the tissue's at every place, for every tip, on both meshes") {
    for (const auto* pressed : {&coarse(), &finer()}) {
        for (const double a_m : kTips_m) {
            CAPTURE(a_m);
            const block::Spread s = block::spread(*pressed, kNormal, a_m);
            CHECK(std::abs(s.mean - 1.0) < 0.03);
            CHECK(s.deviation < 0.02);
            CHECK(s.low > 0.93);
            CHECK(s.high < 1.07);
        }
    }
}

TEST_CASE("block: at the centre a flat tip meets 23.3, 39.8 and 84.5 N/m") {
    // 27-node hexahedra, kernel extrapolated to a point, plus the flat punch
    const double truth_npm[] = {23.3, 39.8, 84.5};
    for (const auto* pressed : {&coarse(), &finer()}) {
        for (int i = 0; i < 3; ++i) {
            const double k = pressed->stiffness_npm(kMiddle_m, kMiddle_m, kNormal, kTips_m[i]);
            CHECK(relative_error(k, truth_npm[i]) < 0.03);
        }
    }
}

TEST_CASE("block: tangential stiffness is the tissue's") {
    for (const auto* pressed : {&coarse(), &finer()}) {
        for (const double a_m : kTips_m) {
            CAPTURE(a_m);
            const block::Spread s = block::spread(*pressed, kTangent, a_m);
            CHECK(std::abs(s.mean - 1.0) < 0.04);
            CHECK(s.deviation < 0.02);
            CHECK(s.low > 0.92);
            CHECK(s.high < 1.08);
        }
    }
}

TEST_CASE("block: a slide does not feel the mesh") {
    for (const double a_m : kTips_m) {
        const auto law = tissue::make_sphere_law(a_m, block::kYoung_pa, block::kPoisson, 10, 257);
        CHECK(block::worst_slide_step(coarse(), kNormal, a_m) < 2e-3);
        CHECK(block::worst_slide_step(coarse(), kTangent, a_m) < 2e-3);
        CHECK(block::worst_force_step_n(coarse(), 4e-3, law, a_m) < 2e-4);
    }
}

TEST_CASE("block: the force of a sphere follows its depth") {
    // series law on the hexahedra above; held by an axisymmetric contact solution to 1 %
    const double depth_mm[] = {.5, 1, 2, 3, 4, 6, 8};
    const double force_mn[3][7] = {{4.3, 11.7, 31.0, 52.9, 75.8, 122.3, 168.9},
                                   {5.6, 15.7, 43.0, 76.0, 112.2, 189.0, 267.8},
                                   {8.1, 23.0, 64.9, 118.1, 179.5, 319.2, 473.0}};
    for (const auto* pressed : {&coarse(), &finer()}) {
        for (int i = 0; i < 3; ++i) {
            const auto law =
                tissue::make_sphere_law(kTips_m[i], block::kYoung_pa, block::kPoisson, 10, 257);
            for (int k = 0; k < 7; ++k) {
                const double force = 1e3 * pressed->force_n(kMiddle_m, kMiddle_m,
                                                            1e-3 * depth_mm[k], law, kTips_m[i]);
                CAPTURE(depth_mm[k]);
                CHECK(relative_error(force, force_mn[i][k]) < 0.03); // first row: two digits
            }
        }
    }
}

TEST_CASE("block: depth grows strictly with force") {
    for (const double a_m : kTips_m) {
        const auto law = tissue::make_sphere_law(a_m, block::kYoung_pa, block::kPoisson, 10, 257);
        double last = 0.0;
        for (int i = 1; i <= 400; ++i) {
            const double force_n = 1e-8 * std::pow(1.05, i); // to 3 N
            const double depth = coarse().depth_m(kMiddle_m, kMiddle_m, force_n, law, a_m);
            CHECK(depth > last);
            last = depth;
        }
    }
}

TEST_CASE("block: a thin bonded layer stiffens as Hayes says, one or two tets thick") {
    // P = 4 G a w kappa / (1-nu), nu 0.45
    struct Fact {
        double ratio, kappa;
    };
    const double shear_pa = block::kYoung_pa / (2.0 * (1.0 + block::kPoisson));
    for (const double thickness_m : {20e-3, 10e-3, 5e-3}) {
        const auto pressed =
            block::pressed_box({.08, .08, thickness_m}, {10, 10, thickness_m > 15e-3 ? 2 : 1});
        for (const auto& [ratio, kappa] :
             {Fact{.2, 1.252}, Fact{.4, 1.599}, Fact{.6, 2.033}, Fact{.8, 2.535}, Fact{1, 3.091}}) {
            const double a_m = ratio * thickness_m;
            if (a_m > 5e-3)
                continue;
            const double truth = 4.0 * shear_pa * a_m * kappa / (1.0 - block::kPoisson);
            CHECK(relative_error(pressed.stiffness_npm(.041, .043, kNormal, a_m), truth) < 0.03);
            // negative control: what a half-space's term would make of it
            if (thickness_m == 5e-3 && ratio > .3)
                CHECK(pressed.stiffness_npm(.041, .043, kNormal, a_m, {.layer = false}) <
                      0.85 * truth);
        }
    }
}

TEST_CASE("block: near a free edge the tissue gives way") {
    // hexahedra of 2 mm, kernel of 1.3175 a cut at the edge, a = 2.5 mm
    const auto pressed = block::pressed_box({.08, .08, .04}, {10, 10, 5}, 2.5e-3);
    struct Fact {
        double from_edge_m, compliance_mpn;
    };
    for (const auto& [s_m, w] : {Fact{5e-3, 34.8e-3}, Fact{9e-3, 29.5e-3}, Fact{20e-3, 26.5e-3}}) {
        CAPTURE(s_m);
        CHECK(relative_error(pressed.compliance_mpn(s_m, kMiddle_m, kNormal, 2.5e-3), w) < 0.10);
    }
}

TEST_CASE("block: what is left out is missed") {
    const double a_m = 2.5e-3;
    // bare points: several times too stiff, and another stiffness at every place
    const auto points = block::pressed_box({.08, .08, .04}, {7, 7, 3}, 5e-3, true);
    const block::Spread bare =
        block::spread(points, kNormal, a_m, {.mesh_term = false, .subgrid = false});
    CHECK(bare.mean > 3.0);
    CHECK(bare.deviation > 0.10);
    // a footprint without the sub-grid term: far too stiff
    const block::Spread even = block::spread(coarse(), kNormal, a_m, {.subgrid = false});
    CHECK(even.mean > 3.0);
    // without the mesh term: too stiff, most for the largest tip
    CHECK(block::spread(finer(), kNormal, 5e-3, {.mesh_term = false}).mean > 1.07);
    CHECK(block::spread(finer(), kTangent, 5e-3, {.mesh_term = false}).mean > 1.10);
}
