// tests/sim/organ_study_test.cpp
// Stiffness belongs to the tissue, not to the mesh: one liver in two meshes, pressed at the same
// places, its thin margin and its held parts included.
#include "sim/study/organ_study.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <stdexcept>

namespace {

sim::OrganStudyOptions two_livers(std::uint64_t seed) {
    sim::OrganStudyOptions options;
    options.organ = "liver";
    options.other = "liver_graded";
    options.seed = seed;
    return options;
}

} // namespace

TEST_CASE("organ: uniform and graded tets answer within 10 % at every place and along a slide") {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        CAPTURE(seed);
        const auto study = sim::run_organ_study(two_livers(seed));
        REQUIRE(study.point.size() == 50);
        REQUIRE(study.other_nodes > study.nodes + 100);
        CHECK(study.ratio_min > 0.90);
        CHECK(study.ratio_max < 1.10);
        CHECK(study.slide_step_percent < 1.0);
    }
}

TEST_CASE("organ: the kernel without what the mesh owes would feel the mesh") {
    // negative control: mesh compliance alone, at the same places
    const auto study = sim::run_organ_study(two_livers(1));
    double least = 1e9, most = 0.0;
    for (std::size_t i = 0; i < study.point.size(); ++i) {
        const double ratio = study.point[i].mesh_mpn / study.other_point[i].mesh_mpn;
        least = std::min(least, ratio);
        most = std::max(most, ratio);
    }
    CHECK(most / least > 1.25);
}

TEST_CASE("organ: held on a side instead, both meshes are, alike, and it is felt") {
    auto options = two_livers(4);
    options.points = 40;
    const auto baked = sim::run_organ_study(options);
    for (const glm::dvec3& toward : {glm::dvec3{0.0, 0.0, -1.0}, glm::dvec3{1.0, 0.0, 0.0}}) {
        options.hold.toward = toward;
        const auto held = sim::run_organ_study(options);
        CHECK(held.ratio_min > 0.95);
        CHECK(held.ratio_max < 1.05);
        double most = 0.0; // of the change that holding it otherwise makes
        for (std::size_t i = 0; i < held.point.size(); ++i)
            most = std::max(most,
                            std::abs(held.point[i].force_n[0] / baked.point[i].force_n[0] - 1.0));
        CHECK(most > 0.01);
    }
    options.hold.share = 1.5;
    CHECK_THROWS_AS(sim::run_organ_study(options), std::invalid_argument);
}

TEST_CASE("organ: no place on free skin lies against what holds the liver") {
    const auto organ = sim::load_organ("liver");
    const sim::Indenter liver(organ, organ->material, 1.5e-3);
    const auto all = sim::random_places(liver.body(), 300, 1),
               free = sim::random_places(liver.body(), 300, 1, sim::PressedSkin::free);
    REQUIRE(free.size() == 300);
    const auto bare = [](const glm::dvec3& x) { // the recipe's box, against the diaphragm
        return x.x > -62e-3 && x.x < 22e-3 && x.y > 20e-3 && x.z < -20e-3;
    };
    CHECK(std::ranges::count_if(all, bare) > 10);
    CHECK(std::ranges::count_if(free, bare) == 0);
    // of the rest most is free, and what is free is pressed in the same order
    std::size_t next = 0;
    for (const glm::dvec3& place : all)
        next += next < free.size() && place == free[next];
    CHECK(next > 150);
}
