#include "assets/bake/bake.h"

#include "tests/bake/recipes_for_tests.h"
#include "tests/bake/shapes_for_tests.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sys/wait.h>

namespace {

namespace fs = std::filesystem;

using bake_tests::organ_text;
using bake_tests::slurp;

const bake::Baked& liver() {
    static const bake::Baked baked =
        bake::bake(bake::parse_recipe(organ_text("liver"), "liver.toml"), {});
    return baked;
}

// A folder of its own for each test, gone afterwards.
struct Folder {
    fs::path path;
    Folder() {
        std::string pattern = (fs::temp_directory_path() / "bake_test_XXXXXX").string();
        REQUIRE(mkdtemp(pattern.data()) != nullptr);
        path = pattern;
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

struct Ran {
    int exit_code = -1;
    std::string errors;
};
Ran run_bake(const Folder& folder, const std::string& arguments) {
    const fs::path errors = folder.path / "errors.txt";
    const std::string command =
        std::string(BAKE_PROGRAM) + " " + arguments + " > /dev/null 2> " + errors.string();
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(errors)};
}

std::string write_recipe(const Folder& folder, const std::string& text) {
    const fs::path file = folder.path / "recipe.toml";
    std::ofstream(file) << text;
    return file.string();
}

// Quick to bake: 80 x 80 x 40 mm in regular cells of 20 mm.
constexpr const char* kBlock = R"(name = "block"
kind = "box"
size_mm = [80, 80, 40]
cells = [4, 4, 2]
skin_mm = 10
[[anchor_box]]
low_mm = [0, 0, 0]
high_mm = [80, 80, 0]
)";

double six_volumes(const tissue::TetMesh& mesh, const tissue::Tet& t) {
    const auto& x = mesh.rest_m;
    return glm::dot(glm::cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]);
}

// Thickness of the skin in z at the point of the inferior margin nearest to x, some way inside.
double margin_thickness_m(const tissue::ContactSurface& skin, double x_m, double inside_m) {
    double low = 1e9;
    for (const auto& p : skin.rest_m) {
        if (std::abs(p.x - x_m) < 4e-3) {
            low = std::min(low, p.y);
        }
    }
    double front = -1e9, back = 1e9;
    for (const auto& p : skin.rest_m) {
        if (std::abs(p.x - x_m) < 6e-3 && std::abs(p.y - low - inside_m) < 3e-3) {
            front = std::max(front, p.z);
            back = std::min(back, p.z);
        }
    }
    return front - back;
}

} // namespace

TEST_CASE("bake: the liver is as large as a liver of the recipe's kind") {
    const auto& skin = liver().organ.surface;
    glm::dvec3 low{1e9}, high{-1e9};
    for (const auto& p : skin.rest_m) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 size_mm = 1e3 * (high - low);
    CHECK(size_mm.x == bake_tests::near(180, 0.06));
    CHECK(size_mm.y == bake_tests::near(120, 0.06));
    CHECK(size_mm.z == bake_tests::near(65, 0.12));
    CHECK(liver().report.skin_volume_m3 > 0.5e-3);
    CHECK(liver().report.skin_volume_m3 < 0.6e-3);
    CHECK(skin.rest_m.size() >= 3000);
    CHECK(skin.rest_m.size() <= 5000);
}

TEST_CASE("bake: the liver's right lobe is large, its left thin, its front margin thin") {
    const auto& skin = liver().organ.surface;
    const auto depth_m = [&](double x_m) {
        double front = -1e9, back = 1e9;
        for (const auto& p : skin.rest_m) {
            if (std::abs(p.x - x_m) < 5e-3) {
                front = std::max(front, p.z);
                back = std::min(back, p.z);
            }
        }
        return front - back;
    };
    CHECK(depth_m(-0.04) > 0.060);
    CHECK(depth_m(0.06) < 0.040);
    // about 5 mm behind the margin, right lobe and left
    for (const double x_m : {-0.05, 0.05}) {
        CHECK(margin_thickness_m(skin, x_m, 5e-3) > 6e-3);
        CHECK(margin_thickness_m(skin, x_m, 5e-3) < 20e-3);
    }
}

TEST_CASE("bake: the liver fits the real-time budget with good tetrahedra") {
    const auto& organ = liver().organ;
    CHECK(organ.mesh.rest_m.size() >= 350);
    CHECK(organ.mesh.rest_m.size() <= 450);
    CHECK(organ.mesh.tets.size() >= 1300);
    CHECK(organ.mesh.tets.size() <= 1800);
    CHECK(std::count(organ.anchored.begin(), organ.anchored.end(), 1) == 0); // the bed holds it
    CHECK(liver().report.quality.worst_dihedral_deg >= 8.0);
    for (const auto& t : organ.mesh.tets) {
        CHECK(six_volumes(organ.mesh, t) > 0.0);
    }
}

TEST_CASE("bake: the liver's tetrahedra keep the skin's volume within 2 % and its shape") {
    const auto& r = liver().report;
    CHECK(std::abs(r.mesh_volume_m3 / r.skin_volume_m3 - 1.0) < 0.02);
    CHECK(r.skin_to_mesh_m < 0.25 * 14e-3); // a quarter of an edge
    CHECK(r.mesh_to_skin_m < 0.25 * 14e-3);
}

TEST_CASE("bake: footprints sum to one, mesh terms soften, and the file holds the organ") {
    const auto& organ = liver().organ;
    const auto& s = organ.surface;
    for (std::size_t v = 0; v < s.rest_m.size(); ++v) {
        double sum = 0.0;
        for (auto i = s.row_start[v]; i < s.row_start[v + 1]; ++i) {
            sum += s.row_weight[i];
        }
        CHECK(sum == bake_tests::near(1.0, 1e-12));
        CHECK(s.mesh_term_n_m[v] >= 0.0);
        CHECK(s.mesh_term_t_m[v] >= 0.0);
    }
    CHECK(*std::max_element(s.mesh_term_n_m.begin(), s.mesh_term_n_m.end()) > 0.0);
    const auto bytes = tissue::write_organ(organ);
    CHECK(tissue::write_organ(tissue::read_organ(bytes)) == bytes);
}

TEST_CASE("bake: the bed lies in the recipe's regions and fills what the body has of them") {
    const auto recipe = bake::parse_recipe(organ_text("liver"), "liver.toml");
    const auto& organ = liver().organ;
    const auto inside = [&](const glm::dvec3& place_m) {
        const glm::dvec3 p = 1e3 * place_m;
        bool in = false;
        for (const auto& b : recipe.anchor_boxes) {
            in = in || (p.x >= b.low_mm.x && p.x <= b.high_mm.x && p.y >= b.low_mm.y &&
                        p.y <= b.high_mm.y && p.z >= b.low_mm.z && p.z <= b.high_mm.z);
        }
        for (const auto& s : recipe.anchor_spheres) {
            in = in || glm::length(p - s.centre_mm) <= s.radius_mm;
        }
        return in;
    };
    double held_m3 = 0.0;
    for (const auto& sample : organ.bed) {
        glm::dvec3 place_m{0.0};
        for (int k = 0; k < 4; ++k) {
            place_m += sample.weight[k] * organ.mesh.rest_m[organ.mesh.tets[sample.tet][k]];
        }
        CHECK(inside(place_m));
        held_m3 += sample.stiffness_m * 1e-6 * recipe.hold_length_mm * recipe.hold_length_mm;
    }
    // the same volume by chance
    std::mt19937_64 random(3);
    double counted_m3 = 0.0;
    constexpr int kDarts = 200;
    for (const auto& t : organ.mesh.tets) {
        for (int dart = 0; dart < kDarts; ++dart) {
            std::array<double, 4> w{};
            double sum = 0.0;
            for (double& x : w) {
                x = -std::log((static_cast<double>(random() >> 11) + 1.0) * 0x1p-53);
                sum += x;
            }
            glm::dvec3 place_m{0.0};
            for (int k = 0; k < 4; ++k) {
                place_m += w[k] / sum * organ.mesh.rest_m[t[k]];
            }
            counted_m3 += inside(place_m) ? six_volumes(organ.mesh, t) / 6.0 / kDarts : 0.0;
        }
    }
    CHECK(held_m3 == bake_tests::near(counted_m3, 0.01));
}

TEST_CASE("bake: the graded liver has the liver's skin on other tetrahedra") {
    auto recipe = bake::parse_recipe(organ_text("liver_graded"), "liver_graded.toml");
    const auto graded = bake::bake(recipe, {});
    CHECK(graded.organ.surface.rest_m == liver().organ.surface.rest_m);
    CHECK(graded.organ.surface.triangles == liver().organ.surface.triangles);
    CHECK(graded.organ.mesh.rest_m.size() > liver().organ.mesh.rest_m.size() + 100);
    CHECK(graded.report.quality.worst_dihedral_deg >= 8.0);

    // near the fine spot the boundary's edges are as short as asked
    const auto& spot = recipe.fine.at(0);
    double sum_mm = 0.0;
    int count = 0;
    for (const auto& t : graded.boundary.triangles) {
        const glm::dvec3 a = 1e3 * graded.boundary.point_m[t[0]],
                         b = 1e3 * graded.boundary.point_m[t[1]];
        if (glm::length(0.5 * (a + b) - spot.centre_mm) < spot.radius_mm) {
            sum_mm += glm::length(a - b), ++count;
        }
    }
    REQUIRE(count > 10);
    CHECK(sum_mm / count == bake_tests::near(spot.edge_mm, 0.15));
}

TEST_CASE("bake: a block of regular cells is the block, with its top as skin") {
    const auto baked = bake::bake(bake::parse_recipe(kBlock, "b.toml"), {});
    CHECK(baked.organ.mesh.rest_m.size() == 5 * 5 * 3);
    CHECK(baked.organ.mesh.tets.size() == 4 * 4 * 2 * 6);
    CHECK(baked.organ.surface.rest_m.size() == 9 * 9);
    CHECK(std::count(baked.organ.anchored.begin(), baked.organ.anchored.end(), 1) == 5 * 5);
}

TEST_CASE("bake: the wall is a rigid skin without tetrahedra") {
    const auto wall = bake::bake(bake::parse_recipe(organ_text("wall"), "wall.toml"), {});
    CHECK(wall.organ.rigid);
    CHECK(wall.organ.mesh.rest_m.empty());
    CHECK(wall.organ.surface.neighbours.size() == wall.organ.surface.triangles.size());
    CHECK_NOTHROW(tissue::read_organ(tissue::write_organ(wall.organ)));
}

TEST_CASE("bake: an organ that nothing holds is a mistake in the recipe") {
    std::string text = kBlock;
    text.replace(text.find("high_mm = [80, 80, 0]"), 21, "high_mm = [1, 1, 0]  ");
    CHECK_THROWS_WITH_AS(bake::bake(bake::parse_recipe(text, "b.toml"), {}),
                         doctest::Contains("1 of 75 nodes"), bake::RecipeError);
}

TEST_CASE("bake program: the same recipe gives the same bytes, and nothing is left over") {
    const Folder folder;
    const std::string recipe = fs::path(ORGAN_RECIPES) / "block_u12.toml";
    for (const char* const name : {"a", "b"}) {
        const fs::path out = folder.path / (std::string(name) + ".organ");
        const auto ran = run_bake(folder, recipe + " --out " + out.string() + " --report " +
                                              (folder.path / "r.json").string() + " --obj " +
                                              (folder.path / "o.obj").string());
        CHECK(ran.exit_code == 0);
        CHECK_FALSE(fs::exists(out.string() + ".part"));
    }
    const std::string a = slurp(folder.path / "a.organ");
    CHECK(a.size() > 10'000);
    CHECK(a == slurp(folder.path / "b.organ"));
    const auto report = nlohmann::json::parse(slurp(folder.path / "r.json"));
    CHECK(report["volume_m3"].get<double>() == bake_tests::near(0.08 * 0.08 * 0.04));
    CHECK(report["attempts"][0]["outcome"] == "done");
    const std::string obj = slurp(folder.path / "o.obj");
    CHECK(obj.find("o skin\n") == 0);
    CHECK(obj.find("o boundary\n") != std::string::npos);
}

TEST_CASE("bake program: the liver of another process is the liver of this one") {
    const Folder folder;
    const fs::path out = folder.path / "liver.organ";
    run_bake(folder, (fs::path(ORGAN_RECIPES) / "liver.toml").string() + " --out " + out.string());
    const auto bytes = tissue::write_organ(liver().organ);
    CHECK(slurp(out) == std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

TEST_CASE("bake program: another edge is another organ with another hash") {
    const Folder folder;
    const std::string recipe = fs::path(ORGAN_RECIPES) / "block_u12.toml";
    const fs::path out = folder.path / "a.organ", report = folder.path / "r.json";
    std::array<std::string, 2> hash;
    std::array<int, 2> nodes{};
    for (std::size_t i = 0; i < 2; ++i) {
        run_bake(folder, recipe + " --out " + out.string() + " --report " + report.string() +
                             (i == 0 ? " --edge 16" : " --edge 20"));
        const auto j = nlohmann::json::parse(slurp(report));
        hash[i] = j["recipe_hash"];
        nodes[i] = j["nodes"];
    }
    CHECK(hash[0] != hash[1]);
    CHECK(nodes[0] > nodes[1]);
}

TEST_CASE("bake program: a hopeless time limit is refused with exit code 1 and no file") {
    const Folder folder;
    const fs::path out = folder.path / "a.organ";
    const auto ran = run_bake(folder, (fs::path(ORGAN_RECIPES) / "block_u12.toml").string() +
                                          " --out " + out.string() + " --time-limit 1e-6");
    CHECK(ran.exit_code == 1);
    CHECK(ran.errors.find("without quality: not done within 1e-06 s") != std::string::npos);
    CHECK_FALSE(fs::exists(out));
    CHECK_FALSE(fs::exists(out.string() + ".part"));
}

TEST_CASE("bake program: bad input is exit code 2, with the place") {
    const Folder folder;
    const std::string out = " --out " + (folder.path / "a.organ").string();
    std::string text = kBlock;
    text.replace(text.find("skin_mm = 10"), 12, "skin_mm = 0 ");
    const auto bad = run_bake(folder, write_recipe(folder, text) + out);
    CHECK(bad.exit_code == 2);
    CHECK(bad.errors.find("recipe.toml:5: skin_mm = 0: accepted:") != std::string::npos);

    CHECK(run_bake(folder, (folder.path / "none.toml").string() + out).exit_code == 2);
    CHECK(run_bake(folder, write_recipe(folder, kBlock)).exit_code == 2); // no --out
    CHECK(run_bake(folder, write_recipe(folder, kBlock) + out + " --edge 0").exit_code == 2);
    CHECK(run_bake(folder, write_recipe(folder, kBlock) + " --out /nowhere/a.organ").exit_code ==
          2);
}
