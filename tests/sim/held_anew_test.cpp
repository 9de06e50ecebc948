// tests/sim/held_anew_test.cpp
// An organ that a scene anchors feels as if it had been baked with those anchors.
#include "sim/study/indent.h"
#include "tests/sim/scene_fixture.h"
#include "tissue/response/mesh_term.h"

#include <algorithm>
#include <glm/geometric.hpp>

using namespace scene_tests;

TEST_CASE("anchor: an organ held anew answers as if it had been baked so, and not otherwise") {
    const sim::LoadedScene scene = sim::load_scene("two_organs");
    const auto held = scene.organ[1];
    REQUIRE(held->name == "spleen");
    const auto baked = tissue::read_organ(sim::read_bytes(sim::organ_path("spleen.organ")));
    tissue::BakedOrgan fresh = *held, stale = *held;
    stale.surface = baked.surface; // negative control: the terms of the old hold
    tissue::make_mesh_terms(fresh.mesh, fresh.material.poisson, fresh.anchored,
                            {.tip_radius_max_m = fresh.tip_radius_max_m}, fresh.surface, fresh.bed);

    const tissue::Material& material = scene.scene.organ[1].material;
    const auto indenter = [&](const tissue::BakedOrgan& organ) {
        return sim::Indenter(std::make_shared<const tissue::BakedOrgan>(organ), material, 3e-3);
    };
    sim::Indenter as_held(held, material, 3e-3), as_fresh = indenter(fresh),
                                                 as_stale = indenter(stale);
    const std::vector<double> depth_m{1e-3, 5e-3, 10e-3};
    double least = 2.0, most = 0.0, stale_least = 2.0;
    for (const glm::dvec3& place : sim::random_places(as_held.body(), 200, 1)) {
        const auto expected = as_fresh.press(place, depth_m).force_n;
        const auto got = as_held.press(place, depth_m).force_n;
        const auto old = as_stale.press(place, depth_m).force_n;
        for (std::size_t d = 0; d < depth_m.size(); ++d) {
            least = std::min(least, got[d] / expected[d]);
            most = std::max(most, got[d] / expected[d]);
            stale_least = std::min(stale_least, old[d] / expected[d]);
        }
    }
    CHECK(least > 0.999);
    CHECK(most < 1.001);
    CHECK(stale_least < 0.85);
}
