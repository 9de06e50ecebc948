// tests/sim/scene_command_test.cpp
// `trocar scene check` and `trocar run` as a script sees them: exit codes, and one JSON object.
#include "tests/sim/command_fixture.h"
#include "tests/sim/scene_fixture.h"

using namespace command_tests;
using namespace scene_tests;

TEST_CASE(
    "scene check: exit 0 for a usable scene, 1 for one with findings, 2 for an unreadable one") {
    const Directory directory;
    const std::string check = "scene check '" + directory.path() + "'";
    CHECK(trocar(check).exit_code == 0);
    directory.write("exercises/bench.toml", with(kExercise, "[55, 25, 40]", "[55, 25, 60]"));
    const Answer found = trocar(check);
    CHECK(found.exit_code == 1);
    CHECK(found.text.find("exercises/bench.toml:10: at_mm = [55,25,60]: a place within 10 mm") !=
          std::string::npos);
    CHECK(found.text.find("\n1 problem\n") != std::string::npos);
    // the exercise is refused by run as well, with the same line
    const Answer refused = trocar("run bench --scene '" + directory.path() + "'");
    CHECK(refused.exit_code == 2);
    CHECK(refused.text.find("exercises/bench.toml:10: at_mm = [55,25,60]: a place within 10 mm") !=
          std::string::npos);
    directory.write("scene.toml", with(kScene, "young_kpa = 6.0", "young_kpa = -6.0"));
    CHECK(trocar(check).exit_code == 2);
    CHECK(trocar("scene check '" + directory.path() + "/none'").exit_code == 2);
    CHECK(trocar("scene check").exit_code == 2);
}

TEST_CASE(
    "scene check: JSON names every problem by kind, file, line, key, value and what is accepted") {
    const Directory directory;
    directory.write("exercises/bench.toml", with(kExercise, "[55, 25, 40]", "[55, 25, 60]"));
    const auto json =
        nlohmann::json::parse(trocar("scene check --json '" + directory.path() + "'").text);
    CHECK(json["readable"] == true);
    CHECK(json["usable"] == false);
    CHECK(json["organs"][0]["held_volume_m3"].get<double>() ==
          doctest::Approx(80e-3 * 80e-3 * 10e-3).scale(0.0).epsilon(0.05)); // see scene_anchor_test
    REQUIRE(json["problems"].size() == 1);
    const auto& problem = json["problems"][0];
    CHECK(problem["kind"] == "no_skin");
    CHECK(problem["file"] == (directory.folder / "exercises/bench.toml").string());
    CHECK(problem["line"] == 10);
    CHECK(problem["key"] == "at_mm");
    CHECK(problem["value"] == "[55,25,60]");
    CHECK(problem["accepted"].get<std::string>().find("a place within 10 mm") == 0);
}

TEST_CASE("scene check: --exercise asks about one exercise only, also one from elsewhere") {
    const Directory directory;
    directory.write("exercises/broken.toml", "id = 3");
    CHECK(trocar("scene check '" + directory.path() + "'").exit_code == 2);
    CHECK(trocar("scene check '" + directory.path() + "' --exercise bench").exit_code == 0);
    // the liver's nine points are not on a block
    CHECK(trocar("scene check '" + directory.path() + "' --exercise touch-points").exit_code == 1);
}
