#include "sim/study/levels_study.h"

#include <cmath>
#include <doctest/doctest.h>

TEST_CASE("levels: good is the mean, pass two standard deviations worse") {
    // 1, 2, 3, 4: mean 2.5, sample variance 5/3
    const std::vector<double> value{1.0, 2.0, 3.0, 4.0};
    const double two_sd = 2.0 * std::sqrt(5.0 / 3.0);
    const sim::LevelRow less = sim::level_of("time", value), more = sim::level_of("economy", value);
    CHECK(less.level.good == doctest::Approx(2.5).scale(0.0));
    CHECK(less.level.pass == doctest::Approx(2.5 + two_sd).scale(0.0));
    CHECK(more.level.pass == doctest::Approx(2.5 - two_sd).scale(0.0));
    CHECK(less.attempts == 4);
}

TEST_CASE("levels: no direction, no metric, no spread are said") {
    const std::vector<double> value{1.0, 2.0};
    CHECK_THROWS_AS(sim::level_of("idle", value), std::invalid_argument);
    CHECK_THROWS_AS(sim::level_of("nonsense", value), std::invalid_argument);
    CHECK_THROWS_AS(sim::level_of("time", std::span(value).first(1)), std::invalid_argument);
}

TEST_CASE("levels: the text is what an exercise file accepts") {
    const std::vector<double> value{40.0, 42.0, 47.0};
    const std::vector<sim::LevelRow> rows{sim::level_of("time", value),
                                          sim::level_of("economy", value)};
    const std::string exercise = "id = \"t\"\ntitle = \"T\"\ncard = \"C\"\n[[target]]\nid = \"1\"\n"
                                 "role = \"left\"\nat_mm = [0, 0, 0]\n";
    const auto level = tasks::parse_exercise(exercise + sim::levels_text(rows), "x").level;
    REQUIRE(level.size() == 2);
    CHECK(level[0].good == doctest::Approx(43.0).scale(0.0));
    CHECK(level[1].metric == "economy");
}
