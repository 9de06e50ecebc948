// tests/sim/steering_test.cpp
// One mouse at three tools and the endoscope: which is moved, and how.
#include "sim/session/steering.h"

#include "scene_fixture.h"

#include <glm/geometric.hpp>

using namespace sim;

namespace {

constexpr auto kLeft = static_cast<std::size_t>(tasks::Role::left);
constexpr auto kRight = static_cast<std::size_t>(tasks::Role::right);

constexpr double kFrame_s = 1.0 / 60.0;

/// An oblique endoscope over the tools, and what it sees when held as the goals say.
haptics::Endoscope optics() {
    haptics::Endoscope scope;
    scope.trocar.fulcrum_m = {0.0, -0.13, 0.22};
    return scope;
}

ToolsNow now_of(const Steering& s) {
    ToolsNow now;
    now.tick = 1;
    const haptics::Endoscope scope = optics();
    const glm::dvec3 handle = haptics::handle_for_tip(scope.trocar, s.goals.scope_tip_m);
    const haptics::EndoscopePicture picture = haptics::picture_of(
        scope, haptics::shaft_pose(scope.trocar, handle), s.goals.camera_rad, s.goals.optic_rad);
    now.scope.view = {.eye_m = picture.eye_m, .forward = picture.forward, .up = picture.up};
    now.scope.camera_rad = s.goals.camera_rad;
    now.scope.optic_rad = s.goals.optic_rad;
    now.scope.present = true;
    for (std::size_t i = 0; i < kTools; ++i) {
        now.tip[i].centre_m = s.goals.tip_m[i];
        now.jaw[i] = s.goals.jaw[i];
    }
    return now;
}

Steering bench(bool assisted) {
    Steering s;
    for (int i = 0; i < kTools; ++i) {
        s.trocar[i].fulcrum_m = {0.1 * (i - 1), -0.07, 0.16};
        s.goals.tip_m[i] = {0.03 * (i - 1), 0.0, 0.04};
    }
    s.assisted = assisted;
    if (assisted)
        s.goals.held = {false, true, false};
    const haptics::EndoscopeAim aim =
        haptics::aim_at(optics(), {0.0, 0.0, 0.0}, 0.15, {0.0, -0.08, 0.12}, 0.0);
    s.scope = optics().trocar;
    s.goals.scope_tip_m = aim.tip_m;
    s.goals.camera_rad = aim.camera_rad;
    s.goals.optic_rad = aim.optic_rad;
    s.scope_start = glm::normalize(aim.tip_m - s.scope->fulcrum_m);
    return s;
}

view::UserInput tab() {
    view::UserInput input;
    input.switch_tool = true;
    return input;
}

void take_scope(Steering& s) {
    while (s.active != kScopeActive)
        steer(s, tab(), now_of(s), kFrame_s);
}

/// Where a point of the world is in the picture: to the right and up, over its depth.
glm::dvec2 place_in(const tasks::View& view, const glm::dvec3& point_m) {
    const glm::dvec3 to = point_m - view.eye_m;
    const double depth = glm::dot(to, view.forward);
    return {glm::dot(to, glm::cross(view.forward, view.up)) / depth, glm::dot(to, view.up) / depth};
}

} // namespace

TEST_CASE("steering: Tab goes through the tools and the endoscope, and round") {
    Steering s = bench(false);
    std::vector<int> order;
    for (int i = 0; i < 4; ++i) {
        steer(s, tab(), now_of(s), kFrame_s);
        order.push_back(s.active);
        CHECK(s.goals.scope_held == (s.active == kScopeActive));
    }
    CHECK(order == std::vector<int>{2, kScopeActive, 0, 1});
    s.scope.reset(); // a fixed picture
    steer(s, tab(), now_of(s), kFrame_s);
    steer(s, tab(), now_of(s), kFrame_s);
    CHECK(s.active == 0);
}

TEST_CASE("steering: without assistants all tools stay the person's") {
    Steering s = bench(false);
    for (int i = 0; i < 5; ++i) {
        steer(s, tab(), now_of(s), kFrame_s);
        CHECK(s.goals.held == std::array<bool, kTools>{true, true, true});
    }
}

TEST_CASE("steering: what is taken from the assistant starts where it is, as it is") {
    Steering s = bench(true);
    for (int i = 0; i < 7; ++i) {
        ToolsNow now = now_of(s);
        for (int k = 0; k < kTools; ++k) // the assistant has moved them, with closed jaws
            if (!s.goals.held[k]) {
                now.tip[k].centre_m += glm::dvec3{0.01, -0.02, 0.005};
                now.jaw[k] = 1.0;
            }
        now.scope.view.eye_m += glm::dvec3{0.002, 0.003, 0.001};
        now.scope.camera_rad = 0.3;
        now.scope.optic_rad = -0.2;
        steer(s, tab(), now, 0.0);
        for (int k = 0; k < kTools; ++k)
            CHECK(s.goals.held[k] == (k == s.active));
        if (s.active == kScopeActive) {
            CHECK(glm::distance(s.goals.scope_tip_m, now.scope.view.eye_m) < 1e-9);
            CHECK(s.goals.camera_rad == 0.3);
            CHECK(s.goals.optic_rad == -0.2);
        } else {
            CHECK(glm::distance(s.goals.tip_m[s.active], now.tip[s.active].centre_m) < 1e-9);
            CHECK(s.goals.jaw[s.active] == 1.0);
        }
    }
}

TEST_CASE("steering: jaws closed at Tab stay closed until pressed and released there again") {
    for (const bool assisted : {false, true}) {
        Steering s = bench(assisted);
        view::UserInput squeeze, rest;
        squeeze.jaw_closed = true;
        steer(s, squeeze, now_of(s), kFrame_s);
        REQUIRE(s.goals.jaw[kRight] == 1.0);
        view::UserInput go_on = tab();
        go_on.jaw_closed = true; // the button is still down
        steer(s, go_on, now_of(s), kFrame_s);
        CHECK(s.goals.jaw[2] == 0.0); // and means the other tool
        CHECK(s.goals.jaw[kRight] == 1.0);
        steer(s, rest, now_of(s), kFrame_s);
        steer(s, squeeze, now_of(s), kFrame_s);
        CHECK(s.goals.jaw[2] == 1.0);
        steer(s, rest, now_of(s), kFrame_s);
        CHECK(s.goals.jaw[2] == 0.0);
        while (s.active != kFirstTool)
            steer(s, tab(), now_of(s), kFrame_s);
        for (int i = 0; i < 5; ++i)
            steer(s, rest, now_of(s), kFrame_s);
        CHECK(s.goals.jaw[kRight] == 1.0);
        steer(s, squeeze, now_of(s), kFrame_s);
        CHECK(s.goals.jaw[kRight] == 1.0);
        steer(s, rest, now_of(s), kFrame_s);
        CHECK(s.goals.jaw[kRight] == 0.0);
    }
}

TEST_CASE("steering: the view turns the way the pointer goes, so what is seen moves against it") {
    for (const double turn_rad : {0.0, 0.7, -1.2}) { // however the camera head is turned
        Steering s = bench(false);
        take_scope(s);
        s.goals.camera_rad += turn_rad;
        const tasks::View before = now_of(s).scope.view;
        const glm::dvec3 seen_m = before.eye_m + 0.15 * before.forward;
        for (const glm::dvec2 way : {glm::dvec2{20, 0}, {-20, 0}, {0, 20}, {0, -20}}) {
            Steering moved = s;
            view::UserInput input;
            input.mouse_px = way;
            steer(moved, input, now_of(s), kFrame_s);
            const glm::dvec2 shift = place_in(now_of(moved).scope.view, seen_m);
            CHECK(glm::dot(shift, way) < 0.0);
            CHECK(std::abs(shift.x * way.y - shift.y * way.x) <
                  0.3 * std::abs(glm::dot(shift, way)));
            view::UserInput keys;
            keys.move = {way / 20.0, 0.0};
            Steering by_key = s;
            steer(by_key, keys, now_of(s), kFrame_s);
            CHECK(glm::dot(place_in(now_of(by_key).scope.view, seen_m), way) < 0.0);
        }
    }
}

TEST_CASE("steering: the wheel away and Q go in, R T turn the head, Z X the optic, Shift is fine") {
    Steering s = bench(false);
    take_scope(s);
    const auto inside_m = [](const Steering& x) {
        return glm::distance(x.goals.scope_tip_m, x.scope->fulcrum_m);
    };
    const auto after = [&](const view::UserInput& input) {
        Steering x = s;
        steer(x, input, now_of(s), kFrame_s);
        return x;
    };
    view::UserInput wheel, q, head, optic;
    wheel.wheel = 1.0;
    q.move.z = -1.0;
    head.roll = optic.turn_optic = 1.0;
    CHECK(inside_m(after(wheel)) == doctest::Approx(inside_m(s) + 2e-3).scale(0.0));
    CHECK(inside_m(after(q)) > inside_m(s));
    CHECK(after(head).goals.camera_rad > s.goals.camera_rad);
    CHECK(after(head).goals.optic_rad == s.goals.optic_rad);
    CHECK(after(optic).goals.optic_rad > s.goals.optic_rad);
    CHECK(after(optic).goals.camera_rad == s.goals.camera_rad);
    wheel.fine = true;
    CHECK(inside_m(after(wheel)) == doctest::Approx(inside_m(s) + 0.5e-3).scale(0.0));
}

TEST_CASE("steering: the endoscope stays within its shaft and before the work, whatever is done") {
    Steering s = bench(false);
    take_scope(s);
    view::UserInput wild;
    wild.mouse_px = {300.0, -200.0};
    wild.wheel = 5.0;
    for (int i = 0; i < 200; ++i) {
        wild.wheel = i < 100 ? 5.0 : -5.0;
        steer(s, wild, now_of(s), kFrame_s);
        const glm::dvec3 shaft = s.goals.scope_tip_m - s.scope->fulcrum_m;
        CHECK(glm::length(shaft) >= s.scope->min_insertion_m);
        CHECK(glm::length(shaft) <= s.scope->shaft_m - s.scope->min_outside_m);
        CHECK(glm::dot(glm::normalize(shaft), s.scope_start) >= 0.259);
    }
}

TEST_CASE("steering: a tool moves along the picture as the endoscope has it now") {
    Steering s = bench(false);
    take_scope(s);
    s.goals.camera_rad += 0.6;
    while (s.active != static_cast<int>(kLeft))
        steer(s, tab(), now_of(s), kFrame_s);
    const ToolsNow now = now_of(s);
    const glm::dvec3 from_m = s.goals.tip_m[kLeft];
    view::UserInput up;
    up.mouse_px = {0.0, 10.0};
    steer(s, up, now, kFrame_s);
    CHECK(glm::distance(s.goals.tip_m[kLeft], from_m + 10 * 0.15e-3 * now.scope.view.up) < 1e-12);
}
