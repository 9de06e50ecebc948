// tests/tasks/follow_path_test.cpp
// Following a path, and every mistake one can make at it: exactly the expected events.
#include "tasks/score/path_metrics.h"
#include "tests/tasks/attempt.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace tasks;
using namespace tasks::testing;

namespace {

using Kinds = std::vector<EventKind>;
constexpr double kSpeed_mps = 0.02;

/// 150 mm along x on the plane z = 0, for the right tool.
Exercise straight_path() {
    Exercise exercise;
    exercise.kind = ExerciseKind::follow_path;
    exercise.radius_m = 4e-3;
    for (int k = 0; k < 16; ++k)
        exercise.target.push_back({std::to_string(k + 1), Role::right, {0.01 * k, 0.0, 0.0}});
    return exercise;
}

struct Attempt {
    Exercise exercise = straight_path();
    Progress progress;

    void tick(const Observation& seen) { repeat(progress, exercise, seen, 1); }

    /// Draws from x to x at a distance beside the path, with a force.
    void draw(double from_m, double to_m, double aside_m = 0.0, double force_n = 0.5,
              Role role = Role::right) {
        const double step_m = (to_m > from_m ? 1.0 : -1.0) * kSpeed_mps * kTick_s;
        const auto n = static_cast<int>(std::abs(to_m - from_m) / (kSpeed_mps * kTick_s));
        for (int i = 0; i <= n; ++i) {
            Observation seen = at_rest(exercise);
            touch(seen, role, {from_m + i * step_m, aside_m, 0.0}, force_n);
            tick(seen);
        }
    }
    void lift(int ticks = 400) { repeat(progress, exercise, at_rest(exercise), ticks); }

    /// Without contacts' begins and ends.
    Kinds kinds() const {
        Kinds out;
        for (const Event& event : progress.events) {
            if (event.kind != EventKind::contact_begin && event.kind != EventKind::contact_end)
                out.push_back(event.kind);
        }
        return out;
    }
    double metric(const std::string& id) const {
        for (const Metric& m : path_metrics(progress, exercise, true)) {
            if (m.id == id)
                return m.value;
        }
        FAIL("no metric " << id);
        return 0.0;
    }
};

} // namespace

TEST_CASE("follow-path: drawn once along, it is begun and completed, without a break") {
    Attempt attempt;
    attempt.draw(0.0, 0.15);
    CHECK(attempt.kinds() == Kinds{EventKind::path_begun, EventKind::completed});
    CHECK(attempt.progress.complete);
    CHECK(attempt.metric("path_coverage") == 1.0);
    CHECK(attempt.metric("path_inside") == 1.0);
    CHECK(attempt.metric("path_breaks") == 0.0);
    CHECK(attempt.metric("deviation_max") < 1e-12);
    // half a radius before the end, at this speed
    const double seconds = (0.15 - 0.002) / kSpeed_mps;
    CHECK(static_cast<double>(attempt.progress.complete_tick) * kTick_s ==
          doctest::Approx(seconds).scale(0.0).epsilon(1e-3));
}

TEST_CASE("follow-path: deviations are those of a sine beside the path") {
    Attempt attempt;
    constexpr double kAmplitude_m = 3e-3;
    for (int i = 0; i <= 7400 && !attempt.progress.complete; ++i) {
        const double x = kSpeed_mps * kTick_s * i;
        Observation seen = at_rest(attempt.exercise);
        // ten whole waves in the 148 mm that are followed
        const double y = kAmplitude_m * std::sin(2.0 * std::numbers::pi * x / 0.0148);
        touch(seen, Role::right, {x, y, 0.0}, 0.5);
        attempt.tick(seen);
    }
    REQUIRE(attempt.progress.complete);
    CHECK(attempt.metric("deviation_rms") ==
          doctest::Approx(kAmplitude_m / std::sqrt(2.0)).scale(0.0).epsilon(1e-3));
    CHECK(attempt.metric("deviation_mean") ==
          doctest::Approx(2.0 / std::numbers::pi * kAmplitude_m).scale(0.0).epsilon(1e-3));
    CHECK(attempt.metric("deviation_max") ==
          doctest::Approx(kAmplitude_m).scale(0.0).epsilon(1e-3));
    CHECK(attempt.metric("path_inside") == 1.0);
}

TEST_CASE("follow-path: the dimple under a deep press is no deviation") {
    Attempt attempt;
    for (int i = 0; i <= 7400 && !attempt.progress.complete; ++i) {
        Observation seen = at_rest(attempt.exercise);
        touch(seen, Role::right, {kSpeed_mps * kTick_s * i, 1e-3, -9e-3}, 0.5);
        attempt.tick(seen);
    }
    CHECK(attempt.progress.complete);
    CHECK(attempt.metric("deviation_mean") == doctest::Approx(1e-3).scale(0.0).epsilon(1e-3));
}

TEST_CASE("follow-path: leaving the path in contact is one mistake, coming back and leaving two") {
    Attempt attempt;
    attempt.draw(0.0, 0.05);
    attempt.draw(0.05, 0.054, 6e-3); // 0.2 s
    CHECK(attempt.kinds() == Kinds{EventKind::path_begun, EventKind::path_left});
    CHECK(attempt.progress.events.back().value == doctest::Approx(6e-3).scale(0.0));
    attempt.draw(0.05, 0.07);
    attempt.draw(0.07, 0.074, -6e-3);
    CHECK(count(attempt.progress, EventKind::path_left) == 2);
    CHECK(attempt.metric("path_breaks") == 2.0);
    // a shorter slip is none
    attempt.draw(0.07, 0.09);
    attempt.draw(0.09, 0.0915, 6e-3); // 0.075 s
    attempt.draw(0.09, 0.15);
    CHECK(attempt.progress.complete);
    CHECK(count(attempt.progress, EventKind::path_left) == 2);
    CHECK(attempt.metric("path_breaks") == 2.0);
}

TEST_CASE("follow-path: lifting is a break and no mistake; it goes on where it was left") {
    Attempt attempt;
    attempt.draw(0.0, 0.06);
    attempt.lift();
    CHECK(attempt.metric("path_breaks") == 1.0);
    CHECK(attempt.metric("path_coverage") == doctest::Approx(0.4).scale(0.0).epsilon(1e-2));
    attempt.draw(0.058, 0.15);
    CHECK(attempt.kinds() == Kinds{EventKind::path_begun, EventKind::completed});
    CHECK(attempt.metric("path_inside") < 1.0);
}

TEST_CASE("follow-path: a part that is skipped breaks the order and does not count") {
    Attempt attempt;
    attempt.draw(0.0, 0.05);
    attempt.lift();
    attempt.draw(0.09, 0.15);
    CHECK(attempt.kinds() == Kinds{EventKind::path_begun, EventKind::order_broken});
    CHECK_FALSE(attempt.progress.complete);
    CHECK(attempt.metric("path_coverage") == doctest::Approx(1.0 / 3.0).scale(0.0).epsilon(1e-2));
    attempt.lift();
    attempt.draw(0.05, 0.15);
    CHECK(attempt.progress.complete);
}

TEST_CASE("follow-path: begun at the wrong end or in the middle it does not begin") {
    for (const double from_m : {0.15, 0.07}) {
        CAPTURE(from_m);
        Attempt attempt;
        attempt.draw(from_m, from_m - 0.03);
        CHECK(attempt.kinds() == Kinds{EventKind::order_broken});
        CHECK(attempt.progress.path.begin_tick == -1);
    }
}

TEST_CASE("follow-path: another tool on the path has the wrong role, once a contact") {
    Attempt attempt;
    attempt.draw(0.0, 0.03, 0.0, 0.5, Role::left);
    CHECK(attempt.kinds() == Kinds{EventKind::wrong_role});
    CHECK(attempt.progress.path.begin_tick == -1);
}

TEST_CASE("follow-path: a contact away from the path is off target, with any tool") {
    for (const Role role : {Role::right, Role::assist}) {
        Attempt attempt;
        attempt.draw(0.0, 0.03, 20e-3, 0.5, role);
        CHECK(attempt.kinds() == Kinds{EventKind::off_target});
    }
}

TEST_CASE("follow-path: too much force is an error, too little does not count") {
    Attempt attempt;
    attempt.draw(0.0, 0.03);
    attempt.draw(0.03, 0.06, 0.0, 2.5);
    CHECK(attempt.kinds() == Kinds{EventKind::path_begun, EventKind::over_force});
    attempt.draw(0.06, 0.09, 0.0, 0.05);
    attempt.draw(0.09, 0.15);
    CHECK(attempt.progress.complete);
    CHECK(attempt.kinds().size() == 3); // and completed
    CHECK(attempt.metric("path_coverage") == doctest::Approx(0.6).scale(0.0).epsilon(1e-2));
    CHECK(attempt.metric("path_in_band") == doctest::Approx(88.0 / 148.0).scale(0.0).epsilon(1e-2));
    CHECK(attempt.metric("path_breaks") == 0.0);
}

TEST_CASE("follow-path: the curve moves with the tissue") {
    Attempt attempt;
    for (int i = 0; i <= 7500 && !attempt.progress.complete; ++i) {
        const double sway_m = 8e-3 * std::sin(2.0 * std::numbers::pi * 0.3 * i * kTick_s);
        Observation seen = at_rest(attempt.exercise);
        for (int k = 0; k < seen.targets; ++k)
            seen.target[k].position_m.y += sway_m;
        touch(seen, Role::right, {kSpeed_mps * kTick_s * i, sway_m, 0.0}, 0.5);
        attempt.tick(seen);
    }
    CHECK(attempt.kinds() == Kinds{EventKind::path_begun, EventKind::completed});
    CHECK(attempt.metric("deviation_max") < 1e-9);
}

TEST_CASE("follow-path: a fold that is stopped, copied and resumed ends the same") {
    Attempt whole;
    whole.draw(0.0, 0.05);
    Attempt resumed = whole;
    for (Attempt* attempt : {&whole, &resumed}) {
        attempt->draw(0.05, 0.055, 6e-3);
        attempt->lift();
        attempt->draw(0.05, 0.15);
    }
    CHECK(whole.kinds() == resumed.kinds());
    CHECK(whole.progress.path.distance2_m2 == resumed.progress.path.distance2_m2);
    CHECK(whole.progress.complete_tick == resumed.progress.complete_tick);
}
