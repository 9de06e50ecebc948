#include "tasks/hand/script.h"

#include "relative.h"

#include "toy_tissue.h"

#include <rapidcheck.h>
#include <stdexcept>

using namespace tasks;
using namespace tasks::testing;

namespace {

std::string message(const std::string& text) {
    try {
        parse_script(text, "s.toml");
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

ToyRig performed(const std::string& text, double limit_s) {
    ToyRig rig = make_rig(nine_points());
    ScriptHand hand(parse_script(text, "s.toml"), rig.exercise, rig.start_tip_m);
    perform(rig, hand, limit_s);
    return rig;
}

} // namespace

TEST_CASE("a script touches all targets in order without an error") {
    std::string text;
    const Exercise exercise = nine_points();
    for (const ExerciseTarget& target : exercise.target)
        text += "[[step]]\nverb = \"touch\"\ntool = \"" + std::string(role_name(target.role)) +
                "\"\ntarget = \"" + target.id + "\"\n";
    const ToyRig rig = performed(text, 100.0);
    CHECK(rig.progress.complete);
    for (const Event& event : rig.progress.events)
        CHECK_FALSE(is_error(event.kind));
}

TEST_CASE("move, press, hold, retract and wait do exactly what they say") {
    const char* text = R"(
[[step]]
verb = "move"
tool = "right"
at_mm = [30, 20, 8]
seconds = 1.5
[[step]]
verb = "press"
tool = "right"
target = "1"
force_n = 0.6
[[step]]
verb = "hold"
tool = "right"
seconds = 2
[[step]]
verb = "hold"
tool = "right"
force_n = 0.3
seconds = 3
[[step]]
verb = "retract"
tool = "right"
seconds = 1
[[step]]
verb = "wait"
seconds = 1
)";
    ToyRig rig = make_rig(nine_points());
    ScriptHand hand(parse_script(text, "s.toml"), rig.exercise, rig.start_tip_m);
    perform(rig, hand, 1.6); // move is over, lag of the toy included
    CHECK(rig.now.tool[1].tip_m.x == relative(0.030, 0.01));
    CHECK(rig.now.tool[1].tip_m.y == relative(0.020, 0.01));
    double force_n = 0.0;
    while (force_n < 0.57)
        perform(rig, hand, now_s(rig) + 0.0005), force_n = rig.now.tool[1].force_n.z;
    const double pressed_s = now_s(rig);
    CHECK(pressed_s < 1.5 + 5.0);
    perform(rig, hand, pressed_s + 1.9);
    CHECK(rig.now.tool[1].force_n.z == relative(0.6, 0.03));
    perform(rig, hand, pressed_s + 4.9);
    CHECK(rig.now.tool[1].force_n.z == relative(0.3, 0.05));
    const double before_m = rig.now.tool[1].tip_m.z;
    perform(rig, hand, pressed_s + 6.5);
    // 15 mm of the goal; the grip gives back what 0.3 N had bent it
    CHECK(rig.now.tool[1].tip_m.z - before_m == relative(0.015 - 0.3 / 400.0, 0.05));
    CHECK(rig.now.tool[0].tip_m == rig.start_tip_m[0]);
}

TEST_CASE(
    "grasp closes the jaws of its tool alone, they stay closed while it moves, release opens") {
    const char* text = R"(
[[step]]
verb = "grasp"
tool = "left"
[[step]]
verb = "move"
tool = "left"
at_mm = [0, 0, 30]
seconds = 1
[[step]]
verb = "release"
tool = "left"
seconds = 0.1
)";
    ToyRig rig = make_rig(nine_points());
    ScriptHand hand(parse_script(text, "s.toml"), rig.exercise, rig.start_tip_m);
    double last = 0.0;
    for (int tick = 1; tick <= 1500; ++tick) {
        const HandGoals goals = hand.tick({.tick = tick, .now = rig.now});
        if (tick <= 300)
            CHECK(goals.jaw[0] == relative(tick / 300.0, 1e-9));
        if (tick > 300 && tick <= 1290)
            CHECK(goals.jaw[0] == 1.0);
        CHECK(std::abs(goals.jaw[0] - last) < 0.011); // no jump
        CHECK(goals.jaw[1] == 0.0);
        last = goals.jaw[0];
    }
    CHECK(last == 0.0);
}

TEST_CASE("a press that meets nothing ends with its time and stops within 40 mm") {
    ToyRig rig = make_rig(nine_points());
    rig.start_tip_m[1].z = rig.now.tool[1].tip_m.z = 0.2;
    ScriptHand hand(parse_script("[[step]]\nverb = \"press\"\ntool = \"right\"\nforce_n = 1\n"
                                 "seconds = 10\n",
                                 "s.toml"),
                    rig.exercise, rig.start_tip_m);
    perform(rig, hand, 20.0);
    CHECK(rig.now.tool[1].tip_m.z == relative(0.16, 1e-3));
}

TEST_CASE("a mistake in a script is named by file, line, key, value and what is accepted") {
    CHECK(message("[[step]]\nverb = \"push\"\n") ==
          "s.toml:2: verb = \"push\": one of \"move\", \"touch\", \"press\", \"hold\", "
          "\"retract\", \"wait\", \"grasp\", \"release\", \"slide\", \"look\"");
    CHECK(message("[[step]]\nverb = \"grasp\"\ntool = \"left\"\nforce_n = 1\n") ==
          "s.toml:4: force_n = 1: unknown key; accepted here: tool, verb, seconds");
    CHECK(message("[[step]]\nverb = \"wait\"\n") ==
          "s.toml:1: seconds is missing: a number from 0.001 to 3600");
    CHECK(message("[[step]]\nverb = \"wait\"\nseconds = 1\nforce_n = 2\n") ==
          "s.toml:4: force_n = 2: unknown key; accepted here: verb, seconds");
    CHECK(message("[[step]]\nverb = \"press\"\ntool = \"left\"\nforce_n = 900\n") ==
          "s.toml:4: force_n = 900: a number from 0.01 to 20");
    CHECK(
        message("[[step]]\nverb = \"move\"\ntool = \"left\"\ntarget = \"1\"\nat_mm = [0,0,0]\n") ==
        "s.toml:5: at_mm = [0,0,0]: either at_mm or target, not both");
    CHECK(message("[[step]]\nverb = \"wait\"\nseconds = 1\n[[expect]]\nmetric = \"time\"\n") ==
          "s.toml:4: min is missing: a number from -1e+09 to 1e+09");
    CHECK(message("").starts_with("s.toml:1: step is missing"));
    const Script script =
        parse_script("[[step]]\nverb = \"touch\"\ntool = \"left\"\ntarget = \"99\"\n", "s.toml");
    CHECK_THROWS_WITH_AS(
        ScriptHand(script, nine_points(), {}),
        "s.toml:1: target = \"99\": one of the exercise's 1, 2, 3, 4, 5, 6, 7, 8, 9",
        std::invalid_argument);
}

TEST_CASE("any bytes make a script or an error") {
    const std::string good = "[[step]]\nverb = \"press\"\ntool = \"left\"\nforce_n = 0.5\n"
                             "[[expect]]\nmetric = \"time\"\nmax = 5\n";
    CHECK(rc::check("damaged scripts", [&](std::vector<std::pair<unsigned, char>> changes) {
        std::string text = good;
        for (const auto& [at, byte] : changes)
            text[at % text.size()] = byte;
        message(text);
    }));
}

TEST_CASE("an expectation holds inside its bounds, bounds included, and says what it saw") {
    Metric metric;
    metric.id = "path_length";
    metric.value = 0.5;
    metric.unit = "m";
    const std::span<const Metric> seen(&metric, 1);
    CHECK(check({"path_length", {}, 0.5}, seen).ok);
    CHECK(check({"path_length", 0.5, {}}, seen).ok);
    const ExpectationResult less = check({"path_length", 0.1, 0.4}, seen);
    CHECK_FALSE(less.ok);
    CHECK(less.name == "0.1 <= path_length <= 0.4");
    CHECK(less.message == "path_length was 0.5 m");
    const ExpectationResult absent = check({"ldlj", {}, 0.0}, seen);
    CHECK_FALSE(absent.ok);
    CHECK(absent.message == "no such metric in this attempt; there are: path_length");
}
