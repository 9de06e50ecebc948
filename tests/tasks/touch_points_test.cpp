// tests/tasks/touch_points_test.cpp
// The fold of touch-points: when a target counts as touched, and what is an error.
#include "tasks/exercise/progress.h"

#include "relative.h"

#include "attempt.h"

#include <rapidcheck.h>

using namespace tasks;
using namespace tasks::testing;

TEST_CASE("a target is touched after hold_s in the band without a break, and not one tick before") {
    const Exercise exercise = two_points();
    Progress progress;
    Observation seen = at_rest(exercise);
    repeat(progress, exercise, seen, 10);
    touch(seen, Role::right, {0.002, 0.0, 0.0}, 0.5);
    repeat(progress, exercise, seen, 299);
    CHECK(progress.next == 0);
    Observation weak = seen; // one tick below the band
    weak.tool[1].force_n.z = 0.09;
    repeat(progress, exercise, weak, 1);
    repeat(progress, exercise, seen, 299);
    CHECK(progress.next == 0);
    repeat(progress, exercise, seen, 1);
    CHECK(progress.next == 1);
    CHECK(count(progress, EventKind::target_touched) == 1);
    CHECK(progress.events.back().tick == 10 + 299 + 1 + 300 - 1);
    CHECK(progress.events.back().tool == 1);
    CHECK(progress.events.back().target == 0);
    CHECK(progress.events.back().value == relative(0.5));
}

TEST_CASE("the band and the radius are inclusive, a hair outside is out") {
    const Exercise exercise = two_points();
    const auto touched = [&](double x_m, double force_n) {
        Progress progress;
        Observation seen = at_rest(exercise);
        touch(seen, Role::right, {x_m, 0.0, 0.0}, force_n);
        repeat(progress, exercise, seen, 400);
        return progress.next == 1;
    };
    CHECK(touched(0.003, 0.5));
    CHECK_FALSE(touched(0.00301, 0.5));
    CHECK(touched(0.0, 0.1));
    CHECK_FALSE(touched(0.0, 0.0999));
    CHECK(touched(0.0, 1.0));
    CHECK_FALSE(touched(0.0, 1.001));
}

TEST_CASE("a tip that sinks below a coarse surface is as near as it is along the surface") {
    ToolObservation tool;
    tool.tip_m = {0.002, 0.0, 0.001}; // sphere centre barely above the surface
    tool.contact_m = {0.002, 0.0, -0.002};
    CHECK(reach_m(tool, {0.0, 0.0, 0.0}) == relative(0.002));
    CHECK(reach_m(tool, {0.002, 0.0, 0.004}) == relative(0.003)); // above the tip
}

TEST_CASE("the last target completes the attempt and nothing counts after it") {
    const Exercise exercise = two_points();
    Progress progress;
    Observation seen = at_rest(exercise);
    repeat(progress, exercise, seen, 1);
    touch(seen, Role::right, {0.0, 0.0, 0.0}, 0.5);
    repeat(progress, exercise, seen, 300);
    Observation left = at_rest(exercise);
    touch(left, Role::left, {0.03, 0.0, 0.0}, 0.5);
    repeat(progress, exercise, left, 300);
    CHECK(progress.complete);
    CHECK(progress.complete_tick == 600);
    CHECK(progress.events.back().kind == EventKind::completed);
    CHECK(progress.first_move_tick == 1);
    const auto events = progress.events.size();
    left.tool[0].force_n.z = 50.0;
    repeat(progress, exercise, left, 300);
    CHECK(progress.events.size() == events);
    CHECK_FALSE(timed_out(progress, exercise));
}

TEST_CASE("the first movement is the first tip more than 1 mm from where it started") {
    const Exercise exercise = two_points();
    Progress progress;
    Observation seen = at_rest(exercise);
    repeat(progress, exercise, seen, 100);
    seen.tool[2].tip_m.x += 0.9e-3;
    repeat(progress, exercise, seen, 100);
    CHECK(progress.first_move_tick == -1);
    seen.tool[2].tip_m.x += 0.2e-3;
    repeat(progress, exercise, seen, 100);
    CHECK(progress.first_move_tick == 200);
}

TEST_CASE("another tool on the next target is one wrong role after 0.1 s, however long it stays") {
    const Exercise exercise = two_points();
    Progress progress;
    Observation seen = at_rest(exercise);
    touch(seen, Role::left, {0.001, 0.0, 0.0}, 0.5);
    repeat(progress, exercise, seen, 99);
    CHECK(count(progress, EventKind::wrong_role) == 0);
    repeat(progress, exercise, seen, 900);
    CHECK(count(progress, EventKind::wrong_role) == 1);
    CHECK(count(progress, EventKind::off_target) == 0);
    repeat(progress, exercise, at_rest(exercise), 100);
    repeat(progress, exercise, seen, 200);
    CHECK(count(progress, EventKind::wrong_role) == 2);
    CHECK(progress.next == 0);
}

TEST_CASE("a wrong tool that rattles on the target is one contact and one mistake") {
    const Exercise exercise = two_points();
    Progress progress;
    Observation on = at_rest(exercise), off = at_rest(exercise);
    touch(on, Role::left, {0.0, 0.0, 0.0}, 0.5);
    for (int i = 0; i < 60; ++i) {
        repeat(progress, exercise, on, 10);
        repeat(progress, exercise, off, 10);
    }
    CHECK(count(progress, EventKind::wrong_role) == 1);
    CHECK(count(progress, EventKind::contact_begin) == 1);
}

TEST_CASE("the tool that rests on the target it has just touched makes no mistake") {
    Exercise exercise = two_points();
    exercise.target[1].at_m = {0.01, 0.0, 0.0};
    Progress progress;
    Observation seen = at_rest(exercise);
    touch(seen, Role::right, {0.0, 0.0, 0.0}, 0.5);
    repeat(progress, exercise, seen, 3000);
    CHECK(progress.next == 1);
    for (const Event& event : progress.events)
        CHECK_FALSE(is_error(event.kind));
}

TEST_CASE("force over the limit is one error until it has fallen below 80 percent of it") {
    const Exercise exercise = two_points();
    Progress progress;
    Observation seen = at_rest(exercise);
    const auto press = [&](double force_n, int n) {
        touch(seen, Role::right, {0.0, 0.0, 0.0}, force_n);
        repeat(progress, exercise, seen, n);
        return count(progress, EventKind::over_force);
    };
    CHECK(press(2.0, 100) == 0);
    CHECK(press(2.01, 1) == 1);
    CHECK(press(1.61, 10) == 1);
    CHECK(press(3.0, 10) == 1);
    CHECK(press(1.59, 10) == 1);
    CHECK(press(2.5, 10) == 2);
    CHECK(progress.events.back().value == relative(2.5));
}

TEST_CASE("contact away from every target for 0.15 s is one error; near any target it is none") {
    const Exercise exercise = two_points();
    const auto errors = [&](double x_m, int n) {
        Progress progress;
        Observation seen = at_rest(exercise);
        touch(seen, Role::right, {x_m, 0.0, 0.0}, 0.2);
        repeat(progress, exercise, seen, n);
        return count(progress, EventKind::off_target);
    };
    CHECK(errors(0.0061, 149) == 0);
    CHECK(errors(0.0061, 150) == 1);
    CHECK(errors(0.0061, 5000) == 1);
    CHECK(errors(0.0059, 5000) == 0);
    CHECK(errors(0.0245, 5000) == 0); // target "b" is there
}

TEST_CASE("a tip that slides away while it holds is off target once it is 3 mm past the radius") {
    const Exercise exercise = two_points();
    Progress progress;
    Observation seen = at_rest(exercise);
    for (int i = 0; i < 1000; ++i) { // 10 mm/s along x
        touch(seen, Role::right, {i * 1e-5, 0.01, 0.0}, 0.05);
        seen.tool[1].contact_m.y = 0.0;
        seen.tool[1].tip_m.y = 0.0;
        repeat(progress, exercise, seen, 1);
    }
    REQUIRE(count(progress, EventKind::off_target) == 1);
    CHECK(progress.events.back().tick == 600 + 150);
}

TEST_CASE("a moving tool out of the picture for more than half a second is an error") {
    const Exercise exercise = two_points();
    const auto errors = [&](bool seen_before, double speed_mps, int n) {
        Progress progress;
        Observation seen = at_rest(exercise);
        if (seen_before)
            repeat(progress, exercise, seen, 10);
        for (int i = 0; i < n; ++i) {
            seen.tool[1].tip_m = {1.0 + i * 1e-3 * speed_mps, 0.0, 0.05};
            repeat(progress, exercise, seen, 1);
        }
        return count(progress, EventKind::out_of_view);
    };
    CHECK(errors(true, 0.02, 500) == 0);
    CHECK(errors(true, 0.02, 501) == 1);
    CHECK(errors(true, 0.02, 5000) == 1);
    CHECK(errors(true, 0.0, 5000) == 0);   // rests there
    CHECK(errors(false, 0.02, 5000) == 0); // was never in the picture
}

TEST_CASE("an absent tool makes no mistakes and its contact ends") {
    const Exercise exercise = two_points();
    Progress progress;
    Observation seen = at_rest(exercise);
    touch(seen, Role::left, {0.0, 0.01, 0.0}, 0.5);
    repeat(progress, exercise, seen, 10);
    seen.tool[0].present = false;
    seen.tool[0].force_n.z = 9.0;
    repeat(progress, exercise, seen, 1000);
    CHECK(count(progress, EventKind::contact_end) == 1);
    CHECK(count(progress, EventKind::off_target) == 0);
    CHECK(count(progress, EventKind::over_force) == 0);
}

TEST_CASE("a pause breaks a hold") {
    const Exercise exercise = two_points();
    Progress progress;
    Observation seen = at_rest(exercise);
    touch(seen, Role::right, {0.0, 0.0, 0.0}, 0.5);
    repeat(progress, exercise, seen, 200);
    seen.tick = progress.last_tick + 5000;
    observe(progress, exercise, seen);
    repeat(progress, exercise, seen, 298);
    CHECK(progress.next == 0);
    repeat(progress, exercise, seen, 1);
    CHECK(progress.next == 1);
}

TEST_CASE("an attempt times out time_limit_s after its first movement") {
    Exercise exercise = two_points();
    exercise.time_limit_s = 1.0;
    Progress progress;
    Observation seen = at_rest(exercise);
    repeat(progress, exercise, seen, 3000);
    CHECK_FALSE(timed_out(progress, exercise));
    seen.tool[1].tip_m.x += 0.01;
    repeat(progress, exercise, seen, 1000);
    CHECK_FALSE(timed_out(progress, exercise));
    repeat(progress, exercise, seen, 1);
    CHECK(timed_out(progress, exercise));
}

TEST_CASE("the fold can be stopped, copied and resumed anywhere with the same result") {
    CHECK(rc::check("resumable", [](std::vector<unsigned> choices, unsigned stop) {
        const Exercise exercise = two_points();
        const auto at = [&](std::size_t i) {
            Observation seen = at_rest(exercise);
            const unsigned c = choices[i / 120];
            const glm::dvec3 place{0.01 * (c % 4), 0.002 * (c / 4 % 3), 0.0};
            if (c % 5 != 0)
                touch(seen, static_cast<Role>(c % 3), place, 0.3 * (c % 9));
            seen.tick = static_cast<std::int64_t>(i);
            return seen;
        };
        const std::size_t n = choices.size() * 120;
        Progress whole, first;
        for (std::size_t i = 0; i < n; ++i)
            observe(whole, exercise, at(i));
        const std::size_t half = n == 0 ? 0 : stop % n;
        for (std::size_t i = 0; i < half; ++i)
            observe(first, exercise, at(i));
        Progress second = first;
        for (std::size_t i = half; i < n; ++i)
            observe(second, exercise, at(i));
        RC_ASSERT(second.next == whole.next);
        RC_ASSERT(second.events.size() == whole.events.size());
        for (std::size_t i = 0; i < whole.events.size(); ++i) {
            RC_ASSERT(second.events[i].tick == whole.events[i].tick);
            RC_ASSERT(second.events[i].kind == whole.events[i].kind);
            RC_ASSERT(second.events[i].value == whole.events[i].value);
            if (i > 0) // RC_ASSERT evaluates both sides of ||
                RC_ASSERT(whole.events[i].tick >= whole.events[i - 1].tick);
        }
    }));
}
