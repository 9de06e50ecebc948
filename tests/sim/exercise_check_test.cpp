// tests/sim/exercise_check_test.cpp
// A target that its role cannot reach, see or press is found: that target, and nothing else.
#include "tests/sim/scene_fixture.h"

#include <fmt/format.h>

using namespace scene_tests;

namespace {

using Kinds = std::vector<std::string>;

// The scene's only finding.
sim::Finding only(const sim::SceneCheck& check) {
    CHECK(check.mistakes.empty());
    REQUIRE(kinds(check).size() == 1);
    return check.finding[0];
}

} // namespace

TEST_CASE("exercise check: a target too far from its fulcrum is found, alone") {
    const Directory directory;
    // 145 mm to the right tool's target; 130 - 30 mm of it can be inside
    directory.write("scene.toml", with(kScene, "start_tip_mm = [70, 40, 90]",
                                       "start_tip_mm = [70, 40, 90]\nshaft_mm = 130"));
    const sim::Finding finding = only(directory.check());
    CHECK(finding.kind == "out_of_reach");
    CHECK(finding.at.line == 10);
    CHECK(finding.at.value == "[55,25,40]");
    CHECK(finding.accepted.find("20 to 100 mm from its fulcrum") != std::string::npos);
    CHECK(finding.accepted.find("would be 135 mm from it") != std::string::npos);
}

TEST_CASE("exercise check: a target outside the picture, or behind something, is found, alone") {
    const Directory directory;
    // 180 mm above, 20 degrees high: half of it is 31.7 mm; 36 mm up is outside, 36 mm aside not
    directory.write("scene.toml", with(kScene, "field_of_view_deg = 50", "field_of_view_deg = 20"));
    directory.write("exercises/bench.toml", with(kExercise, "[40, 60, 40]", "[40, 76, 40]"));
    CHECK(only(directory.check()).kind == "out_of_view");
    directory.write("exercises/bench.toml", with(kExercise, "[55, 25, 40]", "[76, 40, 40]"));
    CHECK(kinds(directory.check()) == Kinds{});

    directory.write("exercises/bench.toml", kExercise);
    directory.put(plate({37, 45}, {43, 53}, 150.0, false)); // on the line to the third target
    const sim::Finding finding = only(directory.check());
    CHECK(finding.kind == "hidden");
    CHECK(finding.at.value == "[40,60,40]");
    CHECK(finding.accepted.find("\"plate\" hides it") != std::string::npos);
}

TEST_CASE("exercise check: a shaft that would pass through another organ is found, alone") {
    const Directory directory;
    // the left tool comes to (25, 40, 43) from (-40, 40, 160): at height 80 it is at x = 4.4
    const double x = -40.0 + 65.0 * (160.0 - 80.0) / (160.0 - 43.0);
    directory.put(plate({x - 3, 37}, {x + 3, 43}, 80.0, false));
    const sim::Finding finding = only(directory.check());
    CHECK(finding.kind == "shaft_blocked");
    CHECK(finding.at.value == "[25,40,40]");
    // 2.5 mm is the shaft: beside it is free, and nearer is not
    directory.put(plate({x - 3, 37 - 9}, {x + 3, 43 - 9}, 80.0, false));
    CHECK(kinds(directory.check()) == Kinds{});
    directory.put(plate({x - 3, 37 - 5}, {x + 3, 43 - 5}, 80.0, false));
    CHECK(only(directory.check()).kind == "shaft_blocked");
}

TEST_CASE("exercise check: a target on the far side of its own organ is found") {
    const Directory directory;
    // from under the block's edge the tool would have to come through it
    directory.write("scene.toml", with(with(kScene, "[120, 40, 160]", "[40, 200, 20]"),
                                       "[70, 40, 90]", "[40, 120, 70]"));
    const sim::Finding finding = only(directory.check());
    CHECK(finding.kind == "shaft_blocked");
    CHECK(finding.at.value == "[55,25,40]");
    CHECK(finding.accepted.find("through \"block\"") != std::string::npos);
}

TEST_CASE("exercise check: a band that the tissue cannot give is found at every target, with what "
          "it gives") {
    const Directory directory;
    std::string band = with(kExercise, "force_min_n = 0.1", "force_min_n = 9");
    band = with(band, "force_max_n = 1.0", "force_max_n = 10\nforce_limit_n = 12");
    directory.write("exercises/bench.toml", band);
    sim::SceneCheck check = directory.check();
    REQUIRE(kinds(check) == Kinds{"band_too_high", "band_too_high", "band_too_high"});
    CHECK(check.finding[0].at.line == 4);
    CHECK(check.finding[0].at.value == "9");
    // just less than the softest target gives is accepted, just more is found there alone
    const auto& targets = check.exercise[0].target;
    const auto softest =
        std::min_element(targets.begin(), targets.end(), [](const auto& one, const auto& other) {
            return one.deep_n < other.deep_n;
        });
    const double gives_n = softest->deep_n;
    const std::string softest_id = softest->id;
    const auto least = [&](double force_n) {
        directory.write("exercises/bench.toml",
                        with(band, "force_min_n = 9", fmt::format("force_min_n = {}", force_n)));
        return directory.check();
    };
    CHECK(kinds(least(0.9999 * gives_n)) == Kinds{});
    const sim::Finding finding = only(least(1.0001 * gives_n));
    CHECK(finding.accepted.find("target \"" + softest_id + "\"") != std::string::npos);

    // a band that a deep press leaves is no fault: one presses less
    CHECK(gives_n > 0.3);
    directory.write("exercises/bench.toml",
                    with(kExercise, "force_max_n = 1.0", "force_max_n = 0.3"));
    CHECK(kinds(directory.check()) == Kinds{});

    // bone: what the coupling lets through, some 0.3 N at half a millimetre
    directory.write("scene.toml", with(kScene, "young_kpa = 6.0", "young_kpa = 100000"));
    directory.write("exercises/bench.toml",
                    with(kExercise, "force_max_n = 1.0", "force_max_n = 0.11"));
    CHECK(kinds(directory.check()) == Kinds{"band_too_low", "band_too_low", "band_too_low"});
}

TEST_CASE("exercise check: a target in the air or of an unknown organ is found, alone") {
    const Directory directory;
    directory.write("exercises/bench.toml", with(kExercise, "[55, 25, 40]", "[55, 25, 60]"));
    sim::Finding finding = only(directory.check());
    CHECK(finding.kind == "no_skin");
    CHECK(finding.accepted ==
          "a place within 10 mm of the skin of an organ; it is 20.0 mm from \"block\"");
    directory.write("exercises/bench.toml",
                    with(kExercise, "at_mm = [55, 25, 40]", "at_mm = [55, 25, 40]\norgan = \"x\""));
    finding = only(directory.check());
    CHECK(finding.kind == "unknown_organ");
    CHECK(finding.at.key == "organ");
    CHECK(finding.accepted == "an organ of the scene: \"block\"");
}

TEST_CASE("exercise check: two places of one role that snap onto one are found") {
    const Directory directory;
    directory.write("exercises/bench.toml",
                    with(with(kExercise, "[40, 60, 40]", "[55, 25, 47]"), "assist", "right"));
    const sim::Finding finding = only(directory.check());
    CHECK(finding.kind == "targets_too_near");
    CHECK(finding.at.value == "[55,25,47]");
}

TEST_CASE("exercise check: an attempt at what cannot be done is refused before it starts") {
    const Directory directory;
    directory.write("exercises/bench.toml", with(kExercise, "[55, 25, 40]", "[55, 25, 60]"));
    sim::RunOptions options;
    options.scene = directory.path();
    options.exercise = "bench";
    std::string message;
    try {
        sim::make_session(options);
    } catch (const std::invalid_argument& e) {
        message = e.what();
    }
    const std::string expected = (directory.folder / "exercises/bench.toml").string() +
                                 ":10: at_mm = [55,25,60]: a place within 10 mm of the skin";
    CHECK(message.find(expected) != std::string::npos);
}
