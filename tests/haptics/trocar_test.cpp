#include "haptics/device/trocar.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <random>

namespace {

using haptics::shaft_pose;
using haptics::ShaftPose;
using haptics::Trocar;

const Trocar kTrocar{.fulcrum_m = {0.02, -0.01, 0.3}};

glm::dvec3 random_direction(std::mt19937& rng) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3{normal(rng), normal(rng), normal(rng)});
}

// Handle at a distance outside the fulcrum.
glm::dvec3 handle_at(double outside_m, const glm::dvec3& direction) {
    return kTrocar.fulcrum_m + outside_m * direction;
}

// Fourth-order central difference of the tip along v: error below 1e-10 at 0.1 mm.
glm::dvec3 tip_velocity(const glm::dvec3& handle_m, const glm::dvec3& v) {
    const double h = 1e-4;
    const auto tip = [&](double s) { return shaft_pose(kTrocar, handle_m + s * v).tip_m; };
    return (8.0 * (tip(h) - tip(-h)) - (tip(2 * h) - tip(-2 * h))) / (12.0 * h);
}

} // namespace

TEST_CASE("trocar: the shaft runs from the handle through the fulcrum to the tip") {
    const glm::dvec3 handle_m = handle_at(0.15, glm::normalize(glm::dvec3{0.3, -0.2, 1.0}));
    const ShaftPose pose = shaft_pose(kTrocar, handle_m);
    CHECK(glm::length(pose.tip_m - handle_m) == doctest::Approx(kTrocar.shaft_m).scale(0.0));
    CHECK(pose.insertion_m == doctest::Approx(0.33 - 0.15).scale(0.0));
    CHECK(glm::length(glm::cross(kTrocar.fulcrum_m - handle_m, pose.tip_m - handle_m)) < 1e-15);
    CHECK(glm::dot(pose.direction, kTrocar.fulcrum_m - handle_m) > 0.0);
}

TEST_CASE("trocar: to the left outside is to the right inside, by the lever") {
    const ShaftPose pose = shaft_pose(kTrocar, handle_at(0.11, {0, 0, 1})); // 220 mm inside
    const glm::dvec3 tip_motion = pose.jacobian * glm::dvec3{1, 0, 0};
    CHECK(tip_motion.x == doctest::Approx(-2.0).scale(0.0));
    const glm::dvec3 pushed_in = pose.jacobian * glm::dvec3{0, 0, -1};
    CHECK(pushed_in.z == doctest::Approx(-1.0).scale(0.0));
    // a force to the right on the tip pushes the handle to the left, twice as hard
    CHECK(haptics::force_at_handle(pose, {1, 0, 0}).x == doctest::Approx(-2.0).scale(0.0));
}

TEST_CASE("trocar: the jacobian is the derivative of the tip, clamped or not") {
    std::mt19937 rng(1);
    // free, and pulled out until the insertion is clamped
    for (const double outside_m : {0.04, 0.15, 0.3, 0.32, 0.5})
        for (int trial = 0; trial < 50; ++trial) {
            const glm::dvec3 handle_m = handle_at(outside_m, random_direction(rng));
            const ShaftPose pose = shaft_pose(kTrocar, handle_m);
            const glm::dvec3 v = random_direction(rng);
            CHECK(glm::length(pose.jacobian * v - tip_velocity(handle_m, v)) < 1e-9);
        }
}

TEST_CASE("trocar: no power is made or lost between tip and handle") {
    std::mt19937 rng(2);
    for (const double outside_m : {0.05, 0.2, 0.4})
        for (int trial = 0; trial < 50; ++trial) {
            const glm::dvec3 handle_m = handle_at(outside_m, random_direction(rng));
            const glm::dvec3 v = random_direction(rng);
            const glm::dvec3 F = 2.0 * random_direction(rng);
            const ShaftPose pose = shaft_pose(kTrocar, handle_m);
            const double at_tip_w = glm::dot(F, tip_velocity(handle_m, v));
            const double at_handle_w = glm::dot(haptics::force_at_handle(pose, F), v);
            CHECK(std::abs(at_tip_w - at_handle_w) < 1e-9);
        }
}

TEST_CASE("trocar: the handle found for a tip puts the tip there") {
    std::mt19937 rng(3);
    for (const double inside_m : {0.021, 0.1, 0.29}) {
        const glm::dvec3 tip_m = kTrocar.fulcrum_m + inside_m * random_direction(rng);
        const glm::dvec3 handle_m = haptics::handle_for_tip(kTrocar, tip_m);
        CHECK(glm::length(shaft_pose(kTrocar, handle_m).tip_m - tip_m) < 1e-15);
    }
    // out of reach: as far as the shaft goes, in that direction
    const glm::dvec3 far_m = kTrocar.fulcrum_m + glm::dvec3{0, 0, -5.0};
    const ShaftPose pose = shaft_pose(kTrocar, haptics::handle_for_tip(kTrocar, far_m));
    CHECK(pose.insertion_m == doctest::Approx(0.30).scale(0.0));
    CHECK(pose.direction.z == doctest::Approx(-1.0).scale(0.0));
}

TEST_CASE("trocar: insertion stays between its limits") {
    CHECK(shaft_pose(kTrocar, handle_at(0.5, {0, 0, 1})).insertion_m ==
          doctest::Approx(0.020).scale(0.0));
    CHECK(shaft_pose(kTrocar, handle_at(0.001, {0, 0, 1})).insertion_m ==
          doctest::Approx(0.30).scale(0.0));
}

TEST_CASE("trocar: any handle, also an absurd one, gives a finite pose and a bounded lever") {
    std::mt19937 rng(4);
    std::uniform_real_distribution<double> exponent(-320.0, 320.0);
    const double most = 0.30 / 0.03; // longest insertion over shortest outside
    for (int trial = 0; trial < 2000; ++trial) {
        glm::dvec3 handle_m = random_direction(rng) * std::pow(10.0, exponent(rng));
        if (trial % 3 == 0)
            handle_m = kTrocar.fulcrum_m + handle_m;
        if (trial % 50 == 0)
            handle_m.y = std::nan("");
        const ShaftPose pose = shaft_pose(kTrocar, handle_m);
        REQUIRE(glm::length(pose.direction) == doctest::Approx(1.0).scale(0.0));
        REQUIRE(glm::length(pose.tip_m - kTrocar.fulcrum_m) <= 0.30 + 1e-12);
        REQUIRE(glm::length(haptics::force_at_handle(pose, {1, 0, 0})) <= most + 1e-9);
        REQUIRE(std::isfinite(glm::length(haptics::handle_for_tip(kTrocar, handle_m))));
    }
    CHECK(shaft_pose(kTrocar, kTrocar.fulcrum_m).direction == glm::dvec3{0, 0, -1});
}
