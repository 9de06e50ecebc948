#include "tasks/score/profile.h"

#include "relative.h"

using namespace tasks;
using tasks::testing::relative;

namespace {

Metric metric(std::string id, double value, bool felt = true) {
    Metric m;
    m.id = std::move(id);
    m.value = value;
    m.felt = felt;
    return m;
}

const std::vector<MetricLevel> kLevels{{"time", 40.0, 60.0}, {"ldlj", -6.0, -7.0}};

ProfileRow row(std::string id, double value, const MetricLevel& level, bool judged = true,
               bool felt = true) {
    const std::vector<Metric> metrics{metric(std::move(id), value, felt)};
    const std::vector<MetricLevel> levels{level};
    return profile(metrics, levels, judged).at(0);
}

} // namespace

TEST_CASE("a profile has one row per level, in their order, with name and unit") {
    const std::vector<Metric> metrics{metric("ldlj", -6.5), metric("time", 50.0),
                                      metric("idle", 0.5)};
    const auto rows = profile(metrics, kLevels, true);
    REQUIRE(rows.size() == 2);
    CHECK(rows[0].metric == "time");
    CHECK(rows[0].name == "Time");
    CHECK(rows[0].unit == "s");
    CHECK(rows[0].lower_is_better);
    CHECK(rows[0].value.value() == 50.0);
    CHECK(rows[1].metric == "ldlj");
    CHECK_FALSE(rows[1].lower_is_better);
}

TEST_CASE("the limits themselves are reached, in the metric's own direction") {
    CHECK(row("time", 39.0, kLevels[0]).reached == Reached::good);
    CHECK(row("time", 40.0, kLevels[0]).reached == Reached::good);
    CHECK(row("time", 60.0, kLevels[0]).reached == Reached::pass);
    CHECK(row("time", 60.1, kLevels[0]).reached == Reached::missed);
    CHECK(row("ldlj", -6.0, kLevels[1]).reached == Reached::good);
    CHECK(row("ldlj", -7.0, kLevels[1]).reached == Reached::pass);
    CHECK(row("ldlj", -7.1, kLevels[1]).reached == Reached::missed);
}

TEST_CASE("a bar is straight through both levels and stays within 0 and 1") {
    CHECK(row("time", 40.0, kLevels[0]).share == relative(kShareAtGood));
    CHECK(row("time", 60.0, kLevels[0]).share == relative(kShareAtPass));
    CHECK(row("time", 50.0, kLevels[0]).share == relative(0.5 * (kShareAtGood + kShareAtPass)));
    CHECK(row("time", 0.0, kLevels[0]).share == 1.0);
    CHECK(row("time", 1e9, kLevels[0]).share == 0.0);
    CHECK(row("ldlj", -6.0, kLevels[1]).share == relative(kShareAtGood));
    CHECK(row("ldlj", -7.0, kLevels[1]).share == relative(kShareAtPass));
}

TEST_CASE("where both levels are one number it is reached or it is not") {
    const MetricLevel none{"errors", 0.0, 0.0};
    CHECK(row("errors", 0.0, none).reached == Reached::good);
    CHECK(row("errors", 0.0, none).share == kShareAtGood);
    CHECK(row("errors", 1.0, none).reached == Reached::missed);
    CHECK(row("errors", 1.0, none).share == 0.0);
}

TEST_CASE("nothing is judged that was not completed, not felt or not measured") {
    const ProfileRow broken = row("time", 10.0, kLevels[0], false);
    CHECK(broken.reached == Reached::not_judged);
    CHECK(broken.value.value() == 10.0);
    const ProfileRow unfelt = row("force_peak", 0.1, {"force_peak", 0.3, 0.5}, true, false);
    CHECK(unfelt.reached == Reached::not_judged);
    CHECK_FALSE(unfelt.felt);
    const ProfileRow absent = row("time", 10.0, kLevels[1]);
    CHECK(absent.reached == Reached::not_judged);
    CHECK_FALSE(absent.value.has_value());
    CHECK(absent.share == 0.0);
}

TEST_CASE("of several versions of a metric the newest is judged") {
    std::vector<Metric> metrics{metric("time", 70.0), metric("time", 45.0), metric("time", 80.0)};
    metrics[1].version = 2;
    CHECK(profile(metrics, kLevels, true)[0].value.value() == 45.0);
}
