// tests/sim/scene_check_test.cpp
// Everything that a scene lacks, or that an exercise asks in vain, is found: that and nothing else.
#include "tests/sim/scene_fixture.h"

#include <fmt/format.h>
#include <random>

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

TEST_CASE("scene check: the bench as it is has nothing to find, nor have the shipped scenes") {
    const Directory directory;
    for (const std::string& scene :
         {directory.path(), std::string("basic"), std::string("two_organs")}) {
        CAPTURE(scene);
        const sim::SceneCheck check = sim::check_scene(scene);
        CHECK(check.mistakes.empty());
        CHECK(kinds(check) == Kinds{});
        REQUIRE(check.exercise.size() == (scene == directory.path() ? 1 : 2));
        CHECK(check.hash.size() == 64);
    }
}

TEST_CASE("scene check: every mistake in a scene's text is said at once") {
    const Directory directory;
    std::string text = with(kScene, "young_kpa = 6.0", "young_kpa = \"soft\"");
    text = with(text, "role = \"left\"", "role = \"middle\"");
    text = with(text, "field_of_view_deg = 50", "field_of_view_deg = 500");
    text = with(text, "title = \"A block\"\n", "titel = \"A block\"\n");
    directory.write("scene.toml", text);
    directory.write("exercises/bench.toml",
                    with(kExercise, "force_max_n = 1.0", "force_max_n = 0"));
    const std::string scene = (directory.folder / "scene.toml").string();
    std::vector<std::string> said;
    for (const tasks::BadInput& mistake : directory.check().mistakes)
        said.emplace_back(mistake.what());
    CHECK(said == std::vector<std::string>{
                      scene + ":2: titel = \"A block\": unknown key; accepted here: id, title, "
                              "between_organs, organ, "
                              "tool, view, scope",
                      scene + ":1: title is missing: text in quotes",
                      scene + ":7: young_kpa = \"soft\": a number from 0.1 to 1e+06",
                      scene + ":14: role = \"middle\": one of \"left\", \"right\", \"assist\"",
                      scene + ":13: tool = " + said[4].substr(said[4].find(" = ") + 3),
                      scene + ":32: field_of_view_deg = 500: a number from 20 to 100",
                      (directory.folder / "exercises/bench.toml").string() +
                          ":5: force_max_n = 0: a number from 0.01 to 20"});
    CHECK(said[4].ends_with("a table [[tool]] with role = \"left\"; the scene has none"));
}

TEST_CASE("a scene's tissue may relax; a series that cannot be is named") {
    const auto scene = [](const char* prony) {
        return sim::parse_scene(with(kScene, "young_kpa = 6.0", prony), "s");
    };
    const auto terms = scene("prony = [[0.3, 0.5], [0.2, 8]]").organ[0].material.prony;
    REQUIRE(terms.size() == 2);
    CHECK(terms[1].share == 0.2);
    CHECK(terms[1].time_s == 8.0);
    CHECK_THROWS_WITH_AS(scene("prony = [[0.5, 1], [0.5, 2]]"),
                         doctest::Contains("s:7: prony = [[0.5,1],[0.5,2]]: shares of the shear "
                                           "modulus that sum to less than 1"),
                         tasks::BadInput);
    CHECK_THROWS_WITH_AS(scene("prony = [[0.5, 0]]"), doctest::Contains("[share, time_s]"),
                         tasks::BadInput);
}

TEST_CASE("scene check: files that are missing, damaged or outside are named with the key") {
    const Directory directory;
    std::filesystem::remove(directory.folder / "block.organ");
    sim::SceneCheck check = directory.check();
    REQUIRE(check.mistakes.size() == 1);
    CHECK(check.mistakes[0].at.line == 6);
    CHECK(check.mistakes[0].at.key == "file");
    CHECK(check.mistakes[0].at.value == "\"block.organ\"");
    CHECK(check.mistakes[0].accepted.find("No such file") != std::string::npos);

    directory.write("block.organ", "not an organ");
    check = directory.check();
    REQUIRE(check.mistakes.size() == 1);
    CHECK(check.mistakes[0].accepted.find("an organ made by bake") != std::string::npos);

    for (const char* path : {"../block.organ", "/etc/passwd", "a/../../b", "a\\\\b"}) {
        CAPTURE(path);
        directory.write("scene.toml", with(kScene, "\"block.organ\"", fmt::format("\"{}\"", path)));
        check = directory.check();
        REQUIRE(check.mistakes.size() == 1);
        CHECK(check.mistakes[0].at.line == 6);
        CHECK(check.mistakes[0].accepted == "a path inside the scene's directory, without \"..\"");
    }
}

TEST_CASE("scene check: a directory's missing organ is not taken from the build's") {
    const Directory directory;
    directory.write("scene.toml", with(kScene, "block.organ", "block_s12.organ"));
    CHECK(directory.check().mistakes.size() == 1);
    CHECK_THROWS_AS(sim::load_scene(directory.path()), tasks::BadInput);
}

TEST_CASE("scene check: anchors are one kind each, of organs that exist") {
    const Directory directory;
    const std::string box = "low_mm = [-1, -1, -1]\nhigh_mm = [81, 81, 10]\n";
    const std::vector<std::array<std::string, 2>> cases{
        {box + "radius_mm = 3\n", "only one of: low_mm and high_mm"},
        {"\n", "one of: low_mm and high_mm"},
        {"low_mm = [0, 0, 0]\nhigh_mm = [9, 9, 0]\n", "a place above low_mm in x, y and z"},
        {"touching = \"wall\"\nwithin_mm = 3\n", "another organ of the scene; there is none"},
        {"touching = \"block\"\nwithin_mm = 3\n", "another organ of the scene; there is none"},
        {"touching = \"wall\"\n", "a number from 0.1 to 50"},
        {"region = \"../up.txt\"\n", "a path inside the scene's directory"},
        {"region = \"gone.txt\"\n", "a file of balls x y z r in the scene's directory"},
        {"radios_mm = 3\n", "unknown key"}};
    for (const auto& [anchor, accepted] : cases) {
        CAPTURE(anchor);
        directory.write("scene.toml", with(kScene, box, anchor));
        const sim::SceneCheck check = directory.check();
        REQUIRE(!check.mistakes.empty());
        CHECK(check.mistakes[0].at.line >= 9);
        CHECK(check.mistakes[0].at.line <= 12);
        CHECK(std::string(check.mistakes[0].accepted).find(accepted) == 0);
    }
}

TEST_CASE("scene check: two blocks that share 5 mm overlap by 5 mm") {
    const Directory directory;
    tissue::BakedOrgan above = block();
    for (glm::dvec3& p : above.mesh.rest_m)
        p.z += 35e-3;
    for (glm::dvec3& p : above.surface.rest_m)
        p.z += 35e-3;
    directory.add("above.organ", above);
    directory.write("scene.toml", std::string(kScene) +
                                      "\n[[organ]]\nname = \"above\"\nfile = \"above.organ\"\n");
    const sim::SceneCheck check = directory.check();
    REQUIRE(!check.finding.empty());
    CHECK(check.finding[0].kind == "overlap");
    CHECK(check.finding[0].at.value == "\"above\"");
    CHECK(check.finding[0].accepted.find("overlaps \"block\", deepest 5.0 mm") !=
          std::string::npos);
}

TEST_CASE("scene check: an organ behind the rigid wall is found, one in front of it is not") {
    const Directory directory;
    directory.put(plate({-200, -200}, {300, 300}, 3.0, true)); // the block's lowest 3 mm
    sim::Finding finding = only(directory.check());
    CHECK(finding.kind == "overlap");
    CHECK(finding.accepted.find("deepest 3.0 mm") != std::string::npos);
    directory.put(plate({-200, -200}, {300, 300}, -1.0, true));
    CHECK(kinds(directory.check()) == Kinds{});
}

TEST_CASE("scene check: a tool that starts in an organ or through one is found") {
    const Directory directory;
    directory.write("scene.toml", with(kScene, "[70, 40, 90]", "[70, 40, 30]"));
    sim::Finding finding = only(directory.check());
    CHECK(finding.kind == "start_inside");
    CHECK(finding.at.value == "[70,40,30]");
    directory.write("scene.toml", with(kScene, "[70, 40, 90]", "[70, 40, 42]")); // a 3 mm tip
    CHECK(only(directory.check()).kind == "start_inside");
    // over the right tool's way to its start, and no other's; the block is in front of it
    directory.put(plate({85, 30}, {105, 50}, 120.0, false));
    const sim::SceneCheck check = directory.check();
    REQUIRE(kinds(check) == Kinds{"shaft_blocked", "shaft_blocked"});
    CHECK(check.finding[0].at.key == "start_tip_mm");
    CHECK(check.finding[1].at.key == "at_mm"); // and its target is behind the plate too
}

TEST_CASE("scene: any bytes are a scene or mistakes that are told, and nothing else") {
    const Directory directory;
    const std::string good = with(kScene, "young_kpa = 6.0", "young_kpa = 6.0\nhold_length_mm = 3");
    std::mt19937 random(5);
    int told = 0;
    for (int round = 0; round < 3000; ++round) {
        std::string text = good;
        for (int k = 0; k < 1 + round % 4; ++k) {
            const std::size_t at = random() % text.size();
            switch (random() % 3) {
            case 0:
                text[at] = static_cast<char>(random());
                break;
            case 1:
                text.erase(at, random() % 40);
                break;
            default:
                text.insert(at, text.substr(random() % text.size(), random() % 40));
            }
        }
        sim::Mistakes mistakes;
        sim::Scene scene = sim::parse_scene(text, "s.toml", &mistakes);
        if (mistakes.empty()) {
            CHECK_NOTHROW(sim::parse_scene(text, "s.toml"));
            continue;
        }
        ++told;
        CHECK_THROWS_AS(sim::parse_scene(text, "s.toml"), tasks::BadInput);
        if (!scene.organ.empty())
            sim::load_organs(std::move(scene), sim::find_scene(directory.path()), &mistakes);
    }
    CHECK(told > 1000);
}
