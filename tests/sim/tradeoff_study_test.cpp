// The tradeoff study judges ways by their worst step, draws what failed, and takes what peers say.
#include "sim/study/tradeoff_study.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <unistd.h>

namespace {

using glm::dvec3;

std::string text_of(const std::vector<std::pair<std::string, std::string>>& files,
                    const std::string& name) {
    for (const auto& [file, text] : files)
        if (file == name)
            return text;
    return {};
}

// Few steps on few cells.
sim::TradeoffOptions small() {
    sim::TradeoffOptions o;
    o.beam.steps = 8;
    o.works = {{"quadratic", {4, 1, 1}}, {"corotated", {4, 1, 1}}, {"tled", {4, 1, 1}}};
    o.reference_cells = {4, 1, 1};
    o.rounds = 1;
    o.peers = {"mujoco"};
    o.peer_cells = {{2, 1, 1}};
    o.peer_dir = "/no/such/place";
    return o;
}

struct Folder {
    std::filesystem::path path = std::filesystem::temp_directory_path() /
                                 ("trocar_tradeoff_test_" + std::to_string(getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
    // A program of that name that says `text` whatever it is asked.
    void program(const std::string& name, const std::string& text) const {
        std::ofstream(path / name) << "#!/bin/sh\ncat <<'END'\n" << text << "\nEND\n";
        std::filesystem::permissions(path / name, std::filesystem::perms::owner_all);
    }
};

} // namespace

TEST_CASE("tradeoff: a fall is as wrong as its worst step, a way that ends early is not judged") {
    sim::TradeoffReference reference;
    reference.rest_m = {0.0, -0.1, 0.0};
    reference.fall_m = {{0.0, -0.01, 0.0}, {0.0, -0.2, 0.0}, {0.0, -0.1, 0.0}};
    reference.lowest = sim::first_lowest(reference.fall_m);
    CHECK(reference.lowest == 2);
    const std::vector<dvec3> fall{{0.0, -0.012, 0.0}, {0.003, -0.2, 0.004}, {0.0, -0.12, 0.0}};
    sim::TradeoffRow row;
    sim::judge(reference, fall, {0.0, -0.1, 0.002}, row);
    CHECK(std::abs(row.rest_percent - 2.0) < 1e-9);
    CHECK(std::abs(row.fall_percent - 2.5) < 1e-9);      // 5 mm of 200
    CHECK(std::abs(row.fall_own_percent - 20.0) < 1e-9); // 2 mm of 10
    CHECK(std::abs(row.swing_percent - 10.0) < 1e-9);    // 20 mm of 200, on the way back
    sim::TradeoffRow ended;
    sim::judge(reference, std::span(fall).first(2), dvec3{NAN}, ended);
    CHECK(std::isnan(ended.fall_percent));
    CHECK(std::isnan(ended.rest_percent));
}

TEST_CASE("tradeoff: tiny meshes make every file, a missing peer is a gap with its reason") {
    const sim::TradeoffOptions o = small();
    const auto study = sim::run_tradeoff_study(o, [](const auto&) {});
    REQUIRE(study.row.size() == 3);
    // the same discretisation as the reference's coarsest mesh: its error is what that one misses
    const sim::TradeoffRow& quadratic = study.row[0];
    CHECK(quadratic.linear_residual <= 1e-3);
    CHECK(quadratic.residual <= 1e-3);
    CHECK(quadratic.factor_ms > 0.0);
    CHECK(quadratic.solve_ms > 0.0);
    CHECK(study.row[1].rest_percent > 2.0 * quadratic.rest_percent); // it locks
    CHECK(std::isnan(study.row[1].factor_ms));
    REQUIRE(study.gap.size() == 1);
    const auto files = sim::tradeoff_files(o, study);
    const std::string csv = text_of(files, "tradeoff.csv"), page = text_of(files, "tradeoff.md");
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 3);
    CHECK(page.find("Missing: mujoco: on 2x1x1: /no/such/place/mujoco_peer is not there") !=
          std::string::npos);
    CHECK(page.find("corotated: none of these meshes") != std::string::npos);
    for (const char* chart : {"tradeoff.svg", "tradeoff_fall.svg"})
        CHECK(text_of(files, chart).find("quadratic, matrix factored anew") != std::string::npos);
}

TEST_CASE("tradeoff: what failed is drawn as failed") {
    sim::TradeoffOptions o = small();
    sim::TradeoffStudy study;
    sim::TradeoffRow row;
    row.model = "tled";
    row.ms.mean = 1.0;
    row.rest_percent = 5.0; // at rest it may be right
    row.failure = "exploded at t = 0.1";
    study.row = {row};
    const std::string svg = text_of(sim::tradeoff_files(o, study), "tradeoff.svg");
    CHECK(svg.find("failed, or beyond the axis") != std::string::npos);
}

TEST_CASE("tradeoff: a peer is judged as our models are, and what it mumbles is a gap") {
    const Folder folder;
    sim::TradeoffOptions o = small();
    o.peer_dir = folder.path;
    sim::TradeoffStudy study;
    study.reference.rest_m = {0.0, -0.1, 0.0};
    study.reference.fall_m = {{0.0, -0.1, 0.0}};
    study.reference.lowest = 1;
    folder.program("mujoco_peer",
                   R"({"versions": {"mujoco": "4.0.0"}, "nodes": 12, "tets": 12,
                       "tip_m": [0, -0.05, 0], "tip_each_step_m": [[0, -0.09, 0]],
                       "cpu_ms": {"mean": 1.5, "p50": 1.4, "p99": 2.5, "max": 3.0},
                       "linear_residual": {"max": 0.01}, "bad_states": 0, "settled": true})");
    sim::add_peer(
        o, "mujoco", [](const auto&) {}, study);
    REQUIRE(study.row.size() == 1);
    const sim::TradeoffRow& r = study.row[0];
    CHECK(r.model == "mujoco 4.0.0");
    CHECK(r.ms.p99 == 2.5);
    CHECK(r.linear_residual == 0.01);
    CHECK(std::abs(r.rest_percent - 50.0) < 1e-9);
    CHECK(std::abs(r.fall_percent - 10.0) < 1e-9);
    CHECK(r.failure.empty());
    folder.program("mujoco_peer", "segmentation fault");
    sim::add_peer(
        o, "mujoco", [](const auto&) {}, study);
    o.beam.length_m = 0.3;
    sim::add_peer(
        o, "mujoco", [](const auto&) {}, study);
    REQUIRE(study.gap.size() == 2);
    CHECK(study.gap[0].second.find("not understood") != std::string::npos);
    CHECK(study.gap[1].second.find("it knows only the beam") != std::string::npos);
}

TEST_CASE("tradeoff: unknown models and impossible numbers are refused before anything runs") {
    for (const auto change : {+[](sim::TradeoffOptions& o) {
                                  o.works = {{"magic", {2, 1, 1}}};
                              },
                              +[](sim::TradeoffOptions& o) { o.beam.material.poisson = 0.5; },
                              +[](sim::TradeoffOptions& o) { o.rounds = 0; }}) {
        sim::TradeoffOptions o = small();
        change(o);
        bool ran = false;
        CHECK_THROWS_AS(sim::run_tradeoff_study(o, [&](const auto&) { ran = true; }),
                        std::invalid_argument);
        CHECK(!ran);
    }
}

TEST_CASE("tradeoff: every model stands on at least four meshes") {
    const auto works = sim::tradeoff_works();
    for (const char* model : sim::solid_models())
        CHECK(std::ranges::count_if(works, [&](const auto& w) { return w.model == model; }) >= 4);
}
