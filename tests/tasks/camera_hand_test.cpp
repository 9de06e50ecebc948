// tests/tasks/camera_hand_test.cpp
// The scripted person at the endoscope: looks where the work is, near when it has to be, and not
// everywhere that something trembles.
#include "tests/tasks/relative.h"
#include "tests/tasks/toy_flap.h"

#include <cmath>
#include <numbers>

using namespace tasks;
using namespace tasks::testing;

namespace {

HandSkill exact() {
    return without_errors(skill_named("expert"));
}

struct Watch {
    ToyFlap rig = make_flap();
    CameraHand camera;
    ScopeGoal goal = start_scope();
    bool moved = false; // in the last go()
    std::uint32_t found = 0;

    explicit Watch(const HandSkill& skill = exact(), std::uint64_t seed = 1)
        : camera(skill, rig.exercise, seed, start_scope()) {}

    void tick() {
        HandSight sight = sight_of(rig);
        sight.found = found;
        const ScopeGoal before = goal;
        goal = camera.tick(sight);
        moved = moved || goal.look_at_m != before.look_at_m || goal.distance_m != before.distance_m;
        ++rig.now.tick;
    }
    void go(double seconds) {
        moved = false;
        for (int i = 0; i < static_cast<int>(seconds / kTick_s); ++i)
            tick();
    }
    void lift() {
        lifted_place_m(rig) = rig.exercise.lift->to_m;
        rig.now.tool[0].tip_m = rig.exercise.lift->to_m;
    }
    // the tool of tube `k` is there
    void point(int k) {
        const auto role =
            static_cast<std::size_t>(rig.exercise.target[static_cast<std::size_t>(k)].role);
        rig.now.tool[role].tip_m = tube(k) + glm::dvec3{0.0, 0.0, 4e-3};
    }
    glm::dvec3& tube(int k) { return rig.now.target[static_cast<std::size_t>(k)].position_m; }
    double picture_height_m() const {
        return 2.0 * goal.distance_m * std::tan(0.5 * rig.now.view.field_of_view_rad);
    }
};

double horizon_rms(const HandSkill& skill) {
    Watch watch(skill);
    double square = 0.0;
    constexpr int kTicks = 1'500'000; // some 200 independent values, 4 s to forget one
    for (int i = 0; i < kTicks; ++i) {
        watch.tick();
        square += watch.goal.horizon_rad * watch.goal.horizon_rad;
    }
    return std::sqrt(square / kTicks);
}

} // namespace

TEST_CASE("camera hand: looks at what has to be lifted, from where it started, and comes near when "
          "that is up and at rest") {
    Watch watch;
    watch.go(8.0);
    CHECK(glm::distance(watch.goal.look_at_m, watch.rig.exercise.lift->at_m) < 1e-9);
    CHECK(watch.goal.distance_m == relative(0.2));
    // less than half-way up is not up
    lifted_place_m(watch.rig) =
        glm::mix(watch.rig.exercise.lift->at_m, watch.rig.exercise.lift->to_m, 0.49);
    watch.go(8.0);
    CHECK(watch.goal.distance_m == relative(0.2));
    watch.lift();
    watch.go(8.0);
    CHECK(glm::distance(watch.goal.look_at_m, watch.tube(0)) < 1e-9);
    // so near that the tool which is to point has room in the picture
    const double far_m = watch.goal.distance_m;
    CHECK(far_m > 0.1);
    watch.point(0);
    watch.go(8.0);
    CHECK(watch.goal.distance_m < far_m);
    // a quarter larger than it has to be
    CHECK(size_in_view({.eye_m = {0.0, 0.0, watch.goal.distance_m},
                        .field_of_view_rad = watch.rig.now.view.field_of_view_rad},
                       glm::dvec3{0.0}, watch.rig.exercise.mark_radius_m) ==
          relative(1.25 * watch.rig.exercise.least_share));
}

TEST_CASE("camera hand: does not come near while the lifting tool still moves") {
    Watch watch;
    watch.lift();
    for (int i = 0; i < 8000; ++i) { // 10 mm/s
        watch.rig.now.tool[0].tip_m.x = 1e-5 * i;
        watch.tick();
    }
    CHECK(watch.goal.distance_m == relative(0.2));
}

TEST_CASE("camera hand: stays while the work is 0.08 of the picture's height off its middle, and "
          "comes straight back to the middle beyond") {
    Watch watch;
    watch.lift();
    watch.go(8.0);
    const glm::dvec3 before_m = watch.goal.look_at_m;
    watch.tube(0) = before_m + glm::dvec3{0.079 * watch.picture_height_m(), 0.0, 0.0};
    watch.go(4.0);
    CHECK_FALSE(watch.moved);
    watch.tube(0) = before_m + glm::dvec3{0.081 * watch.picture_height_m(), 0.0, 0.0};
    watch.go(4.0);
    CHECK(glm::distance(watch.goal.look_at_m, watch.tube(0)) < 1e-9);
}

TEST_CASE("camera hand: does not follow a tremor, nor what was away for an instant") {
    Watch watch;
    watch.lift();
    watch.go(8.0);
    const glm::dvec3 middle_m = watch.tube(0);
    watch.moved = false;
    for (int i = 0; i < 10000; ++i) {
        watch.tube(0) = middle_m;
        watch.tube(0).x += 1e-3 * std::sin(2.0 * std::numbers::pi * 8.0 * i * kTick_s);
        watch.tube(0).y += i % 1000 < 200 ? 0.03 : 0.0; // and gone for 0.2 s of its 0.3 s pause
        watch.tick();
    }
    CHECK_FALSE(watch.moved);
}

TEST_CASE("camera hand: looks at the tube that somebody is about to point at, else at the first "
          "that is not found") {
    Watch watch;
    watch.lift();
    watch.go(8.0);
    CHECK(glm::distance(watch.goal.look_at_m, watch.tube(0)) < 1e-9);
    watch.found = 0b001;
    watch.go(4.0);
    CHECK(glm::distance(watch.goal.look_at_m, watch.tube(1)) < 1e-9);
    watch.rig.now.tool[2].tip_m = watch.tube(2) + glm::dvec3{0.0, 0.0, 0.02};
    watch.go(4.0);
    CHECK(glm::distance(watch.goal.look_at_m, watch.tube(2)) < 1e-9);
    watch.rig.now.tool[2].tip_m = watch.tube(2) + glm::dvec3{0.0, 0.0, 0.03};
    watch.go(4.0);
    CHECK(glm::distance(watch.goal.look_at_m, watch.tube(1)) < 1e-9);
    watch.found = 0b111;
    watch.go(4.0);
    CHECK(glm::distance(watch.goal.look_at_m, watch.tube(2)) < 1e-9); // somewhere sensible
}

TEST_CASE("camera hand: any skill brings the work back to where the exercise wants it") {
    for (const char* name : {"expert", "intermediate", "novice", "fast-careless", "slow-precise"}) {
        CAPTURE(std::string(name));
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
            Watch watch(skill_named(name), seed);
            watch.lift();
            watch.point(0);
            watch.go(12.0);
            View view;
            view.field_of_view_rad = watch.rig.now.view.field_of_view_rad;
            hold_view(view, watch.goal);
            CHECK(off_centre(view, watch.tube(0)) < watch.rig.exercise.centre_share);
            CHECK(size_in_view(view, watch.tube(0), watch.rig.exercise.mark_radius_m) >
                  watch.rig.exercise.least_share);
        }
    }
}

TEST_CASE("camera hand: the horizon strays by the aim of the fingers on a camera head 40 mm wide") {
    for (const char* name : {"expert", "novice"}) {
        const HandSkill skill = skill_named(name);
        // of 200 values: 5 % standard error
        CHECK(horizon_rms(skill) == relative(skill.aim_m / 20e-3, 0.2));
    }
    CHECK(horizon_rms(exact()) == 0.0);
}

TEST_CASE("camera hand: at the other exercises it looks at the next target from where it started") {
    Exercise points = two_points();
    CameraHand camera(exact(), points, 1, start_scope());
    HandSight sight{.now = at_rest(points), .next_target = 1};
    ScopeGoal goal;
    for (int i = 0; i < 5000; ++i)
        goal = camera.tick(sight);
    CHECK(glm::distance(goal.look_at_m, points.target[1].at_m) < 1e-9);
    CHECK(goal.distance_m == relative(0.2));
    sight.next_target = 2; // all are done
    for (int i = 0; i < 5000; ++i)
        goal = camera.tick(sight);
    CHECK(glm::distance(goal.look_at_m, points.target[1].at_m) < 1e-9);
}

TEST_CASE("camera hand: the same seed holds it the same, another seed otherwise") {
    const auto held = [](std::uint64_t seed) {
        Watch watch(skill_named("novice"), seed);
        watch.lift();
        watch.go(5.0);
        return watch.goal;
    };
    CHECK(held(3).look_at_m == held(3).look_at_m);
    CHECK(held(3).horizon_rad == held(3).horizon_rad);
    CHECK(held(3).look_at_m != held(4).look_at_m);
    CHECK(held(3).horizon_rad != held(4).horizon_rad);
}
