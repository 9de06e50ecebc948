// tests/tasks/find_tubes_file_test.cpp
// The file of a find-tubes exercise: every key, what holds without it, and every mistake by line.
#include "tasks/exercise/exercise.h"
#include "tests/tasks/relative.h"

#include <fstream>
#include <rapidcheck.h>
#include <sstream>

using tasks::parse_exercise;
using tasks::testing::relative;

namespace {

const std::string kTubes = R"(kind = "find-tubes"
id = "f"
title = "F"
card = "Find."
[[tube]]
id = "artery"
role = "right"
at_mm = [0, 0, 0]
organ = "vessel"
[[tube]]
id = "duct"
role = "assist"
at_mm = [20, 0, 0]
[lift]
role = "left"
at_mm = [0, -30, 6]
to_mm = [0, 30, 60]
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

/// Keys of the exercise itself, on the line before its tubes.
std::string with_keys(const std::string& keys) {
    return replaced(kTubes, "[[tube]]", keys + "\n[[tube]]");
}

std::string message(const std::string& text) {
    try {
        parse_exercise(text, "x.toml");
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

} // namespace

TEST_CASE("find-tubes file: tubes, the lift, and what holds where the file says nothing") {
    const tasks::Exercise exercise = parse_exercise(kTubes, "x.toml");
    CHECK(exercise.kind == tasks::ExerciseKind::find_tubes);
    CHECK(exercise.scope == tasks::ScopeHold::assistant);
    CHECK(exercise.radius_m == relative(5e-3));
    CHECK(exercise.hold_s == 1.0);
    CHECK(exercise.centre_share == 0.15);
    CHECK(exercise.least_share == 0.04);
    CHECK(exercise.mark_radius_m == relative(3e-3));
    CHECK(exercise.point_within_s == 10.0);
    REQUIRE(exercise.target.size() == 2);
    CHECK(exercise.target[0].id == "artery");
    CHECK(exercise.target[0].role == tasks::Role::right);
    CHECK(exercise.target[0].organ == "vessel");
    CHECK(exercise.target[1].role == tasks::Role::assist);
    CHECK(exercise.target[1].at_m.x == relative(20e-3));
    CHECK(exercise.target[1].organ.empty());
    REQUIRE(exercise.lift.has_value());
    CHECK(exercise.lift->role == tasks::Role::left);
    CHECK(exercise.lift->at_m.y == relative(-30e-3));
    CHECK(exercise.lift->to_m.z == relative(60e-3));
    CHECK(exercise.lift->organ.empty());
    CHECK(exercise.lift->radius_m == relative(15e-3));
    CHECK(places_of(exercise) == 3);
    CHECK(std::string(table_of_targets(exercise.kind)) == "tube");
}

TEST_CASE("find-tubes file: every key is read") {
    const std::string text =
        with_keys("radius_m = 0.004\nhold_s = 0.5\nforce_limit_n = 1.25\ntime_limit_s = 100\n"
                  "centre_share = 0.2\nleast_share = 0.05\nmark_radius_mm = 4\n"
                  "point_within_s = 20\nscope = \"mount\"") +
        "organ = \"flap\"\nradius_mm = 12\n[[level]]\nmetric = \"tubes_found\"\ngood = 2\n"
        "pass = 1\n";
    const tasks::Exercise exercise = parse_exercise(text, "x.toml");
    CHECK(exercise.scope == tasks::ScopeHold::mount);
    CHECK(exercise.radius_m == 0.004);
    CHECK(exercise.hold_s == 0.5);
    CHECK(exercise.force_limit_n == 1.25);
    CHECK(exercise.time_limit_s == 100.0);
    CHECK(exercise.centre_share == 0.2);
    CHECK(exercise.least_share == 0.05);
    CHECK(exercise.mark_radius_m == relative(4e-3));
    CHECK(exercise.point_within_s == 20.0);
    CHECK(exercise.lift->organ == "flap");
    CHECK(exercise.lift->radius_m == relative(12e-3));
    REQUIRE(exercise.level.size() == 1);
    CHECK(exercise.level[0].metric == "tubes_found");
    CHECK(parse_exercise(with_keys("scope = \"assistant\""), "x.toml").scope ==
          tasks::ScopeHold::assistant);
}

TEST_CASE("find-tubes file: nothing has to be lifted if it does not say so") {
    const std::string text = kTubes.substr(0, kTubes.find("[lift]"));
    const tasks::Exercise exercise = parse_exercise(text, "x.toml");
    CHECK_FALSE(exercise.lift.has_value());
    CHECK(places_of(exercise) == 2);
}

TEST_CASE("find-tubes file: a limit as gentle as one likes, since there is no band of forces") {
    CHECK(parse_exercise(with_keys("force_limit_n = 0.3"), "x.toml").force_limit_n == 0.3);
}

TEST_CASE("find-tubes file: a number out of its range is named by line, key and value") {
    const std::vector<std::array<std::string, 3>> cases{
        {"centre_share", "0.75", "a number from 0.02 to 0.5"},
        {"centre_share", "nan", "a number from 0.02 to 0.5"},
        {"least_share", "0.75", "a number from 0.005 to 0.5"},
        {"mark_radius_mm", "11", "a number from 0.5 to 10"},
        {"point_within_s", "0.5", "a number from 1 to 600"},
        {"hold_s", "11", "a number from 0.05 to 10"},
        {"radius_m", "5", "a number from 0.0005 to 0.02"},
        {"force_limit_n", "30", "a number from 0.01 to 20"},
        {"time_limit_s", "1", "a number from 5 to 3600"},
        {"scope", "\"nobody\"", "one of \"mount\", \"assistant\""}};
    for (const auto& [key, value, accepted] : cases) {
        std::string expected = "x.toml:5: ";
        expected += key + " = " + value + ": " + accepted;
        CHECK(message(with_keys(key + " = " + value)) == expected);
    }
}

TEST_CASE("find-tubes file: a key that its kind does not have is refused with those that it has") {
    const std::string keys = "unknown key; accepted here: kind, id, title, card, scope, radius_m, "
                             "hold_s, force_limit_n, time_limit_s, centre_share, least_share, "
                             "mark_radius_mm, point_within_s, tube, lift, level";
    for (const char* key : {"force_min_n", "force_max_n", "role", "centre"})
        CHECK(message(with_keys(std::string(key) + " = 1")) ==
              "x.toml:5: " + std::string(key) + " = 1: " + keys);
    CHECK(message(kTubes + "radius_m = 1\n") ==
          "x.toml:18: radius_m = 1: unknown key; accepted here: role, at_mm, organ, to_mm, "
          "radius_mm");
    CHECK(message(replaced(kTubes, "organ = \"vessel\"", "force_n = 1")) ==
          "x.toml:9: force_n = 1: unknown key; accepted here: id, role, at_mm, organ");
    // and the other kinds do not have this one's
    CHECK(message(replaced(kTubes, "\"find-tubes\"", "\"touch-points\"")).find("unknown key") !=
          std::string::npos);
}

TEST_CASE("find-tubes file: a mistake in a tube is named by its line and what is accepted") {
    CHECK(message(replaced(kTubes, "\"duct\"", "\"artery\"")) ==
          "x.toml:11: id = \"artery\": an id that no other target has");
    CHECK(message(replaced(kTubes, "\"assist\"", "\"scope\"")) ==
          "x.toml:12: role = \"scope\": one of \"left\", \"right\", \"assist\"");
    CHECK(message(replaced(kTubes, "[20, 0, 0]", "[9, 0, 0]"))
              .starts_with("x.toml:13: at_mm = [9,0,0]: a place two radii or more away from target "
                           "\"artery\""));
    CHECK(message(replaced(kTubes, "at_mm = [0, 0, 0]\n", "")) ==
          "x.toml:5: at_mm is missing: [x, y, z] in millimetres, each -500 to 500");
}

TEST_CASE("find-tubes file: 1 to 15 tubes: the place to lift needs room too") {
    const std::string head = kTubes.substr(0, kTubes.find("[[tube]]"));
    const auto tubes = [&](int n) {
        std::string text = head;
        for (int k = 0; k < n; ++k)
            text += "[[tube]]\nid = \"" + std::to_string(k) + "\"\nrole = \"right\"\nat_mm = [" +
                    std::to_string(20 * k) + ", 0, 0]\n";
        return message(text + kTubes.substr(kTubes.find("[lift]")));
    };
    CHECK(tubes(0) == "x.toml:1: tube is missing: 1 to 15 tables written as [[tube]]");
    CHECK(tubes(1) == "accepted");
    CHECK(tubes(15) == "accepted");
    CHECK(tubes(16) == "x.toml:66: id = \"15\": at most 15 tables written as [[tube]]");
}

TEST_CASE("find-tubes file: a tool that lifts cannot point, and a lift says from where to where") {
    CHECK(message(replaced(kTubes, "\"left\"", "\"assist\"")) ==
          "x.toml:15: role = \"assist\": another role than tube \"duct\" has: a tool that lifts "
          "cannot point");
    CHECK(message(replaced(kTubes, "to_mm = [0, 30, 60]\n", "")) ==
          "x.toml:14: to_mm is missing: [x, y, z] in millimetres, each -500 to 500");
    CHECK(message(replaced(kTubes, "at_mm = [0, -30, 6]\n", "")) ==
          "x.toml:14: at_mm is missing: [x, y, z] in millimetres, each -500 to 500");
    CHECK(message(replaced(kTubes, "role = \"left\"\n", "")) ==
          "x.toml:14: role is missing: one of \"left\", \"right\", \"assist\"");
    CHECK(message(kTubes + "radius_mm = 60\n") ==
          "x.toml:18: radius_mm = 60: a number from 1 to 50");
    CHECK(message(replaced(kTubes, "[lift]", "[[lift]]")).find("a table written as [lift]") !=
          std::string::npos);
}

TEST_CASE("find-tubes file: any bytes are refused or accepted, never worse") {
    CHECK(rc::check("damaged files", [](std::vector<std::pair<unsigned, char>> changes) {
        std::string text = kTubes;
        for (const auto& [at, byte] : changes)
            text[at % text.size()] = byte;
        message(text);
    }));
}

TEST_CASE("find-tubes file: the shipped exercise has three tubes for the right tool") {
    std::ifstream file(TROCAR_ASSETS "/scenes/flap/exercises/find-tubes.toml");
    std::stringstream text;
    text << file.rdbuf();
    const tasks::Exercise exercise = parse_exercise(text.str(), "find-tubes.toml");
    REQUIRE(exercise.target.size() == 3);
    for (const tasks::ExerciseTarget& tube : exercise.target)
        CHECK(tube.role == tasks::Role::right);
    REQUIRE(exercise.lift.has_value());
    CHECK(exercise.lift->role == tasks::Role::left);
}
