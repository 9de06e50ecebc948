#include "tasks/score/metrics.h"

#include "relative.h"

#include "scored.h"

#include <cmath>
#include <numbers>

using namespace tasks;
using namespace tasks::testing;

namespace {

void circle(Observation& seen, double t_s) { // 20 mm radius, one turn in 4 s
    const double angle = 2.0 * std::numbers::pi * t_s / 4.0;
    seen.tool[1].tip_m = kFar + 0.02 * glm::dvec3{std::cos(angle), std::sin(angle), 0.0};
}

} // namespace

TEST_CASE("the path of a circle is its circumference, of the tool that drew it") {
    const Scored s = scored(8001, circle); // two turns
    // First movement: 1 mm of chord, arc 2 asin(1/40); the filter's gain at 0.25 Hz is 1 - 4e-7.
    const double start_s = std::ceil(4e3 / (2 * std::numbers::pi) * 2 * std::asin(1.0 / 40)) * 1e-3;
    const double arc_m = 0.02 * 2.0 * std::numbers::pi * (8.0 - start_s) / 4.0;
    CHECK(value(s, "path_length.right") == relative(arc_m, 1e-4));
    CHECK(value(s, "path_length") == relative(arc_m, 1e-4));
    CHECK(std::abs(value(s, "path_length.left")) < 1e-12); // the filter's rounding in 8000 ticks
    CHECK(value(s, "speed_mean.right") == relative(0.02 * 2.0 * std::numbers::pi / 4.0, 1e-4));
    CHECK(value(s, "idle.right") == 0.0);
    CHECK(value(s, "idle.left") == 1.0);
    CHECK(value(s, "idle") == relative(2.0 / 3.0));
    CHECK(value(s, "time") == relative(8.0 - start_s));
    CHECK(find(s, "time")->first_tick == std::lround(start_s * 1e3));
    CHECK(find(s, "time")->last_tick == 8000);
}

TEST_CASE("trembling above 10 Hz hardly adds to the path") {
    const Scored s = scored(8001, [](Observation& seen, double t_s) {
        circle(seen, t_s);
        seen.tool[1].tip_m.z += 1e-4 * std::sin(2.0 * std::numbers::pi * 40.0 * t_s);
    });
    // Unfiltered it would be 8 s x 40 Hz x 4 x 0.1 mm = 128 mm of tremor on 250 mm of circle.
    CHECK(value(s, "path_length") == relative(0.2502, 2e-3));
}

TEST_CASE("LDLJ is the median over sub-movements") {
    // Slow single-sine speed: v = V (1 - cos(wt))/2, in runs of 1 s with 0.5 s of rest between.
    const auto swing = [](Observation& seen, double t_s) {
        const int n = static_cast<int>(t_s / 1.5);
        const double u = std::min(t_s - 1.5 * n, 1.0);
        const double sway = u - std::sin(2.0 * std::numbers::pi * u) / (2.0 * std::numbers::pi);
        seen.tool[1].tip_m.x = 0.02 * (n + sway);
    };
    const Scored s = scored(9000, swing);
    // Six equal movements, cut where v = 2 mm/s: u0 = acos(1 - 2 * 0.1 / 2)/(2 pi)...
    const double peak = 0.04, w = 2.0 * std::numbers::pi;
    const double cut = std::acos(1.0 - 2.0 * 0.002 / peak) / w;
    // integral over [cut, 1-cut] of (V/2 w^2 cos(wt))^2 dt in closed form
    const double T = 1.0 - 2.0 * cut;
    const double integral =
        std::pow(0.5 * peak * w * w, 2) *
        (T / 2.0 + (std::sin(2 * w * (1 - cut)) - std::sin(2 * w * cut)) / (4.0 * w));
    const double expected = -std::log(T * T * T / (peak * peak) * integral);
    // The low pass rounds the starts of the movement: 3 %.
    CHECK(value(s, "ldlj.right") == relative(expected, 0.03));
    CHECK(value(s, "ldlj") == value(s, "ldlj.right"));
    CHECK(find(s, "ldlj.left") == nullptr);
}

TEST_CASE("constant force: mean, peak, impulse and time over the limit are what was pressed") {
    const Scored s = scored(4000, [](Observation& seen, double t_s) {
        seen.tool[1].tip_m.x += 0.002 * t_s; // moves from 0.5 s on
        if (t_s >= 1.0 && t_s < 3.0)
            touch(seen, Role::right, {0.0, 0.0, 0.0}, t_s < 1.5 ? 2.5 : 0.5);
        if (t_s >= 1.25 && t_s < 1.75)
            touch(seen, Role::left, {0.03, 0.0, 0.0}, 3.0);
    });
    CHECK(value(s, "force_mean.right") == relative((2.5 * 0.5 + 0.5 * 1.5) / 2.0));
    CHECK(value(s, "force_peak.right") == relative(2.5));
    CHECK(value(s, "force_peak") == relative(3.0));
    CHECK(value(s, "impulse.right") == relative(2.5 * 0.5 + 0.5 * 1.5));
    CHECK(value(s, "force_mean") == relative((2.0 + 1.5) / 2.5));
    CHECK(value(s, "over_force.right") == relative(0.5));
    CHECK(value(s, "over_force.left") == relative(0.5));
    CHECK(value(s, "over_force") == relative(0.75)); // they overlap
    CHECK(value(s, "over_force_episodes") == 2.0);
    CHECK(value(s, "errors.over_force") == 2.0);
    CHECK(value(s, "errors") == value(s, "errors.over_force") + value(s, "errors.wrong_role") +
                                    value(s, "errors.off_target") + value(s, "errors.out_of_view"));
}

TEST_CASE("economy is the straight way to the ball over the way that was gone") {
    ScoreContext context;
    context.target_radius_m = 3e-3;
    // Straight down to the target in 2 s, hold, then straight up as far again.
    const Scored s = scored(
        6000,
        [](Observation& seen, double t_s) {
            const double down = std::clamp(t_s / 2.0, 0.0, 1.0);
            seen.tool[1].tip_m.z = 0.08 * (1.0 - down);
            if (t_s >= 2.0 && t_s < 3.0)
                touch(seen, Role::right, {0.0, 0.0, -0.003}, 0.5); // tip at the origin
            if (t_s >= 3.0)
                seen.tool[1].tip_m.z = 0.08 * std::min((t_s - 3.0) / 2.0, 1.0);
        },
        context);
    // From where it was at the first movement (26 ticks of 40 mm/s) to 3 mm before the target.
    const double first_m = 0.08 - 26 * 0.04e-3;
    CHECK(value(s, "economy.right") == relative((first_m - 0.003) / (first_m + 0.08), 2e-3));
    CHECK(value(s, "economy.left") == 0.0); // had nothing to touch and touched nothing
    CHECK(value(s, "economy") == relative(value(s, "economy.right"), 1e-6));
}

TEST_CASE("out of view is the share of the tool's time") {
    const Scored s = scored(4026, [](Observation& seen, double t_s) {
        seen.tool[1].tip_m.y = 0.04 * std::min(t_s, 0.5); // first movement at tick 26
        if (t_s >= 3.026)
            seen.tool[1].tip_m.x = 5.0;
    });
    CHECK(value(s, "out_of_view.right") == relative(0.25));
    CHECK(value(s, "out_of_view.left") == 0.0);
    CHECK(value(s, "out_of_view") == relative(0.25 / 3.0));
}

TEST_CASE("nothing recorded, nothing moved, nothing touched: defined values, no NaN") {
    for (const int n : {0, 1, 2, 500}) {
        const Scored s = scored(n, [](Observation&, double) {});
        for (const Metric& metric : s.metrics)
            CHECK_MESSAGE(std::isfinite(metric.value), metric.id);
        for (const char* id :
             {"time", "economy", "force_mean", "force_peak", "over_force", "errors", "out_of_view"})
            CHECK_MESSAGE(value(s, id) == 0.0, std::string(id));
        CHECK(value(s, "path_length") < 1e-12); // the filter rounds
        CHECK(find(s, "ldlj") == nullptr);
    }
}

TEST_CASE("without forces the force metrics say that they were not felt") {
    ScoreContext context;
    context.forces_on = false;
    const Scored s = scored(500, circle, context);
    for (const Metric& metric : s.metrics) {
        const bool of_force = metric.id.find("force") != std::string::npos ||
                              metric.id.starts_with("impulse") || metric.id.starts_with("work") ||
                              metric.id.starts_with("stress");
        CHECK_MESSAGE(metric.felt == !of_force, metric.id);
    }
}

TEST_CASE("an absent tool has no metrics of its own and adds nothing") {
    const Scored s = scored(1000, [](Observation& seen, double t_s) {
        circle(seen, t_s);
        seen.tool[2].present = false;
        seen.tool[2].tip_m.x = t_s;
        seen.tool[2].force_n.z = 9.0;
        seen.tool[2].touching = true;
    });
    CHECK(find(s, "path_length.assist") == nullptr);
    CHECK(value(s, "path_length") == relative(value(s, "path_length.right")));
    CHECK(value(s, "force_peak") == 0.0);
    CHECK(value(s, "over_force") == 0.0);
}

TEST_CASE("metric ids are unique") {
    const Scored s = scored(1000, circle);
    for (const Metric& a : s.metrics)
        CHECK(std::count_if(s.metrics.begin(), s.metrics.end(),
                            [&](const Metric& b) { return a.id == b.id; }) == 1);
}
