// tests/tasks/rig_report_test.cpp
// The rig report as JSON: the shape that commands print, and back.
#include "tasks/logbook/rig_report.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <nlohmann/json.hpp>

TEST_CASE("a rig report comes back from JSON with every field") {
    tasks::RigReport rig;
    double next = 0.1;
    for (double* value : {&rig.tick_us_p50, &rig.tick_us_p99, &rig.tick_us_p9999, &rig.tick_us_max,
                          &rig.fem_ms_p50, &rig.fem_ms_p99, &rig.fem_ms_max,
                          &rig.force_step_mn_p999, &rig.force_step_mn_max, &rig.energy_min_j})
        *value = next += 1.0 / 3.0;
    rig.missed = 11;
    rig.dropped = std::int64_t{1} << 40;
    rig.faults = {"one", "two \"quoted\" \xc3\xbc\n"};
    const tasks::RigReport back = tasks::parse_rig(tasks::rig_json(rig));
    CHECK(back.tick_us_p50 == rig.tick_us_p50);
    CHECK(back.tick_us_p99 == rig.tick_us_p99);
    CHECK(back.tick_us_p9999 == rig.tick_us_p9999);
    CHECK(back.tick_us_max == rig.tick_us_max);
    CHECK(back.fem_ms_p50 == rig.fem_ms_p50);
    CHECK(back.fem_ms_p99 == rig.fem_ms_p99);
    CHECK(back.fem_ms_max == rig.fem_ms_max);
    CHECK(back.force_step_mn_p999 == rig.force_step_mn_p999);
    CHECK(back.force_step_mn_max == rig.force_step_mn_max);
    CHECK(back.energy_min_j == rig.energy_min_j);
    CHECK(back.missed == rig.missed);
    CHECK(back.dropped == rig.dropped);
    CHECK(back.faults == rig.faults);
}

TEST_CASE("the JSON of a rig report has the keys that the commands promise") {
    tasks::RigReport rig;
    rig.tick_us_p9999 = 250.5;
    rig.fem_ms_p99 = 8.25;
    rig.force_step_mn_p999 = 12;
    const auto json = nlohmann::json::parse(tasks::rig_json(rig));
    CHECK(json["tick_us"]["p9999"] == 250.5);
    CHECK(json["tick_us"].size() == 4);
    CHECK(json["fem_ms"]["p99"] == 8.25);
    CHECK(json["force_step_mn"]["p999"] == 12);
    CHECK(json["energy_min_j"] == 0.0);
    CHECK(json["missed"] == 0);
    CHECK(json["faults"].is_array());
}

TEST_CASE("a figure that is not a number becomes null and comes back as not a number") {
    tasks::RigReport rig;
    rig.fem_ms_max = std::numeric_limits<double>::quiet_NaN();
    CHECK(nlohmann::json::parse(tasks::rig_json(rig))["fem_ms"]["max"].is_null());
    CHECK(std::isnan(tasks::parse_rig(tasks::rig_json(rig)).fem_ms_max));
}

TEST_CASE("missing keys keep their defaults and wrong JSON is refused") {
    CHECK(tasks::parse_rig("{}").missed == 0);
    CHECK(tasks::parse_rig(R"({"missed": 4})").missed == 4);
    for (const char* wrong :
         {"", "[]", "3", R"({"missed": "4"})", R"({"missed": null})", R"({"faults": 1})"}) {
        CAPTURE(wrong);
        CHECK_THROWS_AS(tasks::parse_rig(wrong), std::invalid_argument);
    }
}
