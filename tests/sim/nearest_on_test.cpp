// tests/sim/nearest_on_test.cpp
// The nearest point of a skin against all its triangles, one by one, by another formula.
#include "sim/bridge/body.h"

#include "sim/session/scene.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>

namespace {

// To a triangle: straight down if the foot is inside, else to the nearest edge.
double distance_m(const std::array<glm::dvec3, 3>& p, const glm::dvec3& from) {
    const glm::dvec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
    bool inside = true;
    double nearest = 1e9;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 a = p[k], edge = p[(k + 1) % 3] - a;
        inside = inside && glm::dot(glm::cross(edge, from - a), n) >= 0.0;
        const double at = std::clamp(glm::dot(edge, from - a) / glm::dot(edge, edge), 0.0, 1.0);
        nearest = std::min(nearest, glm::distance(a + at * edge, from));
    }
    return inside ? std::abs(glm::dot(n, from - p[0])) / glm::length(n) : nearest;
}

double brute_m(const sim::Body& body, const glm::dvec3& from) {
    double nearest = 1e9;
    for (const tissue::Triangle& t : body.organ->surface.triangles)
        nearest = std::min(
            nearest, distance_m({body.skin_m[t[0]], body.skin_m[t[1]], body.skin_m[t[2]]}, from));
    return nearest;
}

// At random places of the skin, this far above or below it.
void check_near(const sim::Body& body, double most_m, std::uint32_t seed) {
    std::mt19937 rng(seed);
    std::uniform_int_distribution<std::size_t> vertex(0, body.skin_m.size() - 1);
    std::uniform_real_distribution<double> aside(-most_m, most_m);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 from =
            body.skin_m[vertex(rng)] + glm::dvec3{aside(rng), aside(rng), aside(rng)};
        const sim::Foot foot = sim::nearest_on(body, from);
        const double nearest_m = brute_m(body, from);
        REQUIRE(std::abs(foot.distance_m - nearest_m) < 1e-12);
        for (const double within_m : {1.001 * nearest_m, 0.999 * nearest_m, 0.5 * nearest_m}) {
            const sim::Foot bounded = sim::nearest_on(body, from, within_m);
            REQUIRE((within_m > nearest_m ? bounded.distance_m == foot.distance_m
                                          : bounded.distance_m > within_m));
        }
        REQUIRE(std::abs(glm::distance(sim::place_on(body, foot.at), from) - foot.distance_m) <
                1e-12);
    }
}

void check_body(sim::Body& body, std::uint32_t seed) {
    CAPTURE(body.organ->name);
    for (const double most_m : {1e-3, 6e-3, 60e-3})
        check_near(body, most_m, seed);
    for (glm::dvec3& v : body.skin_m) // waves that stretch no edge by more than a third
        v += 5e-3 * glm::dvec3{std::sin(40.0 * v.y), std::sin(50.0 * v.z), std::sin(60.0 * v.x)};
    for (const double most_m : {1e-3, 6e-3, 60e-3})
        check_near(body, most_m, seed + 1);
}

} // namespace

TEST_CASE("nearest_on: on flap, vessels, liver and wall it is the nearest of all triangles") {
    std::uint32_t seed = 1;
    for (const char* scene : {"flap", "basic"}) {
        sim::TissueRig rig = sim::make_tissue(sim::load_scene(scene), {}, {});
        for (sim::Body& body : rig.bodies)
            check_body(body, ++seed);
    }
}

TEST_CASE("nearest_on: a place that is not a number still gives a point of the skin") {
    const sim::TissueRig rig = sim::make_tissue(sim::load_scene("basic"), {}, {});
    for (const double bad : {std::nan(""), HUGE_VAL}) {
        const sim::Foot foot = sim::nearest_on(rig.bodies[0], {bad, 0.0, 0.0});
        CHECK(foot.at.triangle >= 0);
        CHECK(foot.at.weight.x + foot.at.weight.y + foot.at.weight.z == 1.0);
    }
}
