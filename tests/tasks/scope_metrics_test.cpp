// tests/tasks/scope_metrics_test.cpp
// Metrics of the endoscope, of stress in the tissue, and of a search for tubes: against closed
// forms.
#include "tasks/score/definition.h"
#include "tasks/score/find_metrics.h"
#include "tests/tasks/relative.h"
#include "tests/tasks/scored.h"
#include "tests/tasks/tubes.h"

#include <cmath>
#include <numbers>

using namespace tasks;
using namespace tasks::testing;

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kDeg = std::numbers::pi / 180.0;

// The right tool moves at once and far: the first movement is tick 1.
void move_at_once(Observation& seen, double t_s) {
    seen.scope_present = true;
    seen.tool[1].tip_m.x = t_s > 0.0 ? 0.01 : 0.0;
}

double found_metric(const Progress& progress, const Exercise& exercise, const std::string& id) {
    for (const Metric& metric : find_metrics(progress, exercise, true)) {
        if (metric.id == id)
            return metric.value;
    }
    FAIL("no metric " << id);
    return 0.0;
}

} // namespace

TEST_CASE("scope metrics: the eye's path on a circle is its circumference, trembling aside") {
    for (const double tremor_m : {0.0, 50e-6}) {
        const Scored s = scored(8002, [&](Observation& seen, double t_s) {
            move_at_once(seen, t_s);
            const double angle = kTurn * t_s / 4.0;
            seen.view.eye_m += 0.03 * glm::dvec3{std::cos(angle), std::sin(angle), 0.0};
            seen.view.eye_m.z += tremor_m * std::sin(kTurn * 60.0 * t_s);
        });
        // 8 s; unfiltered the tremor alone would be 96 mm
        CHECK(value(s, "path_length.scope") == relative(2.0 * kTurn * 0.03, 1e-3));
        CHECK(value(s, "path_length.left") < 1e-9);
    }
}

TEST_CASE("scope metrics: a sine off level has its amplitude over root two, and its share above "
          "15 degrees") {
    const Scored s = scored(8001, [](Observation& seen, double t_s) {
        move_at_once(seen, t_s);
        seen.horizon_rad = 30.0 * kDeg * std::sin(kTurn * t_s / 4.0);
    });
    CHECK(value(s, "horizon_rms") == relative(30.0 * kDeg / std::sqrt(2.0), 1e-3));
    // |sin| above a half: two thirds of the time
    CHECK(value(s, "horizon_over") == relative(2.0 / 3.0, 1e-3));
    const Scored level = scored(1000, [](Observation& seen, double t_s) {
        move_at_once(seen, t_s);
        seen.horizon_rad = -14.9 * kDeg;
    });
    CHECK(value(level, "horizon_rms") == relative(14.9 * kDeg, 1e-6));
    CHECK(value(level, "horizon_over") == 0.0);
}

TEST_CASE("scope metrics: without an endoscope there are none, but the tissue has stress") {
    const Scored s = scored(1000, [](Observation& seen, double t_s) {
        move_at_once(seen, t_s);
        seen.scope_present = false;
        seen.stress_pa = 700.0;
    });
    for (const char* id : {"path_length.scope", "horizon_rms", "horizon_over"})
        CHECK_MESSAGE(find(s, id) == nullptr, std::string(id));
    CHECK(value(s, "stress_peak") == 700.0);
}

TEST_CASE("scope metrics: everything counts from the first movement to the completion only") {
    constexpr int kMoved = 1000, kDone = 2000 + 299;
    const Scored s = scored(5000, [&](Observation& seen, double t_s) {
        const int tick = static_cast<int>(std::lround(t_s / kTick_s));
        seen.scope_present = true;
        if (tick >= kMoved)
            seen.tool[2].tip_m.x += 0.01;
        if (tick >= 1500)
            touch(seen, tick < 2000 ? Role::right : Role::left,
                  {tick < 2000 ? 0.0 : 0.03, 0.0, 0.0}, 0.5);
        const bool counts = tick >= kMoved && tick <= kDone;
        seen.stress_pa = counts ? (tick == kDone ? 60.0 : tick == kMoved ? 50.0 : 10.0) : 9e5;
        seen.horizon_rad = counts ? 0.1 : 1.0;
        seen.view.eye_m.z += tick > kDone ? 0.02 * t_s : 0.0;
    });
    REQUIRE(s.progress.complete_tick == kDone);
    REQUIRE(s.progress.first_move_tick == kMoved);
    CHECK(value(s, "stress_peak") == 60.0);
    CHECK(value(s, "horizon_rms") == relative(0.1, 1e-6));
    CHECK(value(s, "path_length.scope") < 1e-9);
    CHECK(value(s, "horizon_over") == 0.0);
    CHECK(find(s, "stress_peak")->first_tick == kMoved);
    CHECK(find(s, "stress_peak")->last_tick == kDone);
}

TEST_CASE("find metrics: tubes found, and the lift's force over the time that it holds") {
    Search search;
    const auto pull = [&](double force_n, bool grasping, int n) {
        Observation seen = search.hidden();
        touch(seen, Role::left, {0.0, -0.05, 0.0}, force_n);
        seen.tool[0].grasping = grasping;
        touch(seen, Role::right, {0.0, 0.0, 0.0}, 1.9); // no part of it
        seen.tool[1].grasping = true;
        search.go(seen, n);
    };
    CHECK(found_metric(search.progress, search.exercise, "retraction_force") == 0.0);
    pull(1.8, false, 100);
    pull(0.5, true, 300);
    pull(1.1, true, 100);
    CHECK(found_metric(search.progress, search.exercise, "retraction_force") ==
          relative((0.5 * 300 + 1.1 * 100) / 400.0));
    CHECK(found_metric(search.progress, search.exercise, "retraction_force_peak") == relative(1.1));
    CHECK(found_metric(search.progress, search.exercise, "tubes_found") == 0.0);
    Observation absent = search.shown(0, Role::right);
    absent.tool[0] = {.force_n = {0.0, 0.0, 1.9}, .grasping = true, .present = false};
    search.go(absent, 1000);
    CHECK(found_metric(search.progress, search.exercise, "retraction_force_peak") == relative(1.1));
    CHECK(found_metric(search.progress, search.exercise, "tubes_found") == 1.0);
}

TEST_CASE("find metrics: only of its kind, and of a lift only where there is one") {
    Search search;
    CHECK(find_metrics(search.progress, search.exercise, true).size() == 3);
    search.exercise.lift.reset();
    REQUIRE(find_metrics(search.progress, search.exercise, true).size() == 1);
    CHECK(find_metrics(search.progress, search.exercise, true)[0].id == "tubes_found");
    search.exercise.kind = ExerciseKind::touch_points;
    CHECK(find_metrics(search.progress, search.exercise, true).empty());
}

TEST_CASE("find metrics: those of force say that they were not felt without forces") {
    const Search search;
    for (const Metric& metric : find_metrics(search.progress, search.exercise, false))
        CHECK_MESSAGE(metric.felt == (metric.id == "tubes_found"), metric.id);
    for (const Metric& metric : find_metrics(search.progress, search.exercise, true))
        CHECK_MESSAGE(metric.felt, metric.id);
}

TEST_CASE("find metrics: each has a definition with its unit and which way is better") {
    using enum Better;
    const std::vector<std::tuple<const char*, const char*, Better, bool>> expected{
        {"tubes_found", "1", more, false},          {"retraction_force", "N", less, true},
        {"retraction_force_peak", "N", less, true}, {"errors.tube_not_pointed", "1", less, false},
        {"errors.tube_not_seen", "1", less, false}, {"path_length.scope", "m", less, false},
        {"horizon_rms", "rad", less, false},        {"horizon_over", "1", less, false},
        {"stress_peak", "Pa", less, true}};
    for (const auto& [id, unit, better, of_force] : expected) {
        CAPTURE(id);
        const MetricDefinition* definition = definition_of(id);
        REQUIRE(definition != nullptr);
        CHECK(definition->unit == unit);
        CHECK(definition->better == better);
        CHECK(definition->of_force == of_force);
    }
}
