#include "assets/bake/recipe.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

namespace {

constexpr const char* kGood = R"(name = "b"
kind = "box"
size_mm = [80.0, 60, 40.0]
edge_mm = 12
skin = "whole"

[[anchor_box]]
low_mm = [0, 0, 0]
high_mm = [80, 80, 0]

[[fine]]
centre_mm = [40, 40, 40]
radius_mm = 5
edge_mm = 2.5

[material]
young_pa = 6000
source = "chosen"
)";

std::string refusal(const std::string& text) {
    try {
        bake::parse_recipe(text, "b.toml");
    } catch (const bake::RecipeError& e) {
        return e.what();
    }
    return "";
}

std::string with(const std::string& line, const std::string& instead) {
    std::string text = kGood;
    text.replace(text.find(line), line.size(), instead);
    return text;
}

bool names(const std::string& text, std::initializer_list<const char*> parts) {
    for (const char* const part : parts) {
        if (text.find(part) == std::string::npos) {
            MESSAGE(text << " does not name " << part);
            return false;
        }
    }
    return true;
}

} // namespace

TEST_CASE("recipe: what is written is what is read") {
    const auto r = bake::parse_recipe(kGood, "b.toml");
    CHECK(r.name == "b");
    CHECK(r.kind == bake::Kind::box);
    const auto& box = std::get<bake::BoxShape>(r.shape);
    CHECK(box.size_mm == glm::dvec3{80, 60, 40});
    CHECK_FALSE(box.skin_on_top_only);
    CHECK_FALSE(box.cells);
    CHECK(r.edge_mm == 12.0);
    CHECK(r.skin_mm == 4.0); // usual
    REQUIRE(r.anchor_boxes.size() == 1);
    CHECK(r.anchor_boxes[0].high_mm == glm::dvec3{80, 80, 0});
    REQUIRE(r.fine.size() == 1);
    CHECK(r.fine[0].edge_mm == 2.5);
    CHECK(r.material.young_pa == 6000.0);
    CHECK(r.material.source == "chosen");
}

TEST_CASE("recipe: a bad value names file, line, key, value and what is accepted") {
    CHECK(names(refusal(with("edge_mm = 12", "edge_mm = -3")),
                {"b.toml:4:", "edge_mm = -3", "accepted: a number from 1 to 100"}));
    CHECK(names(refusal(with("edge_mm = 12", "edge_mm = nan")), {"b.toml:4:", "edge_mm"}));
    CHECK(names(refusal(with("edge_mm = 12", "edge_mm = \"long\"")), {"b.toml:4:", "\"long\""}));
    CHECK(names(refusal(with("\"box\"", "\"spleen\"")),
                {"b.toml:2:", "kind = \"spleen\"", "accepted: liver, wall, box"}));
    CHECK(names(refusal(with("[80.0, 60, 40.0]", "[80.0, 60]")),
                {"b.toml:3:", "size_mm", "three numbers"}));
    CHECK(names(refusal(with("radius_mm = 5", "radius_mm = [5]")), {"b.toml:13:", "radius_mm"}));
    CHECK(names(refusal(with("skin = \"whole\"", "cells = [7, 7, 2.5]")),
                {"b.toml:5:", "cells", "whole numbers"}));
    CHECK(names(refusal(with("young_pa = 6000", "poisson = 0.5")),
                {"b.toml:17:", "poisson = 0.5", "0.499"}));
    CHECK(names(refusal(with("[[fine]]", "[fine]")), {"fine", "accepted: tables [[fine]]"}));
}

TEST_CASE("recipe: a missing key and an unknown key are named") {
    CHECK(names(refusal(with("kind = \"box\"", "")), {"b.toml", "kind is missing"}));
    CHECK(names(refusal(with("source = \"chosen\"", "")), {"source is missing"}));
    CHECK(names(refusal(with("edge_mm = 12", "egde_mm = 12")),
                {"b.toml:4:", "egde_mm = 12", "edge_mm"}));
    CHECK(names(refusal("name = \"l\"\nkind = \"liver\"\n"), {"lobe is missing", "[[lobe]]"}));
}

TEST_CASE("recipe: text that is not TOML names the file and the line") {
    CHECK(names(refusal("name = \"b\"\nkind = = 3\n"), {"b.toml", "2"}));
}

TEST_CASE("recipe: damaged text is refused or still a recipe, never anything else") {
    const std::string good = kGood;
    CHECK(rc::check([&good] {
        std::string text = good;
        for (int i = 0, n = *rc::gen::inRange(1, 4); i < n; ++i) {
            const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
            text[at] = *rc::gen::element('\0', '"', '[', ']', '=', '\n', '9', '-', '.', 'e', '#');
        }
        try {
            const auto r = bake::parse_recipe(text, "b.toml");
            RC_ASSERT(r.edge_mm >= 1.0 && r.edge_mm <= 100.0);
            RC_TAG("still a recipe");
        } catch (const bake::RecipeError&) {
            RC_TAG("refused");
        }
    }));
}

TEST_CASE("recipe: another text gives another hash") {
    CHECK(bake::parse_recipe(kGood, "b.toml").text_hash !=
          bake::parse_recipe(with("edge_mm = 12", "edge_mm = 13"), "b.toml").text_hash);
}
