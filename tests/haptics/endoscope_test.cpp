// tests/haptics/endoscope_test.cpp
// The endoscope's optics: what it looks along, and how it has to be held to look somewhere.
#include "haptics/device/endoscope.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <numbers>
#include <rapidcheck.h>

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

haptics::Endoscope scope_of(double optic_deg) {
    return {.trocar = {.fulcrum_m = {0.0, -0.13, 0.23}}, .optic_rad = optic_deg * kDegree};
}

haptics::EndoscopePicture picture_for(const haptics::Endoscope& scope,
                                      const haptics::EndoscopeAim& aim) {
    const auto shaft =
        haptics::shaft_pose(scope.trocar, haptics::handle_for_tip(scope.trocar, aim.tip_m));
    return haptics::picture_of(scope, shaft, aim.camera_rad, aim.optic_rad);
}

double number(int low, int high) {
    return 1e-3 * *rc::gen::inRange(1000 * low, 1000 * high);
}

} // namespace

TEST_CASE("an optic of 30 degrees looks 30 degrees aside of its shaft, wherever it is turned") {
    const haptics::Endoscope scope = scope_of(30.0);
    const haptics::ShaftPose shaft{
        .tip_m = {0, -0.07, 0.19}, .direction = {0, 0.6, -0.8}, .insertion_m = 0.07};
    for (int turn = -180; turn <= 180; turn += 15) {
        for (int camera = -90; camera <= 90; camera += 30) {
            const auto picture =
                haptics::picture_of(scope, shaft, camera * kDegree, turn * kDegree);
            CHECK(glm::dot(picture.forward, shaft.direction) ==
                  doctest::Approx(std::cos(30.0 * kDegree)).scale(0.0));
            CHECK(std::abs(glm::dot(picture.forward, picture.up)) < 1e-12);
            CHECK(glm::length(picture.up) == doctest::Approx(1.0).scale(0.0));
        }
    }
    // turned to the camera head's up it looks up in the picture, the other way round it looks down
    const auto up = haptics::picture_of(scope, shaft, 0.0, 0.0);
    const auto down = haptics::picture_of(scope, shaft, 0.0, std::numbers::pi);
    CHECK(up.forward.y > shaft.direction.y);
    CHECK(down.forward.y < shaft.direction.y);
    CHECK(std::abs(up.forward.x) < 1e-15);
}

TEST_CASE("turning the camera head alone turns the picture and what it looks at; the optic turned "
          "back by as much keeps the look") {
    const haptics::Endoscope scope = scope_of(30.0);
    const haptics::ShaftPose shaft{.direction = {0, 0, -1}};
    const auto level = haptics::picture_of(scope, shaft, 0.0, 0.3);
    const auto rolled = haptics::picture_of(scope, shaft, 0.2, 0.1);
    CHECK(glm::distance(level.forward, rolled.forward) < 1e-12);
    CHECK(haptics::horizon_rad(level, scope.up) != haptics::horizon_rad(rolled, scope.up));
    const auto straight = scope_of(0.0); // without obliqueness the horizon is the camera's turn
    const auto picture = haptics::picture_of(straight, shaft, 0.2, 1.0);
    CHECK(haptics::horizon_rad(picture, straight.up) == doctest::Approx(0.2).scale(0.0));
}

TEST_CASE("aimed at any place in the abdomen, the scope looks straight at it, from that far and "
          "with that horizon") {
    CHECK(rc::check("aim", [] {
        const haptics::Endoscope scope = scope_of(number(0, 60));
        const glm::dvec3 place{1e-3 * number(-60, 60), 1e-3 * number(-50, 50),
                               1e-3 * number(-40, 40)};
        const double distance_m = 1e-3 * number(60, 120);
        const double horizon = kDegree * number(-40, 40);
        const auto aim = haptics::aim_at(scope, place, distance_m, {0.0, -0.075, 0.19}, horizon);
        const auto picture = picture_for(scope, aim);
        const glm::dvec3 way = place - picture.eye_m;
        RC_ASSERT(glm::distance(picture.eye_m, aim.tip_m) < 1e-9);
        RC_ASSERT(std::abs(glm::length(way) - distance_m) < 1e-9);
        RC_ASSERT(glm::distance(glm::normalize(way), picture.forward) < 1e-6);
        RC_ASSERT(std::abs(haptics::horizon_rad(picture, scope.up) - horizon) < 1e-6);
    }));
}

TEST_CASE("what is too near or too far for the shaft is looked at from where the shaft can be") {
    const haptics::Endoscope scope = scope_of(30.0);
    const glm::dvec3 near_port = scope.trocar.fulcrum_m + glm::dvec3{0.0, 0.02, -0.06};
    for (const double distance_m : {1e-3, 0.05, 0.5, 10.0}) {
        const auto aim = haptics::aim_at(scope, near_port, distance_m, {0, 0, 0}, 0.0);
        const double inside_m = glm::distance(aim.tip_m, scope.trocar.fulcrum_m);
        CHECK(inside_m >= scope.trocar.min_insertion_m - 1e-12);
        CHECK(inside_m <= scope.trocar.shaft_m);
        const auto picture = picture_for(scope, aim);
        CHECK(glm::dot(glm::normalize(near_port - picture.eye_m), picture.forward) > 1.0 - 1e-6);
    }
}

TEST_CASE("absurd shafts, places and ups give finite pictures") {
    haptics::Endoscope scope = scope_of(30.0);
    for (const glm::dvec3& up : {glm::dvec3{0, 1, 0}, glm::dvec3{0, 0, 1}, glm::dvec3{0, 0, -1}}) {
        scope.up = up;
        const auto picture = haptics::picture_of(scope, {.direction = {0, 0, -1}}, 0.0, 0.0);
        CHECK(std::isfinite(glm::dot(picture.forward, picture.up)));
        CHECK(std::isfinite(haptics::horizon_rad(picture, up)));
        for (const glm::dvec3& place : {scope.trocar.fulcrum_m, glm::dvec3{0, 0, 100.0}}) {
            const auto aim = haptics::aim_at(scope, place, 0.1, place, 0.0);
            CHECK(std::isfinite(aim.tip_m.x + aim.tip_m.y + aim.tip_m.z + aim.camera_rad +
                                aim.optic_rad));
        }
    }
}
