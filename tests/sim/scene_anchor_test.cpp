// tests/sim/scene_anchor_test.cpp
// What a scene's anchors hold, against the volume and the middle of the body they describe; and
// that no bytes in a region file do harm.
#include "tests/sim/scene_fixture.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <numbers>

using namespace scene_tests;

namespace {

struct Held {
    double volume_m3 = 0.0;
    glm::dvec3 middle_m{0.0};
};

// Moments of the block's bed, from its samples.
Held held(const Directory& directory, double length_m = 10e-3) {
    const sim::LoadedScene scene = sim::load_scene(directory.path());
    const tissue::BakedOrgan& organ = *scene.organ[0];
    Held out;
    for (const tissue::BedSample& sample : organ.bed) {
        const double volume_m3 = sample.stiffness_m * length_m * length_m;
        glm::dvec3 place_m{0.0};
        for (std::size_t k = 0; k < 4; ++k)
            place_m += sample.weight[k] * organ.mesh.rest_m[organ.mesh.tets[sample.tet][k]];
        out.volume_m3 += volume_m3;
        out.middle_m += volume_m3 * place_m;
    }
    out.middle_m /= out.volume_m3;
    CHECK(std::count(organ.anchored.begin(), organ.anchored.end(), 1) == 0);
    return out;
}

void anchor_with(const Directory& directory, const std::string& anchor) {
    directory.write("scene.toml",
                    with(kScene, "low_mm = [-1, -1, -1]\nhigh_mm = [81, 81, 10]\n", anchor));
}

double ball_m3(double radius_m) {
    return 4.0 / 3.0 * std::numbers::pi * radius_m * radius_m * radius_m;
}

// A region file that is refused, with what the message must hold.
std::string refusal(const std::string& text) {
    try {
        sim::parse_region(text, "r.txt");
    } catch (const tasks::BadInput& e) {
        return e.what();
    }
    return "accepted";
}

} // namespace

// Parts of a tet across the rim count whole or not at all: 1/64 of 1728/6 mm^3 each, of either
// sign. 3 % of the volumes of balls is some ten times their expected sum. Of a box they may be of
// one sign: its face at z = 10 mm goes through the middles of octahedra, four parts each, which
// count whole. They are 1/4 of a layer of parts, 10/3 mm: 1/8 lies beyond.
constexpr double kBox_m3 = 80e-3 * 80e-3 * (10e-3 + 10e-3 / 3.0 / 8.0);

TEST_CASE("anchor: a box holds its volume, in its middle") {
    const Directory directory;
    const Held box = held(directory);
    CHECK(box.volume_m3 == doctest::Approx(kBox_m3).scale(0.0).epsilon(1e-9));
    CHECK(glm::distance(box.middle_m, {40e-3, 40e-3, 5e-3}) < 0.3e-3);
}

TEST_CASE("anchor: a box that ends on the mesh's own faces is held exactly") {
    const Directory directory;
    anchor_with(directory, fmt::format("low_mm = [0, 0, 0]\nhigh_mm = [80, 80, {}]\n", 40.0 / 3.0));
    CHECK(held(directory).volume_m3 ==
          doctest::Approx(80e-3 * 80e-3 * 40e-3 / 3.0).scale(0.0).epsilon(1e-9));
}

TEST_CASE("anchor: a sphere holds its volume, in its middle") {
    const Directory directory;
    anchor_with(directory, "centre_mm = [42, 39, 19]\nradius_mm = 15\n");
    const Held ball = held(directory);
    CHECK(ball.volume_m3 == doctest::Approx(ball_m3(15e-3)).scale(0.0).epsilon(0.03));
    CHECK(glm::distance(ball.middle_m, {42e-3, 39e-3, 19e-3}) < 0.3e-3);
}

TEST_CASE("anchor: touching holds the layer that is near enough to the other organ") {
    const Directory directory;
    directory.put(plate({-200, -200}, {300, 300}, -2.0, true));
    directory.write("scene.toml", with(std::string(kScene) + kPlate,
                                       "low_mm = [-1, -1, -1]\nhigh_mm = [81, 81, 10]\n",
                                       "touching = \"plate\"\nwithin_mm = 12\n"));
    const Held layer = held(directory);
    CHECK(layer.volume_m3 == doctest::Approx(kBox_m3).scale(0.0).epsilon(1e-9));
    CHECK(glm::distance(layer.middle_m, {40e-3, 40e-3, 5e-3}) < 0.3e-3);
}

TEST_CASE("anchor: a painted region holds its balls, and anchors add up") {
    const Directory directory;
    anchor_with(directory, "region = \"left.txt\"\n\n[[organ.anchor]]\ncentre_mm = [60, 60, 20]\n"
                           "radius_mm = 12\n");
    directory.write("left.txt", "# two of one size\n20 20 20 12\n20\t60 20  12 # the other\r\n\n");
    const Held region = held(directory);
    CHECK(region.volume_m3 == doctest::Approx(3.0 * ball_m3(12e-3)).scale(0.0).epsilon(0.03));
    CHECK(glm::distance(region.middle_m, glm::dvec3{100e-3 / 3.0, 140e-3 / 3.0, 20e-3}) < 0.4e-3);
}

TEST_CASE("anchor: the hold length is the bed's") {
    const Directory directory;
    directory.write("scene.toml",
                    with(kScene, "young_kpa = 6.0", "young_kpa = 6.0\nhold_length_mm = 5"));
    CHECK(held(directory, 5e-3).volume_m3 == doctest::Approx(kBox_m3).scale(0.0).epsilon(1e-9));
}

TEST_CASE("anchor: one that meets no tissue leaves the organ afloat, and both are said") {
    const Directory directory;
    anchor_with(directory, "centre_mm = [500, 0, 0]\nradius_mm = 5\n");
    const sim::SceneCheck check = directory.check();
    REQUIRE(check.mistakes.empty());
    REQUIRE(check.finding.size() >= 2);
    CHECK(check.finding[0].kind == "anchor_empty");
    CHECK(check.finding[0].at.line == 10);
    CHECK(check.finding[0].at.key == "centre_mm");
    CHECK(check.finding[1].kind == "not_held");
    // and every target of the exercise has nothing to be pressed against
    CHECK(std::count_if(check.finding.begin(), check.finding.end(),
                        [](const auto& f) { return f.kind == "not_held"; }) == 4);
}

TEST_CASE("region: what is not four numbers in range is refused with its line") {
    const std::string accepted = ": x y z r in millimetres: three numbers from -1000 to 1000 and a "
                                 "radius above 0, at most 500";
    CHECK(refusal("1 2 3 4\n# ok\nnan 2 3 4\n") == "r.txt:3: ball = nan 2 3 4" + accepted);
    CHECK(refusal("1 2 3 inf\n") == "r.txt:1: ball = 1 2 3 inf" + accepted);
    CHECK(refusal("1 2 3 0\n") == "r.txt:1: ball = 1 2 3 0" + accepted);
    CHECK(refusal("1 2 3 -4\n") == "r.txt:1: ball = 1 2 3 -4" + accepted);
    CHECK(refusal("1 2 3\n") == "r.txt:1: ball = 1 2 3" + accepted);
    CHECK(refusal("1 2 3 4 5\n") == "r.txt:1: ball = 1 2 3 4 5" + accepted);
    CHECK(refusal("1e999 2 3 4\n") == "r.txt:1: ball = 1e999 2 3 4" + accepted);
    CHECK(refusal("1001 2 3 4\n") == "r.txt:1: ball = 1001 2 3 4" + accepted);
    CHECK(refusal("1,2,3,4\n") == "r.txt:1: ball = 1,2,3,4" + accepted);
}

TEST_CASE("region: bytes that are no text are refused and never shown raw") {
    std::string bytes("\x7f"
                      "ELF\x02\x1b[2J\0\xff",
                      11);
    const std::string message = refusal("1 2 3 4\n" + bytes);
    CHECK(message.substr(0, 16) == "r.txt:2: ball = ");
    CHECK(std::all_of(message.begin(), message.end(), [](char c) { return c >= ' ' && c <= '~'; }));
}

TEST_CASE("region: too many balls are refused at the first too many, too many bytes at once") {
    std::string lines;
    for (std::size_t i = 0; i < sim::kMaxRegionBalls; ++i)
        lines += "1 2 3 4\n";
    CHECK(refusal(lines) == "accepted");
    CHECK(refusal(lines + "1 2 3 4\n") == "r.txt:4097: ball = 1 2 3 4: at most 4096 balls");
    CHECK(refusal(std::string(sim::kMaxRegionBytes + 1, '\n')) ==
          "r.txt:1: size = 1048577 bytes: a region of at most 1048576 bytes");
    CHECK(refusal("# nothing\n\n") ==
          "r.txt:1: ball is missing: at least one line x y z r in millimetres");
}

TEST_CASE("region: a file larger than the limit is not even read") {
    const Directory directory;
    anchor_with(directory, "region = \"huge.txt\"\n");
    directory.write("huge.txt", "");
    std::filesystem::resize_file(directory.folder / "huge.txt", std::uintmax_t{1} << 40); // sparse
    const sim::SceneCheck check = directory.check();
    REQUIRE(check.mistakes.size() == 1);
    CHECK(check.mistakes[0].at.line == 10);
    CHECK(check.mistakes[0].at.value == "\"huge.txt\"");
    CHECK(check.mistakes[0].accepted.find("at most 1048576") != std::string::npos);
}
