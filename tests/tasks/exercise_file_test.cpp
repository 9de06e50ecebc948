// tests/tasks/exercise_file_test.cpp
// Exercise files: what is read, and how mistakes and any bytes at all are refused.
#include "tasks/exercise/exercise.h"

#include "relative.h"

#include <fstream>
#include <rapidcheck.h>
#include <sstream>

using tasks::parse_exercise;
using tasks::testing::relative;

namespace {

const std::string kGood = R"(id = "t"
title = "T"
card = "Do it."
radius_m = 0.004
force_limit_n = 3
[[target]]
id = "1"
role = "left"
at_mm = [1, 2.5, -3]
[[target]]
id = "2"
role = "assist"
at_mm = [20, 0, 0]
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
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

TEST_CASE("an exercise file becomes the exercise, millimetres become metres") {
    const tasks::Exercise exercise = parse_exercise(kGood, "x.toml");
    CHECK(exercise.id == "t");
    CHECK(exercise.card == "Do it.");
    CHECK(exercise.radius_m == 0.004);
    CHECK(exercise.force_limit_n == 3.0);
    CHECK(exercise.hold_s == 0.3); // the standard
    REQUIRE(exercise.target.size() == 2);
    CHECK(exercise.target[0].role == tasks::Role::left);
    CHECK(exercise.target[1].role == tasks::Role::assist);
    CHECK(exercise.target[0].at_m.y == relative(2.5e-3));
}

TEST_CASE("a mistake in an exercise file is named by file, line, key, value and what is accepted") {
    const auto said = [](const std::string& from, const std::string& to) {
        return message(replaced(kGood, from, to));
    };
    CHECK(said("radius_m = 0.004", "radius_m = 4") ==
          "x.toml:4: radius_m = 4: a number from 0.0005 to 0.02");
    CHECK(said("radius_m = 0.004", "radius_m = nan") ==
          "x.toml:4: radius_m = nan: a number from 0.0005 to 0.02");
    CHECK(said("radius_m = 0.004", "radius_m = \"4\"") ==
          "x.toml:4: radius_m = \"4\": a number from 0.0005 to 0.02");
    CHECK(said("\"left\"", "\"middle\"") ==
          "x.toml:8: role = \"middle\": one of \"left\", \"right\", \"assist\"");
    CHECK(said("[20, 0, 0]", "[20, 0]") ==
          "x.toml:13: at_mm = [20,0]: [x, y, z] in millimetres, each -500 to 500");
    CHECK(said("force_limit_n = 3", "force_limt_n = 3") ==
          "x.toml:5: force_limt_n = 3: unknown key; accepted here: kind, id, title, card, scope, "
          "radius_m, force_min_n, force_max_n, hold_s, force_limit_n, time_limit_s, target, level");
    CHECK(said("title = \"T\"\n", "") == "x.toml:1: title is missing: text in quotes");
    CHECK(said("id = \"2\"", "id = \"1\"") ==
          "x.toml:11: id = \"1\": an id that no other target has");
    CHECK(said("at_mm = [20, 0, 0]", "") ==
          "x.toml:10: at_mm is missing: [x, y, z] in millimetres, each -500 to 500");
}

TEST_CASE("targets that one touch could reach together are refused") {
    CHECK(message(replaced(kGood, "[20, 0, 0]", "[8, 2.5, -3]")).starts_with("x.toml:13: at_mm"));
    CHECK(message(replaced(kGood, "[20, 0, 0]", "[9.1, 2.5, -3]")) == "accepted");
}

TEST_CASE("a band that cannot be is refused") {
    CHECK(message("force_min_n = 2\nforce_max_n = 1\n" + kGood)
              .starts_with("x.toml:2: force_max_n = 1"));
    CHECK(message("force_max_n = 4\n" + kGood).starts_with("x.toml:6: force_limit_n = 3"));
}

TEST_CASE("no target and seventeen targets are refused") {
    const std::string head = kGood.substr(0, kGood.find("[[target]]"));
    CHECK(message(head).starts_with("x.toml:1: target is missing: 1 to 16"));
    std::string many = head;
    for (int i = 0; i < 17; ++i)
        many += "[[target]]\nid = \"" + std::to_string(i) + "\"\nrole = \"left\"\nat_mm = [" +
                std::to_string(10 * i) + ", 0, 0]\n";
    CHECK(message(many).starts_with("x.toml:71: id = \"16\": at most 16"));
}

TEST_CASE("levels are optional, and keep their order") {
    CHECK(parse_exercise(kGood, "x.toml").level.empty());
    const auto level = parse_exercise(kGood + "[[level]]\nmetric = \"time\"\ngood = 40\n"
                                              "pass = 50.5\n[[level]]\n"
                                              "metric = \"economy.left\"\ngood = 0.5\n"
                                              "pass = 0.4\n",
                                      "x.toml")
                           .level;
    REQUIRE(level.size() == 2);
    CHECK(level[0].metric == "time");
    CHECK(level[0].good == 40.0);
    CHECK(level[0].pass == 50.5);
    CHECK(level[1].metric == "economy.left");
    CHECK(level[1].pass == 0.4);
}

TEST_CASE("a level of no metric, without a direction, twice or the wrong way round is refused") {
    const auto said = [](const std::string& metric, const std::string& good,
                         const std::string& pass) {
        return message(kGood + "[[level]]\nmetric = \"" + metric + "\"\ngood = " + good +
                       "\npass = " + pass + "\n");
    };
    CHECK(said("time", "40", "40") == "accepted");
    CHECK(said("economy", "0.5", "0.5") == "accepted");
    CHECK(said("tme", "1", "2") == "x.toml:15: metric = \"tme\": a metric's id, such as \"time\" "
                                   "or \"path_length.left\"");
    CHECK(said("idle", "1", "2") ==
          "x.toml:15: metric = \"idle\": a metric of which less or more is better");
    CHECK(said("time", "40", "39") ==
          "x.toml:17: pass = 39: a number not below good: less is better");
    CHECK(said("economy", "0.4", "0.5") ==
          "x.toml:17: pass = 0.5: a number not above good: more is better");
    CHECK(said("time", "nan", "39").starts_with("x.toml:16: good = nan: a number from"));
    CHECK(said("time", "40", "50\n[[level]]\nmetric = \"time\"\ngood = 1\npass = 2") ==
          "x.toml:19: metric = \"time\": a metric that no other level has");
    CHECK(message(kGood + "[[level]]\ngood = 1\npass = 1\n") ==
          "x.toml:14: metric is missing: text in quotes");
}

TEST_CASE("what is not TOML is refused with its line") {
    CHECK(message(replaced(kGood, "title = \"T\"", "title = ")).starts_with("x.toml:2: not TOML"));
    CHECK(message(replaced(kGood, "title = \"T\"", "title = \"T")).starts_with("x.toml:"));
    CHECK(message(std::string(100000, '[')) ==
          "x.toml:1: brackets nest too deep: not a file of ours");
}

TEST_CASE("any bytes are refused or accepted, never worse") {
    CHECK(rc::check("damaged files",
                    [](std::vector<std::pair<unsigned, char>> changes, unsigned cut) {
                        std::string text = kGood;
                        for (const auto& [at, byte] : changes)
                            text[at % text.size()] = byte;
                        text.resize(cut % (text.size() + 1));
                        message(text);
                    }));
    CHECK(rc::check("noise", [](const std::string& text) { message(text); }));
}

TEST_CASE("the shipped exercise has nine targets, three for each tool") {
    std::ifstream file(TROCAR_ASSETS "/exercises/touch-points.toml");
    std::stringstream text;
    text << file.rdbuf();
    const tasks::Exercise exercise = parse_exercise(text.str(), "touch-points.toml");
    REQUIRE(exercise.target.size() == 9);
    std::array<int, 4> roles{};
    for (const tasks::ExerciseTarget& target : exercise.target)
        ++roles[static_cast<std::size_t>(target.role)];
    CHECK(roles == std::array<int, 4>{3, 3, 3, 0});
    CHECK(exercise.level.size() == 7);
}

namespace {

const std::string kPath = R"(kind = "follow-path"
id = "p"
title = "P"
card = "Draw."
role = "left"
[[point]]
at_mm = [0, 0, 0]
[[point]]
at_mm = [25, 0, 0]
organ = "liver"
[[point]]
at_mm = [50, 0, 0]
[[point]]
at_mm = [75, 0, 0]
[[point]]
at_mm = [100, 0, 0]
[[point]]
at_mm = [120, 0, 0]
)";

} // namespace

TEST_CASE("a path's file becomes numbered points of one role, 4 mm wide unless it says more") {
    const tasks::Exercise exercise = parse_exercise(kPath, "x.toml");
    CHECK(exercise.kind == tasks::ExerciseKind::follow_path);
    CHECK(exercise.radius_m == 4e-3);
    REQUIRE(exercise.target.size() == 6);
    CHECK(exercise.target[1].id == "2");
    CHECK(exercise.target[1].organ == "liver");
    for (const tasks::ExerciseTarget& point : exercise.target)
        CHECK(point.role == tasks::Role::left);
}

TEST_CASE("a mistake in a path's file is named by its line and what is accepted") {
    CHECK(message(replaced(kPath, "follow-path", "follow")) ==
          "x.toml:1: kind = \"follow\": one of \"touch-points\", \"follow-path\", \"find-tubes\"");
    CHECK(message(replaced(kPath, "[25, 0, 0]", "[26, 0, 0]")) ==
          "x.toml:9: at_mm = [26,0,0]: a place 2 to 25 mm from the point before; it is 26 mm from "
          "it");
    CHECK(message(replaced(kPath, "[120, 0, 0]", "[119, 0, 0]")) ==
          "x.toml:6: point = 6 tables: tables written as [[point]], 120 mm long together or more; "
          "they are 119 "
          "mm");
    CHECK(message(replaced(kPath, "role = \"left\"", "hold_s = 1")).find("hold_s") !=
          std::string::npos);
    CHECK(message(replaced(kPath, "role = \"left\"", "")) ==
          "x.toml:1: role is missing: one of \"left\", \"right\", \"assist\"");
}

TEST_CASE("the shipped path is one") {
    std::ifstream in(TROCAR_ASSETS "/exercises/follow-path.toml");
    std::stringstream text;
    text << in.rdbuf();
    const tasks::Exercise exercise = parse_exercise(text.str(), "follow-path.toml");
    CHECK(exercise.kind == tasks::ExerciseKind::follow_path);
    CHECK(exercise.force_max_n < exercise.force_limit_n);
}
