// tests/tasks/script_look_test.cpp
// The verb that holds the endoscope in a script: what its step may say, and where it looks when.
#include "tests/tasks/relative.h"
#include "tests/tasks/toy_tissue.h"

#include "tasks/hand/script.h"

#include <numbers>
#include <stdexcept>

using namespace tasks;
using namespace tasks::testing;

namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

std::string look(const std::string& rest) {
    return "[[step]]\nverb = \"look\"\n" + rest + "\n";
}

std::string message(const std::string& text) {
    try {
        parse_script(text, "s.toml");
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

struct Looking {
    ToyRig rig = make_rig(nine_points());
    ScriptHand hand;
    ScopeGoal scope;
    std::int64_t tick = 0;

    explicit Looking(const std::string& text)
        : hand(parse_script(text, "s.toml"), rig.exercise, rig.start_tip_m) {
        for (std::size_t k = 0; k < rig.exercise.target.size(); ++k)
            rig.now.target[k].position_m = rig.exercise.target[k].at_m;
    }
    void go(int ticks) {
        for (int i = 0; i < ticks; ++i)
            scope = hand.tick({.tick = ++tick, .now = rig.now}).scope;
    }
};

bool near(const ScopeGoal& goal, const glm::dvec3& at_m, double distance_m, double horizon_rad) {
    return glm::distance(goal.look_at_m, at_m) < 1e-12 &&
           std::abs(goal.distance_m - distance_m) < 1e-12 &&
           std::abs(goal.horizon_rad - horizon_rad) < 1e-12;
}

} // namespace

TEST_CASE("script look: a mistake is named by file, line, key, value and what is accepted") {
    const std::string keys =
        "unknown key; accepted here: verb, target, at_mm, distance_mm, seconds, horizon_deg";
    CHECK(message(look("at_mm = [0, 0, 0]\ndistance_mm = 100\ntool = \"left\"")) ==
          "s.toml:5: tool = \"left\": " + keys);
    CHECK(message(look("at_mm = [0, 0, 0]\ndistance_mm = 100\nforce_n = 1")) ==
          "s.toml:5: force_n = 1: " + keys);
    CHECK(message(look("at_mm = [0, 0, 0]")) ==
          "s.toml:1: distance_mm is missing: a number from 10 to 500");
    CHECK(message(look("at_mm = [0, 0, 0]\ndistance_mm = 9")) ==
          "s.toml:4: distance_mm = 9: a number from 10 to 500");
    CHECK(message(look("at_mm = [0, 0, 0]\ndistance_mm = 99\nhorizon_deg = 181")) ==
          "s.toml:5: horizon_deg = 181: a number from -180 to 180");
    CHECK(message(look("distance_mm = 100")) ==
          "s.toml:1: at_mm is missing: [x, y, z] in millimetres, each -500 to 500");
    CHECK(message(look("at_mm = [0, 0, 0]\ntarget = \"1\"\ndistance_mm = 100")) ==
          "s.toml:3: at_mm = [0,0,0]: either at_mm or target, not both");
    CHECK(message(look("target = \"1\"\ndistance_mm = 100\nseconds = 0")) ==
          "s.toml:5: seconds = 0: a number from 0.001 to 3600");
    CHECK(message(look("target = \"1\"\ndistance_mm = 100\nseconds = 2\nhorizon_deg = -20")) ==
          "accepted");
    CHECK_THROWS_WITH_AS(
        Looking(look("target = \"99\"\ndistance_mm = 100")),
        "s.toml:1: target = \"99\": one of the exercise's 1, 2, 3, 4, 5, 6, 7, 8, 9",
        std::invalid_argument);
}

TEST_CASE("script look: the first look is there at once, the next goes over evenly, and it stays") {
    Looking looking(look("at_mm = [10, 20, 30]\ndistance_mm = 200\nseconds = 0.5") +
                    look("at_mm = [50, -20, 0]\ndistance_mm = 80\nhorizon_deg = 40\nseconds = 2"));
    const glm::dvec3 first{0.010, 0.020, 0.030}, second{0.050, -0.020, 0.0};
    for (int i = 0; i < 500; ++i) {
        looking.go(1);
        CHECK(looking.scope.given);
        CHECK(near(looking.scope, first, 0.2, 0.0));
    }
    for (int i = 1; i <= 2000; ++i) {
        looking.go(1);
        const double share = i / 2000.0;
        CHECK(glm::distance(looking.scope.look_at_m, glm::mix(first, second, share)) < 1e-9);
        CHECK(looking.scope.distance_m == relative(0.2 - 0.12 * share));
        CHECK(std::abs(looking.scope.horizon_rad - 40.0 * kDeg * share) < 1e-9);
    }
    looking.go(3000);
    CHECK(near(looking.scope, second, 0.08, 40.0 * kDeg));
}

TEST_CASE("script look: a second is what it takes if it is not said") {
    Looking looking(look("at_mm = [0, 0, 0]\ndistance_mm = 100") +
                    look("at_mm = [0, 0, 0]\ndistance_mm = 200"));
    looking.go(1500);
    CHECK(looking.scope.distance_m == relative(0.15, 1e-2));
}

TEST_CASE("script look: a target is looked at where it is now, while the look is on its way") {
    Looking looking(look("target = \"3\"\ndistance_mm = 100\nseconds = 1"));
    looking.go(500);
    looking.rig.now.target[2].position_m.z = 0.02;
    looking.go(500);
    CHECK(near(looking.scope, looking.rig.now.target[2].position_m, 0.1, 0.0));
    looking.rig.now.target[2].position_m.z = 0.04;
    looking.go(500); // over; nobody follows
    CHECK(looking.scope.look_at_m.z == relative(0.02));
}

TEST_CASE("script look: nobody holds the endoscope before the first one, then it is held while the "
          "tools work") {
    Looking looking("[[step]]\nverb = \"wait\"\nseconds = 0.1\n" +
                    look("at_mm = [0, 0, 0]\ndistance_mm = 100\nseconds = 0.1") +
                    "[[step]]\nverb = \"move\"\ntool = \"left\"\nat_mm = [0, 0, 30]\n"
                    "seconds = 1\n");
    looking.go(100);
    CHECK_FALSE(looking.scope.given);
    looking.go(700);
    CHECK(looking.scope.given);
    CHECK(near(looking.scope, glm::dvec3{0.0}, 0.1, 0.0));
}

TEST_CASE("script look: a script holds the endoscope if any of its steps looks") {
    const std::string wait = "[[step]]\nverb = \"wait\"\nseconds = 1\n";
    CHECK_FALSE(holds_scope(parse_script(wait, "s.toml")));
    CHECK(holds_scope(
        parse_script(wait + look("at_mm = [0, 0, 0]\ndistance_mm = 100") + wait, "s.toml")));
}
