// Metrics of motion and work against closed forms, through the whole fold.
#include "tasks/score/definition.h"
#include "tasks/score/smoothness.h"

#include "relative.h"
#include "scored.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

using namespace tasks;
using namespace tasks::testing;

namespace {

constexpr double kSwing_hz = 0.5; // far below 10 Hz: the filter's gain is 1 - 6e-6
constexpr double kW = 2.0 * std::numbers::pi * kSwing_hz;

// A jump of the right tip at the first tick starts the clock there.
void begin(Observation& seen) {
    if (seen.tick > 0)
        seen.tool[1].tip_m.x += 2e-3;
}

// A busy attempt: both hands swing, turn, and press at times.
void busy(Observation& seen, double t_s) {
    const double s = std::sin(kW * t_s), c = std::cos(1.3 * kW * t_s);
    for (int t = 0; t < 2; ++t) {
        ToolObservation& tool = seen.tool[t];
        tool.tip_m += glm::dvec3{0.02 * s, 0.01 * c, 0.005 * s * c} * (t == 0 ? 1.0 : 0.7);
        tool.shaft = glm::normalize(glm::dvec3{0.2 * s, 0.1 * c, -1.0});
        tool.insertion_m = 0.12 + 0.01 * c;
        tool.roll_rad = 0.4 * s;
        tool.touching = s > 0.3;
        tool.contact_m = tool.tip_m;
        tool.force_n = tool.touching ? glm::dvec3{0.2 * c, 0.0, s} : glm::dvec3{0.0};
    }
}

} // namespace

TEST_CASE("a shaft that swings by A to and fro has turned by 4 A a period") {
    const Scored s = scored(8001, [](Observation& seen, double t_s) {
        begin(seen);
        const double angle = 0.3 * std::sin(kW * t_s);
        seen.tool[1].shaft = {std::sin(angle), 0.0, -std::cos(angle)};
    });
    const double expected = 4 * 4 * 0.3 - 0.3 * std::sin(kW * kTick_s);
    CHECK(value(s, "angular_path.right") == relative(expected, 1e-4));
    CHECK(value(s, "angular_path") == relative(expected, 1e-4));
    CHECK(value(s, "angular_path.left") < 1e-9);
    CHECK(value(s, "roll_path") < 1e-9);
    CHECK(value(s, "depth_length") < 1e-9);
}

TEST_CASE("an insertion that swings by A has gone 4 A of depth a period") {
    const Scored s = scored(8001, [](Observation& seen, double t_s) {
        begin(seen);
        seen.tool[1].insertion_m = 0.1 + 0.02 * std::sin(kW * t_s);
    });
    const double expected = 4 * 4 * 0.02 - 0.02 * std::sin(kW * kTick_s);
    CHECK(value(s, "depth_length.right") == relative(expected, 1e-4));
    CHECK(value(s, "angular_path") < 1e-9);
}

TEST_CASE("pure roll is rate times time, also where the angle jumps by a turn") {
    const Scored s = scored(8001, [](Observation& seen, double t_s) {
        begin(seen);
        seen.tool[1].roll_rad = std::remainder(2.0 * t_s, 2.0 * std::numbers::pi);
    });
    CHECK(value(s, "roll_path.right") == relative(2.0 * (8.0 - kTick_s), 1e-5));
    CHECK(value(s, "roll_path") ==
          value(s, "roll_path.right") + value(s, "roll_path.left") + value(s, "roll_path.assist"));
    CHECK(value(s, "angular_path") < 1e-9);
}

TEST_CASE("the mean acceleration of uniform circular motion is w^2 R") {
    const Scored s = scored(8001, [](Observation& seen, double t_s) {
        seen.tool[1].tip_m = kFar + 0.02 * glm::dvec3{std::cos(kW * t_s), std::sin(kW * t_s), 0.0};
    });
    // At the end the path goes on point-reflected, and 50 ms of 8 s are less bent.
    CHECK(value(s, "accel_mean.right") == relative(kW * kW * 0.02, 5e-3));
    CHECK(value(s, "accel_mean") == relative(value(s, "accel_mean.right") / 3.0));
}

TEST_CASE("normalised jerk of a straight minimum-jerk movement is sqrt(360), however long") {
    for (const double duration_s : {0.5, 2.0})
        for (const double length_m : {0.01, 0.1}) {
            const int n = static_cast<int>(std::lround(duration_s * 1000.0));
            std::vector<glm::dvec3> path;
            for (int i = 0; i <= n; ++i) {
                const double u = static_cast<double>(i) / n;
                path.push_back(length_m * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u) *
                               glm::dvec3(0.6, 0.0, 0.8));
            }
            // integral |p'''|^2 dt = 720 L^2/T^5; at half a second three of 500 intervals, where
            // the jerk is largest, have no third difference of their own
            const double integral = squared_jerk_m2ps5(path, 1000.0);
            CHECK(jerk_norm(duration_s, length_m, integral).value() ==
                  relative(std::sqrt(360.0), 0.02));
        }
}

TEST_CASE("normalised jerk of a sine is sqrt(T^5/(2 L^2) A^2 w^6 T/2)") {
    constexpr double A = 0.02;
    const Scored s = scored(
        8001, [](Observation& seen, double t_s) { seen.tool[1].tip_m.x = A * std::sin(kW * t_s); });
    const double start_s = std::ceil(1e3 * std::asin(1e-3 / A) / kW) * 1e-3; // 1 mm gone
    const double T = 8.0 - start_s, L = 16.0 * A - A * std::sin(kW * start_s);
    const double integral =
        A * A * std::pow(kW, 6) * (0.5 * T - std::sin(2.0 * kW * start_s) / (4.0 * kW));
    const double expected = std::sqrt(std::pow(T, 5) / (2.0 * L * L) * integral);
    CHECK(value(s, "jerk_norm.right") == relative(expected, 1e-3));
    CHECK(value(s, "jerk_norm") == relative(value(s, "jerk_norm.right"), 1e-6));
    CHECK(find(s, "jerk_norm.left") == nullptr); // went nowhere
}

TEST_CASE("SPARC is the median over sub-movements") {
    // Three strokes of minimum jerk in 1 s each, 0.5 s of rest between.
    const Scored s = scored(4500, [](Observation& seen, double t_s) {
        const int n = static_cast<int>(t_s / 1.5);
        const double u = std::min(t_s - 1.5 * n, 1.0);
        seen.tool[1].tip_m.x = 0.03 * (n + u * u * u * (10.0 - 15.0 * u + 6.0 * u * u));
    });
    std::vector<double> speed;
    for (int i = 0; i < 1000; ++i) {
        const double u = (i + 0.5) / 1000.0;
        if (const double v = 0.03 * 30.0 * u * u * (1.0 - u) * (1.0 - u); v > kMoving_mps)
            speed.push_back(v);
    }
    CHECK(value(s, "sparc.right") == relative(sparc(speed, 1000.0).value(), 0.01));
    CHECK(value(s, "sparc") == value(s, "sparc.right"));
    CHECK(find(s, "sparc.left") == nullptr);
}

TEST_CASE(
    "speeds that rise together correlate by 1, against each other by -1, in quadrature by 0") {
    // x' = c + a sin(wt + phase)
    const auto correlation = [](double phase) {
        return value(scored(8001,
                            [&](Observation& seen, double t_s) {
                                for (int t = 0; t < 2; ++t)
                                    seen.tool[t].tip_m.x =
                                        0.02 * t_s -
                                        0.01 / kW * std::cos(kW * t_s + (t == 0 ? phase : 0.0));
                            }),
                     "bimanual");
    };
    CHECK(correlation(0.0) == relative(1.0, 1e-9));
    CHECK(correlation(std::numbers::pi) == relative(-1.0, 1e-3));
    CHECK(std::abs(correlation(0.5 * std::numbers::pi)) < 0.02); // 50 ms of the start are missing
}

TEST_CASE("where one hand rests or moves steadily there is no correlation") {
    const auto of_left = [](double speed_mps) {
        return scored(2000, [&](Observation& seen, double t_s) {
            seen.tool[0].tip_m.x = speed_mps * t_s;
            seen.tool[1].tip_m.x = 0.02 * t_s - 0.01 / kW * std::cos(kW * t_s);
        });
    };
    CHECK(find(of_left(0.0), "bimanual") == nullptr);
    CHECK(find(of_left(0.0019), "bimanual") == nullptr); // below 2 mm/s
    CHECK(find(of_left(0.02), "bimanual") == nullptr);
    CHECK_FALSE(speed_correlation({}, {}));
}

TEST_CASE("work is force times the way along it: down counts, back and sideways do not") {
    constexpr double A = 0.01;
    const auto pressed = [](glm::dvec3 along, glm::dvec3 force_n) {
        return scored(7001, [=](Observation& seen, double t_s) {
            begin(seen);
            ToolObservation& tool = seen.tool[1];
            tool.tip_m += 0.5 * A * (1.0 - std::cos(kW * t_s)) * along;
            tool.touching = true;
            tool.contact_m = tool.tip_m;
            tool.force_n = force_n;
        });
    };
    const glm::dvec3 down{0.0, 0.0, -1.0}, side{0.0, 1.0, 0.0}, up{0.0, 0.0, 1.0};
    // The tissue pushes up with 1.5 N: 4 ways there of 10 mm each, and 3 back.
    CHECK(value(pressed(down, 1.5 * up), "work.right") == relative(4 * A * 1.5, 1e-4));
    CHECK(value(pressed(down, 1.5 * up), "work") == relative(4 * A * 1.5, 1e-4));
    CHECK(value(pressed(up, 1.5 * up), "work") == relative(3 * A * 1.5, 1e-4)); // the ways back
    CHECK(value(pressed(side, 1.5 * up), "work") < 1e-12);
    CHECK(value(pressed(down, {}), "work") == 0.0);
}

TEST_CASE("straight down through the port the careful way is the shortest one") {
    const Scored s = scored(4000, [](Observation& seen, double t_s) {
        ToolObservation& tool = seen.tool[1];
        tool.tip_m.z = 0.08 * (1.0 - std::clamp(t_s / 2.0, 0.0, 1.0));
        if (t_s >= 2.0)
            touch(seen, Role::right, {0.0, 0.0, -0.003}, 0.5);
        tool.insertion_m = 0.18 - tool.tip_m.z; // port at z = 0.18, shaft straight down
    });
    CHECK(value(s, "economy.right") > 0.9);
    CHECK(value(s, "retraction_length.right") == relative(value(s, "economy.right"), 1e-6));
    CHECK(value(s, "retraction_length.left") == 0.0);
}

TEST_CASE("motion metrics do not change when the whole world is turned and shifted") {
    const Scored here = scored(6000, busy);
    const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3{1.0, 2.0, -0.5}));
    const Scored there = scored(6000, [&](Observation& seen, double t_s) {
        busy(seen, t_s);
        for (ToolObservation& tool : seen.tool) {
            tool.tip_m = turn * tool.tip_m + glm::dvec3{0.3, -0.1, 0.2};
            tool.contact_m = turn * tool.contact_m + glm::dvec3{0.3, -0.1, 0.2};
            tool.shaft = turn * tool.shaft;
            tool.force_n = turn * tool.force_n;
        }
    });
    for (const char* id : {"time", "path_length", "depth_length", "angular_path", "roll_path",
                           "speed_mean", "accel_mean", "idle", "ldlj", "sparc", "jerk_norm",
                           "bimanual", "work", "force_mean", "force_peak", "impulse"})
        // shafts and forces are kept as floats
        CHECK_MESSAGE(value(there, id) == relative(value(here, id), 1e-5), std::string(id));
}

TEST_CASE("a score that is stopped, copied and resumed anywhere is the same score") {
    const Exercise exercise = two_points();
    const Scored whole = scored(3000, busy);
    for (const int stop : {0, 1, 700, 2999}) {
        Scored first;
        observe_ticks(first, exercise, 0, stop, busy);
        finish(first.score, first.progress, {});
        Scored second = first;
        observe_ticks(second, exercise, stop, 3000, busy);
        second.metrics = finish(second.score, second.progress, with_ideal_path({}, exercise));
        REQUIRE(second.metrics.size() == whole.metrics.size());
        for (std::size_t i = 0; i < whole.metrics.size(); ++i) {
            CHECK(second.metrics[i].id == whole.metrics[i].id);
            CHECK(second.metrics[i].value == whole.metrics[i].value);
        }
    }
}

TEST_CASE("a definition is found by a metric's id and by that of a role's version") {
    REQUIRE(definition_of("path_length.left") != nullptr);
    CHECK(definition_of("path_length.left") == definition_of("path_length"));
    CHECK(definition_of("economy")->better == Better::more);
    CHECK(definition_of("errors.over_force")->of_force);
    CHECK(definition_of("bimanual")->better == Better::neither);
    for (const char* unknown : {"", "path", "path_length.middle", "time.left", "errors.left", "."})
        CHECK_MESSAGE(definition_of(unknown) == nullptr, std::string(unknown));
}
