// What `trocar study beam`, `block` and `cook` print, and what they say to bad input.
#include "tests/sim/command_fixture.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <unistd.h>

using namespace command_tests;

namespace {

void refused(const std::string& arguments, const std::string& says) {
    const Answer answer = trocar("study " + arguments);
    CAPTURE(arguments);
    CAPTURE(answer.text);
    CHECK(answer.exit_code == 2);
    CHECK(answer.text.find(says) != std::string::npos);
}

} // namespace

TEST_CASE("study beam, block, cook: the object has every key that others rely on") {
    for (const char* what : {"beam --cells 4x1x1 --steps 3", "block --cells 2x2x2 --static",
                             "cook --cells 2x2x1 --static --model linear --json"}) {
        CAPTURE(what);
        const auto j = json_of(std::string("study ") + what);
        REQUIRE(j["tip_m"].size() == 3);
        for (const auto& x : j["tip_m"])
            CHECK(x.is_number_float());
        CHECK(j["force_n"].size() == 1);
        CHECK(j["depth_m"].size() == 1);
        for (const char* key : {"nodes", "tets", "newton_iterations"})
            CHECK(j[key] > 0);
        CHECK(j["relative_residual"] < 1e-3);
        for (const char* key : {"mean", "p50", "p99", "max"})
            CHECK(j["ms_per_step"][key] > 0.0);
        CHECK(j["settled"].is_boolean());
    }
}

TEST_CASE(
    "study beam: a bar without lateral contraction bends as Timoshenko's, row by row in a file") {
    const auto folder =
        std::filesystem::temp_directory_path() / ("trocar_beam_test_" + std::to_string(getpid()));
    const std::string bar = "study beam --length 0.1 --height 0.02 --width 0.02 --young 10 "
                            "--poisson 0 --gravity 0 --static --model linear --load 0.01 0.02 ";
    const auto j = json_of(bar + "--out '" + folder.string() + "'");
    // 25.000 + 0.600 mm by Timoshenko and Cowper, twice that for twice the load
    CHECK(std::abs(j["depth_m"][0].get<double>() - 25.6e-3) < 5e-3 * 25.6e-3);
    CHECK(std::abs(j["depth_m"][1].get<double>() - 51.2e-3) < 5e-3 * 51.2e-3);
    CHECK(j["force_n"][1] == 0.02);
    std::ifstream in(folder / "trajectory.csv");
    std::string line;
    int rows = -1;
    while (std::getline(in, line))
        ++rows;
    CHECK(rows == 2);
    std::filesystem::remove_all(folder);
}

TEST_CASE("study block: a punch on a block of no lateral contraction meets E A/h") {
    const auto j = json_of("study block --length 0.06 --height 0.04 --width 0.08 --cells 2x2x2 "
                           "--young 6 --poisson 0 --model corotated --static --press punch "
                           "--depths 0.001 0.002");
    for (int k = 0; k < 2; ++k) {
        const double depth_m = j["depth_m"][k], force_n = j["force_n"][k];
        CHECK(std::abs(force_n / (6e3 * 0.06 * 0.08 / 0.04 * depth_m) - 1.0) < 1e-6);
    }
}

TEST_CASE("study beam, block, cook: bad input ends with 2 and says what would be accepted") {
    refused("beam --cells 10x2", "--cells 10x2: accepted: NXxNYxNZ");
    refused("beam --cells 0x2x2", "accepted: NXxNYxNZ");
    refused("beam --cells 999x999x999", "up to 1000000 tets");
    refused("beam --poisson 0.5", "--poisson 0.5: accepted: from 0, below 0.5");
    refused("beam --poisson -0.1", "--poisson -0.1: accepted");
    refused("beam --young 0", "--young 0: accepted: kPa");
    refused("beam --young nan", "--young nan: accepted: kPa");
    refused("beam --young soft", "soft");
    refused("beam --length -1", "--length -1: accepted: metres");
    refused("beam --dt 10", "--dt 10: accepted: seconds");
    refused("beam --steps 0", "--steps 0: accepted: from 1");
    refused("beam --model magic", "--model magic: accepted: linear, corotated, quadratic");
    refused("beam --model corotated --element p2", "--element p2: accepted: p1");
    refused("beam --element p3", "--element p3: accepted: p1, p2");
    refused("beam --load 1 2", "--load 1 2: accepted: one value");
    refused("beam --press punch", "--press");
    refused("block --press stamp", "--press stamp: accepted: pressure, punch");
    refused("block --press punch", "--depths");
    refused("block --patch 0.03 --cells 8x4x8", "--patch 0.03: accepted: metres, a square");
    refused("block --press punch --depths 0.001 --model linear --element p1 --static",
            "--element p1: accepted: p2");
    refused("large --alphas 0 --out x", "--alphas: accepted: above 0");
    refused("locking --curves corotated --out x", "--curves corotated: accepted: MODEL:NXxNYxNZ");
    refused("locking", "--out");
}

TEST_CASE("study beam: a model that finds no rest ends with 1 and says so") {
    // 1e6 N on tissue of 1 Pa: where that balances is thousands of lengths away
    const Answer answer = trocar("study beam --model corotated --cells 2x1x1 --load 1e6 "
                                 "--young 0.001 --static");
    CAPTURE(answer.text);
    CHECK(answer.exit_code == 1);
    CHECK(answer.text.find("corotated: exploded at load 1e+06") != std::string::npos);
}
