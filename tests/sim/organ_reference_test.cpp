// tests/sim/organ_reference_test.cpp
// The organ study beside the reference: the trainer's law on a block, and how gaps and gates are
// told.
#include "sim/study/organ_reference.h"
#include "sim/study/organ_study.h"
#include "sim/study/reference_record.h"

#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <unistd.h>

namespace fs = std::filesystem;

namespace {

sim::OrganReferenceOptions block() {
    sim::OrganReferenceOptions o;
    o.organ = "block_s12";
    o.places = 1;
    o.press.radius_m = 2.5e-3;
    o.press.edge_share = 1.0;
    o.press.core_share = 0.8;
    o.press.down_share = 0.0;
    o.press.depth_m = {1e-3, 2e-3};
    return o;
}

constexpr int kLiverPlaces = 10; // that are recorded

// One place, two depths, of which the reference reached the first alone.
sim::OrganReference halfway() {
    sim::OrganReference study;
    study.place.push_back({.normal = {0, 0, 1}, .force_n = {{0, 0, 0.05}, {0, 0, 0.2}}});
    study.reference.push_back({.force_n = {{0, 0, 0.04}}, .reached_m = 1.5e-3});
    study.row.push_back({.depth_m = 1e-3,
                         .force_n = 0.05,
                         .reference_n = 0.04,
                         .error_n = 0.01,
                         .error_percent = 25.0,
                         .stiffness_percent = 25.0,
                         .solved = true,
                         .a1 = true,
                         .a3 = true});
    study.row.push_back({.depth_m = 2e-3, .force_n = 0.2});
    return study;
}

std::string file(const sim::OrganReferenceOptions& o, const sim::OrganReference& study,
                 const char* wanted) {
    for (const auto& [name, text] : organ_reference_files(o, study)) {
        if (name == wanted)
            return text;
    }
    return "";
}

} // namespace

TEST_CASE("organ reference: shallow, on a block of 256 nodes, the law is inside A1 to A3") {
    const auto o = block();
    const auto study = sim::run_organ_reference(o, [](const std::string&) {});
    const auto s = summary_of(o, study);
    REQUIRE(s.solved == 2);
    CHECK(s.a1 == 2);
    CHECK(s.a2 == 2);
    CHECK(s.a3 == 2);
    // tighter than A1 for such small forces: 7 % of them
    CHECK(s.worst_percent < 7.0);
    CHECK(study.reference[0].penetration_m < 0.02 * o.press.radius_m);
}

TEST_CASE("organ reference: a press to no depth is refused") {
    auto o = block();
    o.press.depth_m.clear();
    const auto organ = sim::load_organ(o.organ);
    CHECK_THROWS_WITH(sim::press_reference(*organ, o.material, {}, {0, 0, -1}, o.press),
                      doctest::Contains("at least one depth"));
}

TEST_CASE("organ reference: a wrong modulus in the law alone would be seen") {
    // negative control: the same places, the law of tissue 1.5 times as stiff
    auto o = block();
    o.press.depth_m = {2e-3};
    const auto study = sim::run_organ_reference(o, [](const std::string&) {});
    o.material.young_pa *= 1.5;
    sim::TrainerTip stiffer(sim::load_organ(o.organ), o.material, o.press.radius_m,
                            o.press.friction, o.tier);
    const auto& at = study.place[0];
    const double force_n =
        glm::length(stiffer.press(at.place_m, -at.normal, o.press.depth_m).force_n[0]);
    CHECK(std::abs(force_n / study.row[0].reference_n - 1.0) > 0.4);
}

TEST_CASE("organ reference: where the reference stops there is a gap, in CSV, page and summary") {
    auto o = block();
    const auto study = halfway();
    const auto s = summary_of(o, study);
    CHECK(s.rows == 2);
    CHECK(s.solved == 1);
    CHECK(s.places_to_the_end == 0);
    CHECK(s.places_inside == 0);
    CHECK(s.least_reached_m == 1.5e-3);
    CHECK(file(o, study, "reference.csv").find(",2,0.200000,,,,0.00,,,,,,,0") != std::string::npos);
    CHECK(file(o, study, "reference.md").find("no equilibrium at 1 of 2 depths") !=
          std::string::npos);
    CHECK(file(o, study, "reference.svg").find("no equilibrium beyond 1.5 mm") !=
          std::string::npos);
}

TEST_CASE("organ reference: a trainer's step that was not at rest, or warped, is told") {
    auto study = halfway();
    CHECK(file(block(), study, "reference.md").find("Place 1:") == std::string::npos);
    CHECK(file(block(), study, "reference.json").find("\"places_not_settled\": 0") !=
          std::string::npos);
    study.place[0].settled = false;
    study.place[0].warped = true;
    const std::string page = file(block(), study, "reference.md");
    CHECK(page.find("Place 1: the trainer's force still changed") != std::string::npos);
    CHECK(page.find("Place 1: some step of the trainer fell back") != std::string::npos);
    CHECK(file(block(), study, "reference.json").find("\"places_not_settled\": 1") !=
          std::string::npos);
}

TEST_CASE("organ reference: what cannot be pressed is refused with the value") {
    auto o = block();
    o.press.radius_m = 0.5;
    CHECK_THROWS_WITH(sim::run_organ_reference(o, {}), doctest::Contains("tip radius 500"));
    o = block();
    o.hold = {.toward = {0, 0, -1}, .share = 1.5};
    CHECK_THROWS_WITH(sim::run_organ_reference(o, {}), doctest::Contains("--hold-share 1.5"));
    o = block();
    o.hold = {.toward = {0, std::nan(""), -1}};
    CHECK_THROWS_WITH(sim::run_organ_reference(o, {}), doctest::Contains("--hold-toward 0 nan -1"));
    o = block();
    o.press.depth_m = {};
    CHECK_THROWS_WITH(sim::run_organ_reference(o, {}), doctest::Contains("at least one depth"));
}

TEST_CASE("organ reference: what was pressed is kept to the last bit, and is no other study's") {
    const fs::path file =
        fs::temp_directory_path() / ("trocar_presses_" + std::to_string(getpid()) + ".txt");
    const std::vector<sim::ReferencePress> presses{
        {.force_n = {{0.1, -0.2, 1.0 / 3.0}, {0, 0, 2.0 / 3.0}},
         .reached_m = 2e-3,
         .nodes = 7,
         .cpu_s = 1.5},
        {.force_n = {}, .reached_m = 0.0, .stopped = "at 0.10 mm: residual 1e-02"}};
    write_presses(file, "# one", presses);
    const auto read = sim::read_presses(file, "# one");
    REQUIRE(read.size() == 2);
    CHECK(read[0].force_n == presses[0].force_n);
    CHECK(read[0].reached_m == presses[0].reached_m);
    CHECK(read[0].nodes == 7);
    CHECK(read[0].stopped.empty());
    CHECK(read[1].stopped == presses[1].stopped);
    CHECK(sim::read_presses(file, "# two").empty());
    CHECK(sim::read_presses(file.string() + ".none", "# one").empty());
    std::ofstream(file, std::ios::app) << "0.1 0 cut off";
    CHECK_THROWS_WITH(sim::read_presses(file, "# one"),
                      doctest::Contains("press 3 cannot be read"));
    fs::remove(file);
}

TEST_CASE("organ reference: deep and stuck, on a block of 256 nodes, the law is inside A1") {
    // 2.4 tip radii; small strain is 4 % softer there
    auto o = block();
    o.press.friction = std::numeric_limits<double>::infinity();
    o.press.depth_m = {6e-3};
    const auto study = sim::run_organ_reference(o, [](const std::string&) {});
    REQUIRE(summary_of(o, study).solved == 1);
    CHECK(std::abs(study.row[0].error_percent) < 7.0);
}

TEST_CASE("organ reference: a 3 mm tip to 10 mm on the liver is inside A1, A2 and A3") {
    // the reference's presses take minutes each; made anew into another record by
    //   trocar study organ liver --reference --friction inf --edge 0.5 --core 1.5 --down 0
    //     --facets --out DIR
    sim::OrganReferenceOptions o;
    o.organ = "liver";
    o.material.young_pa = 5.4e3;
    o.places = kLiverPlaces;
    o.press.friction = std::numeric_limits<double>::infinity();
    o.press.edge_share = 0.5;
    o.press.core_share = 1.5;
    o.press.down_share = 0.0;
    o.press.onto_skin = false;
    for (int i = 1; i <= 20; ++i)
        o.press.depth_m.push_back(0.5e-3 * i);
    o.record = fs::path(TROCAR_SOURCE) / "tests/data/presses/liver.presses";
    o.only_recorded = true;
    o.tips.steps = 10;
    const auto study = sim::run_organ_reference(o, [](const std::string&) {});
    const auto s = summary_of(o, study);
    CHECK(s.solved == 20 * kLiverPlaces);
    CHECK(s.places_to_the_end == kLiverPlaces);
    for (const sim::ReferenceRow& row : study.row) {
        CAPTURE(row.place);
        CAPTURE(row.depth_m);
        CHECK(row.a1);
        // these presses, of flat facets and with a first step that slides, lean at a first touch of
        // less than 10 mN, which nobody feels
        CHECK(((row.a2 && row.a3) || row.reference_n < 0.01));
    }
    CHECK(s.a2 >= s.solved - 2);
    CHECK(s.a3 >= s.solved - 2);
    // a place that is not recorded is not pressed
    o.places = kLiverPlaces + 1;
    CHECK_THROWS_WITH(sim::run_organ_reference(o, [](const std::string&) {}),
                      doctest::Contains("there is none of place"));
}
