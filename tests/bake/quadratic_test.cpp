// Organs on coarse tetrahedra with quadratic shapes: which ones a recipe gets, and that the skin
// yields as on much finer ones.
#include "assets/bake/quadratic.h"

#include "assets/bake/bake.h"
#include "assets/bake/edge_for_nodes.h"
#include "tests/bake/recipes_for_tests.h"
#include "tests/bake/shapes_for_tests.h"
#include "tests/bake/skin_compliance.h"
#include "tissue/mesh/quadratic_mesh.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

namespace {

using bake_tests::organ_text;
using bake_tests::stiffness_ratios;

constexpr double kTip_m = 3e-3;

bake::Recipe recipe_of(const std::string& name) {
    return bake::parse_recipe(organ_text(name), name + ".toml");
}

bake::Baked quadratic(const bake::Recipe& recipe) {
    bake::BakeOptions options;
    options.order = 2;
    return bake::bake(recipe, options);
}

std::string with(std::string text, const std::string& line) {
    return text.insert(text.find('\n', text.find("kind")) + 1, line + "\n");
}

// A2: 7 % in the mean, 15 % at every place.
void check_gates(const tissue::BakedOrgan& organ, const tissue::BakedOrgan& finer) {
    for (const std::uint64_t seed : {1, 2}) {
        const auto r = stiffness_ratios(organ, finer, kTip_m, seed);
        CAPTURE(seed);
        CHECK(std::abs(r.mean - 1.0) < 0.07);
        CHECK(r.low > 0.85);
        CHECK(r.high < 1.15);
    }
}

} // namespace

TEST_CASE("quadratic organ: it has the skin of the linear one, other tetrahedra and another hash") {
    const auto recipe = recipe_of("spleen");
    const auto coarse = quadratic(recipe), fine = bake::bake(recipe, {});
    const auto& organ = coarse.organ;
    CHECK(organ.order == 2);
    CHECK(fine.organ.order == 1);
    CHECK(organ.surface.rest_m == fine.organ.surface.rest_m);
    CHECK(organ.surface.triangles == fine.organ.surface.triangles);
    CHECK(organ.recipe_hash != fine.organ.recipe_hash);
    CHECK(2 * organ.mesh.tets.size() < fine.organ.mesh.tets.size() + 100);
    CHECK(coarse.report.quality.worst_dihedral_deg > 8.0);
    CHECK(std::abs(coarse.report.mesh_volume_m3 / coarse.report.skin_volume_m3 - 1.0) < 0.02);

    const auto nodes = tissue::quadratic_mesh(organ.mesh).rest_m;
    const auto& s = organ.surface;
    for (std::size_t v = 0; v < s.rest_m.size(); ++v) {
        double sum = 0.0;
        glm::dvec3 carried = s.offset_m[v];
        for (auto k = s.row_start[v]; k < s.row_start[v + 1]; ++k) {
            sum += s.row_weight[k];
            carried += s.row_weight[k] * nodes.at(s.row_node[k]);
        }
        CHECK(std::abs(sum - 1.0) < 1e-12);
        CHECK(glm::length(carried - s.rest_m[v]) < 1e-12);
        CHECK(s.mesh_term_n_m[v] == 0.0);
    }
    const auto bytes = tissue::write_organ(organ);
    CHECK(tissue::write_organ(tissue::read_organ(bytes)) == bytes);
}

TEST_CASE(
    "quadratic organ: a spleen, a tube and what hangs on a duct are as stiff as on fine tets") {
    for (const auto& [name, edge_mm] :
         {std::pair{"spleen", 7.0}, std::pair{"artery", 2.0}, std::pair{"gallbladder", 4.5}}) {
        CAPTURE(name);
        auto recipe = recipe_of(name);
        recipe.rod = false;
        const auto coarse = quadratic(recipe).organ;
        CHECK(coarse.mesh.tets.size() >= 150);
        CHECK(coarse.mesh.tets.size() <= 450);
        recipe.quadratic_edge_mm = edge_mm;
        const auto finer = quadratic(recipe).organ;
        CHECK(finer.mesh.tets.size() > 3 * coarse.mesh.tets.size());
        check_gates(coarse, finer);
    }
}

TEST_CASE("quadratic organ: a flap away from its hinge is as stiff as a much finer one") {
    auto recipe = recipe_of("flap");
    const auto baked = quadratic(recipe);
    CHECK(baked.organ.mesh.tets.size() <= 450);
    CHECK(std::abs(baked.report.mesh_volume_m3 / baked.report.skin_volume_m3 - 1.0) < 0.02);
    recipe.quadratic_cells = {24, 18, 2};
    const auto finer = quadratic(recipe).organ;
    const auto places = bake_tests::skin_places(baked.organ.surface, 100, 1);
    const auto w = bake_tests::normal_compliances_mpn(baked.organ, places, kTip_m);
    const auto fine = bake_tests::normal_compliances_mpn(finer, places, kTip_m);
    int away = 0;
    double mean = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (baked.organ.surface.rest_m[places[i]].y > 20e-3)
            continue; // one row of tets goes from here to the hinge, which starts at 34 mm
        ++away;
        mean += fine[i] / w[i];
        CHECK(fine[i] / w[i] == bake_tests::near(1.0, 0.15));
    }
    REQUIRE(away > 50);
    CHECK(mean / away == bake_tests::near(1.0, 0.07));
}

TEST_CASE("quadratic organ: linear tetrahedra lock where these do not") {
    // negative control of the gates: twice as many tets, a tube half again as stiff
    auto recipe = recipe_of("artery");
    recipe.rod = false;
    const auto linear = bake::bake(recipe, {}).organ;
    recipe.quadratic_edge_mm = 2.0;
    CHECK(stiffness_ratios(linear, quadratic(recipe).organ, kTip_m, 1).mean > 1.4);
}

TEST_CASE("quadratic organ: the recipe's own edge or cells go before the rule") {
    const std::string spleen = organ_text("spleen"), flap = organ_text("flap");
    const auto edge = [](const std::string& text, const char* name) {
        const auto recipe = bake::parse_recipe(text, name);
        const auto skin = bake::bake(recipe, {}).organ.surface;
        return bake::quadratic_recipe(recipe, {skin.rest_m, skin.triangles}).edge_mm;
    };
    CHECK(edge(with(spleen, "quadratic_edge_mm = 15"), "s.toml") == 15.0);
    // never finer than linear tets, unless it says so
    std::string coarse = spleen;
    coarse.replace(coarse.find("edge_mm = 9.0"), 13, "edge_mm = 20.0");
    CHECK(edge(coarse, "s.toml") == 20.0);
    CHECK(edge(with(coarse, "quadratic_edge_mm = 15"), "s.toml") == 15.0);

    const auto cells = [](const std::string& text) {
        return std::get<bake::SheetShape>(
                   bake::quadratic_recipe(bake::parse_recipe(text, "f.toml"), {}).shape)
            .cells;
    };
    CHECK(cells(flap) == std::array{7, 6, 1});
    std::string usual = flap;
    usual.replace(usual.find("quadratic_cells"), 27, "");
    CHECK(cells(usual) == std::array{9, 7, 1}); // of 12, 9, 1
}

TEST_CASE("quadratic organ: a box without cells has the edge for 90 nodes, spots grow alike") {
    const auto recipe = recipe_of("block_g12");
    const auto coarse = bake::quadratic_recipe(recipe, {});
    CHECK(coarse.edge_mm * 1e-3 ==
          bake_tests::near(bake::edge_for_nodes(0.08 * 0.08 * 0.04, 0.0256, 90.0), 1e-9));
    CHECK(bake::nodes_for_edge(0.08 * 0.08 * 0.04, 0.0256, coarse.edge_mm * 1e-3) ==
          bake_tests::near(90.0, 1e-9));
    CHECK(coarse.fine.at(0).edge_mm / recipe.fine.at(0).edge_mm ==
          bake_tests::near(coarse.edge_mm / recipe.edge_mm, 1e-12));
}

TEST_CASE(
    "quadratic organ: a key that does not fit the shape, a bad value and scenery are refused") {
    const auto parse = [](const std::string& text) { return bake::parse_recipe(text, "r.toml"); };
    CHECK_THROWS_WITH_AS(parse(with(organ_text("artery"), "quadratic_cells = [2, 2, 2]")),
                         doctest::Contains("quadratic_cells"), bake::RecipeError);
    CHECK_THROWS_WITH_AS(parse(with(organ_text("flap"), "quadratic_edge_mm = 9")),
                         doctest::Contains("quadratic_edge_mm"), bake::RecipeError);
    std::string flap = organ_text("flap");
    flap.replace(flap.find("[7, 6, 1]"), 9, "[2, 0, 2]");
    CHECK_THROWS_WITH_AS(parse(flap), doctest::Contains("quadratic_cells"), bake::RecipeError);
    CHECK_THROWS_WITH_AS(parse(with(organ_text("artery"), "quadratic_edge_mm = 0.2")),
                         doctest::Contains("quadratic_edge_mm"), bake::RecipeError);
    CHECK_THROWS_WITH_AS(quadratic(recipe_of("wall")), doctest::Contains("scenery"), bake::Refused);
}
