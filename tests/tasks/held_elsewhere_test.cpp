// tests/tasks/held_elsewhere_test.cpp
// Scripted hands beside a person: what he holds they follow, and go on from where he leaves it.
#include "attempt.h"
#include "tasks/exercise/find_tubes.h"
#include "tasks/hand/camera_hand.h"
#include "tasks/hand/find_hand.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace tasks;
using namespace tasks::testing;

namespace {

constexpr auto kLeft = static_cast<std::size_t>(Role::left);
constexpr auto kRight = static_cast<std::size_t>(Role::right);

/// Two tubes for the right tool under what the left one lifts.
Exercise two_tubes() {
    Exercise exercise;
    exercise.kind = ExerciseKind::find_tubes;
    exercise.target = {{"1", Role::right, {-0.02, 0.0, 0.0}}, {"2", Role::right, {0.02, 0.0, 0.0}}};
    exercise.lift = Lift{};
    exercise.lift->at_m = {0.0, -0.03, 0.01};
    exercise.lift->to_m = {0.0, -0.03, 0.05};
    return exercise;
}

HandSight first_sight(const Exercise& exercise) {
    HandSight sight;
    sight.now = at_rest(exercise);
    sight.now.target[2].position_m = exercise.lift->at_m;
    sight.now.targets = 3;
    return sight;
}

/// Held up by the left tool, which stays.
void lift_it(HandSight& sight, const Exercise& exercise) {
    sight.now.target[2].position_m = exercise.lift->to_m;
    sight.now.tool[kLeft].tip_m = exercise.lift->to_m;
    sight.now.tool[kLeft].grasping = true;
    sight.now.tool[kLeft].jaw = 1.0;
}

FindHand assistant(const Exercise& exercise) {
    return {without_errors(skill_named("expert")), exercise, 1, {kFar, kFar, kFar}};
}

/// Every tool that nobody else holds is where its hand wants it, after each of n milliseconds.
HandGoals follow(FindHand& hand, HandSight& sight, int n) {
    HandGoals goals;
    for (int i = 0; i < n; ++i) {
        goals = hand.tick(sight);
        ++sight.tick;
        for (std::size_t t = 0; t < kTools; ++t)
            if (!sight.held[t])
                sight.now.tool[t].tip_m = goals.tip_m[t];
    }
    return goals;
}

} // namespace

TEST_CASE("A tool given back to the scripted hand goes on from where it is, jaws as they are") {
    const Exercise exercise = two_tubes();
    FindHand hand = assistant(exercise);
    HandSight sight = first_sight(exercise);
    sight.held[kLeft] = true;
    for (int i = 0; i < 3000; ++i) { // a person carries it about, with closed jaws
        sight.now.tool[kLeft].tip_m = kFar + glm::dvec3{1e-5 * i, 0.0, 0.0};
        sight.now.tool[kLeft].jaw = 1.0;
        follow(hand, sight, 1);
    }
    sight.held[kLeft] = false;
    const glm::dvec3 left_m = sight.now.tool[kLeft].tip_m;
    const HandGoals goals = hand.tick(sight);
    CHECK(goals.tip_m[kLeft] == left_m);
    CHECK(goals.jaw[kLeft] == 1.0);
    CHECK(glm::distance(follow(hand, sight, 3000).tip_m[kLeft], left_m) > 0.02); // goes to lift
}

TEST_CASE("What the person holds is his job: nothing else moves until it is done") {
    const Exercise exercise = two_tubes();
    FindHand hand = assistant(exercise);
    HandSight sight = first_sight(exercise);
    sight.held[kLeft] = true;
    CHECK(follow(hand, sight, 5000).tip_m[kRight] == kFar);
    lift_it(sight, exercise);
    CHECK(glm::distance(follow(hand, sight, 5000).tip_m[kRight], kFar) > 0.02);
}

TEST_CASE("A hand beside a person's endoscope points only at what he shows") {
    const Exercise exercise = two_tubes();
    FindHand hand = assistant(exercise);
    HandSight sight = first_sight(exercise);
    lift_it(sight, exercise);
    sight.held[kLeft] = sight.scope_held = true;
    sight.now.view.eye_m = sight.now.target[1].position_m + glm::dvec3{0.0, 0.0, 0.06};
    const auto away_m = [&](std::size_t tube) {
        const glm::dvec3 tip_m = follow(hand, sight, 6000).tip_m[kRight];
        return glm::distance(tip_m, sight.now.target[tube].position_m);
    };
    CHECK(away_m(1) > 2.0 * exercise.radius_m); // hidden: waits above it
    sight.now.target[1].clear_rays = kSightRays;
    REQUIRE(tube_seen(exercise, sight.now, 1));
    CHECK(away_m(1) <= exercise.radius_m);
}

TEST_CASE("An endoscope given back is held as it was, then brought back to the work") {
    const Exercise exercise = two_tubes();
    const ScopeGoal start{.given = true, .look_at_m = {0.0, 0.0, 0.0}, .distance_m = 0.15};
    CameraHand hand(without_errors(skill_named("expert")), exercise, 1, start);
    HandSight sight = first_sight(exercise);
    sight.scope_held = true;
    sight.now.view = {.eye_m = {0.03, 0.02, 0.1},
                      .forward = glm::normalize(glm::dvec3{0.5, 0.3, -1.0})};
    sight.now.horizon_rad = 0.4;
    for (int i = 0; i < 2000; ++i)
        hand.tick(sight);
    sight.scope_held = false;
    ScopeGoal goal = hand.tick(sight);
    const glm::dvec3 way = goal.look_at_m - sight.now.view.eye_m;
    CHECK(glm::length(glm::cross(way, sight.now.view.forward)) < 1e-9);
    CHECK(glm::length(way) == doctest::Approx(goal.distance_m).scale(0.0));
    CHECK(goal.near_m == sight.now.view.eye_m);
    CHECK(goal.horizon_rad ==
          doctest::Approx(0.4).scale(0.0).epsilon(1e-3)); // one tick of levelling
    for (int i = 0; i < 20000; ++i)
        goal = hand.tick(sight);
    CHECK(glm::distance(goal.look_at_m, exercise.lift->at_m) < 0.02);
    CHECK(std::abs(goal.horizon_rad) < 0.01);
}
