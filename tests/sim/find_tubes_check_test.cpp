// tests/sim/find_tubes_check_test.cpp
// What keeps a find-tubes exercise from being done in its scene is found: that, and nothing else.
#include "tests/sim/scene_fixture.h"

#include <glm/geometric.hpp>

using namespace scene_tests;

namespace {

using Kinds = std::vector<std::string>;

/// The shipped scene, in memory, to be changed by a test.
struct Flap {
    sim::LoadedScene scene = sim::load_scene("flap");
    std::vector<sim::Body> bodies = sim::make_bodies(scene, 0.01);
    std::vector<sim::Solid> solids = sim::make_solids(scene);
    std::string text = sim::read_text(sim::assets_dir() / "scenes/flap/exercises/find-tubes.toml");

    std::vector<sim::Finding> check() const {
        return sim::check_exercise(scene, bodies, solids, text, "f.toml").finding;
    }
    Kinds kinds() const {
        Kinds out;
        for (const sim::Finding& finding : check())
            out.push_back(finding.kind);
        return out;
    }
    sim::Finding only() const {
        const auto found = check();
        REQUIRE(found.size() == 1);
        return found[0];
    }
};

/// The shipped text with another place in the table that the key is in.
std::string artery_at(const Flap& flap, const char* organ, const char* at_mm) {
    const std::string text =
        with(flap.text, "organ = \"artery\"", "organ = \"" + std::string(organ) + "\"");
    return with(text, "[12.0, 8.0, -6.5]", at_mm);
}

/// The bench with a second block 35 mm higher, so that they share 5 mm, and a third one far away.
void stack(const Directory& directory, const std::string& below, const std::string& above) {
    const auto moved = [](const glm::dvec3& by_m) {
        tissue::BakedOrgan organ = block();
        for (auto* places_m : {&organ.mesh.rest_m, &organ.surface.rest_m})
            for (glm::dvec3& place_m : *places_m)
                place_m += by_m;
        return organ;
    };
    directory.add("above.organ", moved({0.0, 0.0, 35e-3}));
    directory.add("aside.organ", moved({0.2, 0.0, 0.0}));
    directory.write("scene.toml", with(kScene, "young_kpa = 6.0", "young_kpa = 6.0\n" + below) +
                                      "\n[[organ]]\nname = \"above\"\nfile = \"above.organ\"\n" +
                                      above + "\n[[organ]]\nname = \"aside\"\n" +
                                      "file = \"aside.organ\"\n");
}

/// Findings of the kind that say that two organs overlap.
std::size_t overlaps(const Directory& directory) {
    const Kinds found = kinds(directory.check());
    return static_cast<std::size_t>(std::count(found.begin(), found.end(), "overlap"));
}

} // namespace

TEST_CASE("find-tubes check: the shipped scene and exercise have nothing to find") {
    CHECK(Flap().kinds() == Kinds{});
    const sim::SceneCheck check = sim::check_scene("flap");
    CHECK(check.mistakes.empty());
    CHECK(kinds(check) == Kinds{});
}

TEST_CASE("find-tubes check: to lift what is rigid is found") {
    Flap flap;
    flap.text = with(with(flap.text, "organ = \"flap\"", "organ = \"ground\""), "[0.0, -29.0, 6.0]",
                     "[0.0, -60.0, 0.0]");
    const auto found = flap.check();
    REQUIRE_FALSE(found.empty());
    CHECK(found[0].kind == "not_soft");
    CHECK(found[0].at.key == "at_mm");
    CHECK(found[0].at.value == "[0.0,-60.0,0.0]");
    CHECK(found[0].accepted == "a place on a soft organ that something holds; \"ground\" is not");
    for (std::size_t i = 1; i < found.size(); ++i) // and then nothing is out of the way
        CHECK((found[i].kind == "hidden" || found[i].kind == "shaft_blocked"));
}

TEST_CASE("find-tubes check: a soft organ that nothing holds cannot be lifted from anything") {
    Flap flap;
    tissue::BakedOrgan loose = *flap.scene.organ[0];
    loose.bed = {};
    flap.bodies[0].organ = std::make_shared<const tissue::BakedOrgan>(std::move(loose));
    CHECK(flap.only().kind == "not_soft");
}

TEST_CASE("find-tubes check: a scene with a fixed picture is found once, not at every tube") {
    Flap flap;
    flap.scene.scene.scope.reset();
    const sim::Finding finding = flap.only();
    CHECK(finding.kind == "no_scope");
    CHECK(finding.at.key == "kind");
    CHECK(finding.accepted.find("scene \"flap\" needs a table [scope]") != std::string::npos);
}

TEST_CASE("find-tubes check: tubes that the endoscope does not come near enough to are found") {
    Flap flap;
    sim::SceneScope& scope = *flap.scene.scene.scope;
    // 3 mm make 0.04 of the picture's height from 144 mm; all tubes are 255 mm or more away
    scope.optics.trocar.shaft_m = scope.optics.trocar.min_outside_m + 0.08;
    CHECK(flap.kinds() == Kinds{"too_far", "too_far", "too_far"});
    const sim::Finding finding = flap.check()[0];
    CHECK(finding.at.key == "at_mm");
    CHECK(finding.accepted == "a place that the endoscope comes near enough to: 144 mm for a mark "
                              "of least_share");
    scope.optics.trocar.shaft_m = scope.optics.trocar.min_outside_m + 0.16;
    CHECK(flap.kinds() == Kinds{});
}

TEST_CASE("find-tubes check: tubes that something else hides than what is lifted are found") {
    Flap flap; // the vein is lifted, so the flap stays
    flap.text = with(with(flap.text, "organ = \"flap\"", "organ = \"vein\""), "[0.0, -29.0, 6.0]",
                     "[-10.0, -6.0, -15.0]");
    const auto found = flap.check();
    REQUIRE(found.size() >= 2);
    for (const sim::Finding& finding : found) {
        if (finding.kind == "shaft_blocked")
            continue; // by the flap too
        CHECK(finding.kind == "hidden");
        CHECK(finding.accepted.find("the endoscope sees once \"vein\" is lifted; \"flap\" hides "
                                    "it at") != std::string::npos);
    }
}

TEST_CASE("find-tubes check: a tube that nothing hides at rest is found, alone") {
    Flap flap;
    flap.text = artery_at(flap, "ground", "[0.0, -55.0, 0.0]"); // in front of the flap
    const sim::Finding finding = flap.only();
    CHECK(finding.kind == "not_hidden");
    CHECK(finding.at.value == "[0.0,-55.0,0.0]");
    CHECK(finding.accepted == "a place that \"flap\" hides until it is lifted");
}

TEST_CASE("find-tubes check: a place to bring the flap to that its tool does not reach is found, "
          "alone") {
    Flap flap;
    // the left tool's fulcrum is (-100, -70, 160)
    flap.text = with(flap.text, "[0.0, 38.0, 72.0]", "[-100.0, -70.0, 150.0]");
    sim::Finding finding = flap.only();
    CHECK(finding.kind == "out_of_reach");
    CHECK(finding.at.key == "to_mm");
    CHECK(finding.at.value == "[-100.0,-70.0,150.0]");
    CHECK(finding.accepted.find("would be 10 mm from it") != std::string::npos);
    flap.text = with(flap.text, "[-100.0, -70.0, 150.0]", "[-100.0, -70.0, -240.0]");
    finding = flap.only();
    CHECK(finding.kind == "out_of_reach");
    CHECK(finding.accepted.find("would be 400 mm from it") != std::string::npos);
}

TEST_CASE("find-tubes check: an organ of the lift that the scene does not have is found") {
    Flap flap;
    flap.text = with(flap.text, "organ = \"flap\"", "organ = \"liver\"");
    const auto found = flap.check();
    REQUIRE_FALSE(found.empty());
    CHECK(found[0].kind == "unknown_organ");
    CHECK(found[0].at.value == "\"liver\"");
}

TEST_CASE("runs_into: organs may overlap with the one that either names, and with no other") {
    const Directory directory;
    stack(directory, "", "");
    CHECK(overlaps(directory) == 1);
    stack(directory, "", "runs_into = \"block\"");
    CHECK(overlaps(directory) == 0);
    stack(directory, "runs_into = \"above\"", "");
    CHECK(overlaps(directory) == 0);
    stack(directory, "", "runs_into = \"aside\"");
    CHECK(overlaps(directory) == 1);
    CHECK(directory.check().mistakes.empty());
}

TEST_CASE("runs_into: an organ that the scene does not have, or itself, is refused by its line") {
    const Directory directory;
    for (const char* name : {"wall", "above", "\\\"", "blo"}) {
        stack(directory, "", "runs_into = \"" + std::string(name) + "\"");
        const sim::SceneCheck check = directory.check();
        REQUIRE(check.mistakes.size() == 1);
        CHECK(check.mistakes[0].at.key == "runs_into");
        CHECK(check.mistakes[0].accepted == "another organ of the scene: \"block\", \"aside\"");
    }
    stack(directory, "runs_into = 3", "");
    CHECK(directory.check().mistakes.size() == 1);
}
