// tests/bake/block_contact_test.cpp
// Contact with baked blocks, as tools feel it: TetGen's uneven tetrahedra, uniform and graded,
// against the same tissue (see tests/tissue/block_contact_test.cpp for structured ones). Suite
// `slow`: the larger meshes.
#include "assets/bake/bake.h"
#include "tests/tissue/pressed_block.h"
#include "tissue/response/footprint.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace {

constexpr int kNormal = 2, kTangent = 0;
constexpr double kTips_m[] = {1.5e-3, 2.5e-3, 5e-3};

tissue::BakedOrgan baked_organ(const std::string& name) {
    const std::string file = name + ".toml";
    std::ifstream in(std::filesystem::path(ORGAN_RECIPES) / file, std::ios::binary);
    REQUIRE(in);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    tissue::BakedOrgan organ = bake::bake(bake::parse_recipe(text, file), {}).organ;
    REQUIRE(organ.material.young_pa == block::kYoung_pa);
    REQUIRE(organ.material.poisson == block::kPoisson);
    return organ;
}

block::PressedBlock baked_block(const std::string& name) {
    const tissue::BakedOrgan organ = baked_organ(name);
    const auto& s = organ.surface;
    CHECK(*std::min_element(s.mesh_term_n_m.begin(), s.mesh_term_n_m.end()) >= 0.0);
    CHECK(*std::min_element(s.mesh_term_t_m.begin(), s.mesh_term_t_m.end()) >= 0.0);
    return {organ.mesh, organ.anchored, organ.surface};
}

// The same tetrahedra with quadratic shapes, and no mesh term.
block::PressedBlock quadratic_block(const std::string& name) {
    tissue::BakedOrgan organ = baked_organ(name);
    tissue::make_footprints(organ.mesh, organ.anchored,
                            {.order = 2, .tip_radius_max_m = organ.tip_radius_max_m},
                            organ.surface);
    return {organ.mesh, organ.anchored, organ.surface, 2};
}

// Stiffness over that of the tissue, its scatter, and a slide, for every tip.
void check_block(const block::PressedBlock& pressed) {
    for (const double a_m : kTips_m) {
        CAPTURE(a_m);
        for (const int axis : {kNormal, kTangent}) {
            CAPTURE(axis);
            const block::Spread s = block::spread(pressed, axis, a_m);
            CHECK(std::abs(s.mean - 1.0) < (axis == kNormal ? 0.03 : 0.05));
            CHECK(s.deviation < 0.02);
            CHECK(s.low > 0.93);
            CHECK(s.high < 1.10);
            CHECK(block::worst_slide_step(pressed, axis, a_m) < 0.01);
        }
        const auto law = tissue::make_sphere_law(a_m, block::kYoung_pa, block::kPoisson, 10, 257);
        CHECK(block::worst_force_step_n(pressed, 4e-3, law, a_m) < 1e-3);
    }
}

// The same for quadratic shapes; `deviation`: allowed scatter.
void check_quadratic_block(const block::PressedBlock& pressed, double deviation) {
    for (const double a_m : kTips_m) {
        CAPTURE(a_m);
        const block::Spread normal = block::spread(pressed, kNormal, a_m);
        CHECK(std::abs(normal.mean - 1.0) < 0.07);
        CHECK(normal.deviation < deviation);
        CHECK(std::abs(block::spread(pressed, kTangent, a_m).mean - 1.0) < 0.08);
        CHECK(block::worst_slide_step(pressed, kNormal, a_m) < 0.01);
        CHECK(block::worst_slide_step(pressed, kTangent, a_m) < 0.01);
        const auto law = tissue::make_sphere_law(a_m, block::kYoung_pa, block::kPoisson, 10, 257);
        CHECK(block::worst_force_step_n(pressed, 4e-3, law, a_m) < 1e-3);
    }
}

// The force of a sphere of 5 mm at 1, 4 and 8 mm (hexahedra, series law).
void check_sphere(const block::PressedBlock& pressed) {
    const auto law = tissue::make_sphere_law(5e-3, block::kYoung_pa, block::kPoisson, 10, 257);
    const double depth_m[] = {1e-3, 4e-3, 8e-3}, truth_n[] = {23.0e-3, 179.5e-3, 473.0e-3};
    for (int i = 0; i < 3; ++i)
        CHECK(std::abs(pressed.force_n(40e-3, 40e-3, depth_m[i], law, 5e-3) / truth_n[i] - 1.0) <
              0.03);
}

} // namespace

TEST_CASE("baked block: tets of 12 mm answer as the tissue does") {
    const auto pressed = baked_block("block_u12");
    check_block(pressed);
    check_sphere(pressed);
}

TEST_CASE("baked block: quadratic tets of 12 mm answer as the tissue does without a mesh term") {
    const auto pressed = quadratic_block("block_u12");
    check_quadratic_block(pressed, 0.02);
    check_sphere(pressed);
}

TEST_SUITE_BEGIN("slow");

TEST_CASE("baked block: quadratic tets of 8 mm answer as the tissue does without a mesh term") {
    check_quadratic_block(quadratic_block("block_u8"), 0.02);
}

TEST_CASE("baked block: graded quadratic tets answer as the tissue does without a mesh term") {
    const auto pressed = quadratic_block("block_g12");
    check_quadratic_block(pressed, 0.035); // 3.1 % for a tip as large as two of the small tets
    check_sphere(pressed);
}

TEST_CASE("baked block: tets of 8 mm answer as the tissue does") {
    const auto pressed = baked_block("block_u8");
    check_block(pressed);
    check_sphere(pressed);
}

TEST_CASE("baked block: graded tets answer as the tissue does, thanks to the mesh term") {
    const auto pressed = baked_block("block_g12");
    check_block(pressed);
    check_sphere(pressed);
    // negative control: on graded tets the linear elements' debt shows most
    CHECK(block::spread(pressed, kNormal, 5e-3, {.mesh_term = false}).mean > 1.15);
}

TEST_SUITE_END();
