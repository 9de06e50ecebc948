// What `trocar run --json` and `rescore --json` tell of the profile and the worst moments.
#include "tests/sim/command_fixture.h"

#include <filesystem>
#include <unistd.h>

using namespace command_tests;

TEST_CASE("run and rescore tell the same profile and moments, and judge no broken attempt") {
    const auto folder =
        std::filesystem::temp_directory_path() / ("trocar_report_test_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::string db = (folder / "station.db").string();
    const auto run = json_of(
        "run touch-points --hands novice --seed 3 --max-seconds 8 --json --log '" + db + "'");
    CHECK(run["completed"] == false);
    REQUIRE(run["profile"].size() == 7); // levels of the shipped exercise
    for (const auto& row : run["profile"]) {
        CHECK(row["reached"] == "not judged");
        CHECK(row["value"] == run["metrics"][row["metric"].get<std::string>()]);
    }
    REQUIRE_FALSE(run["moments"].empty());
    for (const auto& moment : run["moments"]) {
        CHECK(moment["tick"].get<int>() < 8000);
        CHECK(moment["text"].get<std::string>().ends_with("."));
    }
    const auto again = json_of("rescore --json '" + db + "'")["attempts"][0];
    CHECK(again["agree"] == true);
    CHECK(again["profile"] == run["profile"]);
    CHECK(again["moments"] == run["moments"]);
    std::filesystem::remove_all(folder);
}
