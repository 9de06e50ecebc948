// tests/sim/scene_look_test.cpp
// Keys of a scene: `look` of its organs, and whether these meet.
#include "scene_fixture.h"

#include <fmt/format.h>

using namespace scene_tests;

namespace {

view::Look look_of(const std::string& text) {
    return sim::parse_scene(text, "scene.toml").organ.at(0).look;
}

} // namespace

TEST_CASE("scene look: the key decides, without it the organ's name, else neutral tissue") {
    CHECK(look_of(kScene) == view::Look::tissue);
    CHECK(look_of(with(kScene, "name = \"block\"", "name = \"kidney\"")) == view::Look::kidney);
    const std::string said = with(kScene, "name = \"block\"", "name = \"kidney\"\nlook = \"fat\"");
    CHECK(look_of(said) == view::Look::fat);
    for (const std::string_view word : view::kLookWords)
        CHECK(look_of(with(said, "\"fat\"", fmt::format("\"{}\"", word))) ==
              view::look_named(word));
}

TEST_CASE("scene look: an unknown word is refused with all that are known") {
    const std::string text = with(kScene, "name = \"block\"", "name = \"block\"\nlook = \"blue\"");
    CHECK_THROWS_WITH_AS(look_of(text),
                         "scene.toml:6: look = \"blue\": one of \"liver\", \"stomach\", "
                         "\"spleen\", \"kidney\", \"bowel\", \"pancreas\", \"fat\", "
                         "\"gallbladder\", \"artery\", \"vein\", \"duct\", \"wall\", \"tissue\"",
                         tasks::BadInput);
}

TEST_CASE("scene: organs meet only if it says so") {
    const auto meet = [](const std::string& line) {
        return sim::parse_scene(line + "\n" + kScene, "scene.toml").organs_meet;
    };
    CHECK_FALSE(meet(""));
    CHECK_FALSE(meet("between_organs = \"nothing\""));
    CHECK(meet("between_organs = \"contact\""));
    CHECK_THROWS_WITH_AS(meet("between_organs = \"glue\""),
                         "scene.toml:1: between_organs = \"glue\": one of \"nothing\", \"contact\"",
                         tasks::BadInput);
}
