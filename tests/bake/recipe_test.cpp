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

constexpr const char* kGround = R"(name = "g"
kind = "ground"
size_mm = [200, 160]
bowl_mm = 20
flat_mm = 10
[[pit]]
centre_mm = [10, 0]
radius_mm = [40, 20]
depth_mm = 25
wall_mm = 9
)";

constexpr const char* kSheet = R"(name = "s"
kind = "sheet"
centre_mm = [0, 0, 5]
size_mm = [80, 60, 5]
cells = [8, 6, 1]
corner_mm = 6
edge_thickness_mm = 3
taper_mm = 10
)";

constexpr const char* kTube = R"(name = "t"
kind = "tube"
point_mm = [[0, 0, 0], [30, 5, 0], [60, 0, 0]]
radius_mm = 4
sides = 8
)";

std::string refusal(const std::string& text) {
    try {
        bake::parse_recipe(text, "b.toml");
    } catch (const bake::RecipeError& e) {
        return e.what();
    }
    return "";
}

std::string with(const std::string& line, const std::string& instead, std::string text = kGood) {
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
    CHECK_FALSE(r.local_terms);
    CHECK(bake::parse_recipe(with("edge_mm = 12", "edge_mm = 12\nmesh_terms = \"local\""), "b.toml")
              .local_terms);
}

TEST_CASE("recipe: a bad value names file, line, key, value and what is accepted") {
    CHECK(names(refusal(with("edge_mm = 12", "edge_mm = -3")),
                {"b.toml:4:", "edge_mm = -3", "accepted: a number from 1 to 100"}));
    CHECK(names(refusal(with("edge_mm = 12", "edge_mm = nan")), {"b.toml:4:", "edge_mm"}));
    CHECK(names(refusal(with("edge_mm = 12", "edge_mm = \"long\"")), {"b.toml:4:", "\"long\""}));
    CHECK(names(
        refusal(with("\"box\"", "\"spleen\"")),
        {"b.toml:2:", "kind = \"spleen\"", "accepted: liver, wall, box, ground, sheet, tube"}));
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

TEST_CASE("recipe: a ground, a sheet and a tube are read as written") {
    const auto ground = bake::parse_recipe(kGround, "b.toml");
    CHECK(ground.kind == bake::Kind::ground);
    const auto& pit = std::get<bake::GroundShape>(ground.shape).pits.at(0);
    CHECK(pit.centre_mm == glm::dvec2{10, 0});
    CHECK(pit.radius_mm == glm::dvec2{40, 20});
    CHECK(pit.wall_mm == 9.0);
    const auto sheet = std::get<bake::SheetShape>(bake::parse_recipe(kSheet, "b.toml").shape);
    CHECK(sheet.cells == std::array<int, 3>{8, 6, 1});
    CHECK(sheet.edge_thickness_mm == 3.0);
    const auto tube = std::get<bake::TubeShape>(bake::parse_recipe(kTube, "b.toml").shape);
    CHECK(tube.point_mm.at(1) == glm::dvec3{30, 5, 0});
    CHECK(tube.radius_end_mm == 4.0); // as the other end
    CHECK(tube.sides == 8);
}

TEST_CASE("recipe: a ground whose pit has no room or whose walls would meet is refused") {
    const auto bad = [](const char* line, const char* instead) {
        return refusal(with(line, instead, kGround));
    };
    CHECK(names(bad("[200, 160]", "[200, 160, 5]"), {"b.toml:3:", "size_mm", "two numbers"}));
    CHECK(names(bad("[10, 0]", "[60, 0]"), {"b.toml:7:", "centre_mm", "within size_mm"}));
    CHECK(names(bad("flat_mm = 10", "flat_mm = 61"), {"b.toml:7:", "centre_mm", "flat_mm"}));
    // 20^2 / 40: the smallest radius of the rim's curvature
    CHECK(names(bad("wall_mm = 9", "wall_mm = 11"), {"b.toml:10:", "wall_mm = 11", "0.1 to 10"}));
    CHECK(names(bad("depth_mm = 25", ""), {"depth_mm is missing"}));
    CHECK(names(bad("wall_mm = 9", "wall_mm = 9\nslope = 2"), {"b.toml:11:", "slope"}));
    CHECK(names(bad("bowl_mm = 20", "hold_length_mm = 3"), {"b.toml:4:", "hold_length_mm"}));
}

TEST_CASE("recipe: a sheet without cells, with a blade for an edge or too round is refused") {
    const auto bad = [](const char* line, const char* instead) {
        return refusal(with(line, instead, kSheet));
    };
    CHECK(names(bad("cells = [8, 6, 1]", ""), {"cells is missing"}));
    CHECK(names(bad("corner_mm = 6", "quality_ratio = 1.3"), {"b.toml:6:", "quality_ratio"}));
    CHECK(names(bad("[8, 6, 1]", "[8, 6, 0]"), {"b.toml:5:", "cells"}));
    CHECK(names(bad("corner_mm = 6", "corner_mm = 9"), {"b.toml:6:", "corner_mm = 9", "0 to 8"}));
    CHECK(names(bad("s_mm = 3", "s_mm = 1"), {"b.toml:7:", "edge_thickness_mm = 1", "1.5 to 5"}));
    CHECK(names(bad("taper_mm = 10", "taper_mm = 50"), {"b.toml:8:", "taper_mm = 50"}));
}

TEST_CASE("recipe: a tube that bends too tightly or runs into itself is refused") {
    const auto bad = [](const char* points) {
        return refusal(with("[[0, 0, 0], [30, 5, 0], [60, 0, 0]]", points, kTube));
    };
    CHECK(names(bad("[[0, 0, 0]]"), {"b.toml:3:", "point_mm", "at least 2 times three numbers"}));
    CHECK(names(bad("[[0, 0, 0], [1, 2]]"), {"b.toml:3:", "point_mm", "three numbers"}));
    CHECK(names(bad("[[0, 0, 0], [0, 0, 0]]"), {"b.toml:3:", "0 and 1 are nearer"}));
    CHECK(names(bad("[[0, 0, 0], [30, 0, 0], [30, 5, 0], [0, 5, 0]]"),
                {"b.toml:3:", "bends no tighter than 1.5 radii, 6.00 mm"}));
    // nearly a whole circle
    CHECK(names(bad("[[30, 0, 0], [15, 26, 0], [-15, 26, 0], [-30, 0, 0], [-15, -26, 0], "
                    "[15, -26, 0], [30, -1, 0]]"),
                {"b.toml:3:", "clear of itself by two radii, 8.00 mm"}));
    CHECK(names(refusal(with("sides = 8", "sides = 4", kTube)), {"b.toml:5:", "sides = 4"}));
}

TEST_CASE("recipe: text that is not TOML names the file and the line") {
    CHECK(names(refusal("name = \"b\"\nkind = = 3\n"), {"b.toml", "2"}));
}

TEST_CASE("recipe: damaged text is refused or still a recipe, never anything else") {
    CHECK(rc::check([] {
        std::string text = *rc::gen::element(kGood, kGround, kSheet, kTube);
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
