// tests/tasks/find_tubes_errors_test.cpp
// Every mistake one can make at finding tubes, on observations made by hand: once each.
#include "tests/tasks/relative.h"
#include "tests/tasks/tubes.h"

using namespace tasks;
using namespace tasks::testing;

TEST_CASE("find-tubes: a tube seen for point_within_s and not pointed at is one mistake, until it "
          "was out of the picture or pointed at") {
    Search search;
    search.go(search.shown(2), 9999);
    CHECK(search.kinds() == Kinds{});
    search.go(search.shown(2), 1);
    CHECK(search.kinds() == Kinds{EventKind::tube_not_pointed});
    CHECK(search.progress.events.back().value == relative(10.0));
    CHECK(search.progress.events.back().target == 2);
    CHECK(search.progress.events.back().tool == static_cast<int>(Role::assist));
    search.go(search.shown(2), 30000);
    CHECK(search.count_of(EventKind::tube_not_pointed) == 1);
    search.go(search.hidden(), 1);
    search.go(search.shown(2), 10000);
    CHECK(search.count_of(EventKind::tube_not_pointed) == 2);
    search.go(search.shown(2, Role::assist), 1);
    search.go(search.shown(2), 10000);
    CHECK(search.count_of(EventKind::tube_not_pointed) == 3);
    search.go(search.shown(2, Role::assist), 1000);
    search.go(search.shown(2), 30000); // it is found
    CHECK(search.kinds() == Kinds{EventKind::tube_not_pointed, EventKind::tube_not_pointed,
                                  EventKind::tube_not_pointed, EventKind::tube_found});
}

TEST_CASE("find-tubes: pointing half a second longer than the hold at what is not seen is one "
          "mistake, until the tool goes away") {
    Search search;
    Observation blind = search.hidden();
    point(blind, Role::right, 0);
    search.go(blind, 1499);
    CHECK(search.kinds() == Kinds{});
    search.go(blind, 1);
    CHECK(search.kinds() == Kinds{EventKind::tube_not_seen});
    CHECK(search.progress.events.back().value == relative(1.5));
    CHECK(search.progress.events.back().target == 0);
    CHECK(search.progress.events.back().tool == static_cast<int>(Role::right));
    search.go(blind, 20000);
    // seen in between, still there: it is the same mistake
    search.go(search.shown(0, Role::right), 500);
    search.go(blind, 2000);
    CHECK(search.count_of(EventKind::tube_not_seen) == 1);
    search.go(search.hidden(), 1);
    search.go(blind, 1500);
    CHECK(search.count_of(EventKind::tube_not_seen) == 2);
    search.go(search.hidden(), 1); // seen in between starts the time anew
    search.go(blind, 1400);
    search.go(search.shown(0, Role::right), 1);
    search.go(blind, 1400);
    CHECK(search.count_of(EventKind::tube_not_seen) == 2);
}

TEST_CASE("find-tubes: the wrong tool at a tube for half a second is one mistake, seen or not") {
    for (const bool seen : {true, false}) {
        Search search;
        Observation wrong = seen ? search.shown(0) : search.hidden();
        point(wrong, Role::assist, 0);
        search.go(wrong, 499);
        CHECK(search.kinds() == Kinds{});
        search.go(wrong, 1);
        CHECK(search.kinds() == Kinds{EventKind::wrong_role});
        CHECK(search.progress.events.back().tool == static_cast<int>(Role::assist));
        CHECK(search.progress.events.back().target == 0);
        search.go(wrong, 5000);
        CHECK(search.kinds() == Kinds{EventKind::wrong_role});
        search.go(search.hidden(), 1);
        search.go(wrong, 500);
        CHECK(search.count_of(EventKind::wrong_role) == 2);
    }
    Search search; // no mistake at what is found
    search.go(search.shown(0, Role::right), 1000);
    search.go(search.shown(0, Role::assist), 5000);
    CHECK(search.kinds() == Kinds{EventKind::tube_found});
}

TEST_CASE("find-tubes: contact is off target 8 mm from every tube, any tool, after 0.15 s") {
    Search search;
    const auto errors = [&](Role role, const glm::dvec3& place_m, int n) {
        Search other;
        Observation seen = other.hidden();
        touch(seen, role, place_m, 0.2);
        other.go(seen, n);
        CHECK(other.count_of(EventKind::off_target) ==
              static_cast<int>(other.kinds().size())); // nothing else
        return other.count_of(EventKind::off_target);
    };
    for (const Role role : {Role::left, Role::right, Role::assist}) {
        CHECK(errors(role, {0.0, 0.0081, 0.0}, 149) == 0);
        CHECK(errors(role, {0.0, 0.0081, 0.0}, 150) == 1);
        CHECK(errors(role, {0.0, 0.0081, 0.0}, 5000) == 1);
        CHECK(errors(role, {0.0, 0.0079, 0.0}, 450) == 0);
    }
    // two contacts are two mistakes
    Observation off = search.hidden();
    touch(off, Role::assist, {0.0, 0.03, 0.0}, 0.2);
    for (int i = 0; i < 2; ++i) {
        search.go(off, 1000);
        search.go(search.hidden(), 50);
    }
    CHECK(search.kinds() == Kinds{EventKind::off_target, EventKind::off_target});
}

TEST_CASE("find-tubes: the lifting tool alone may touch where it lifts, and what it holds "
          "anywhere") {
    const auto errors = [](Role role, const glm::dvec3& place_m, bool grasping,
                           bool with_lift = true) {
        Search search;
        if (!with_lift)
            search.exercise.lift.reset();
        Observation seen = search.hidden();
        touch(seen, role, place_m, 0.2);
        seen.tool[static_cast<std::size_t>(role)].grasping = grasping;
        search.go(seen, 1000);
        return search.count_of(EventKind::off_target);
    };
    const glm::dvec3 at_flap{0.0, -0.05, 0.0}, beside = at_flap + glm::dvec3{0.0179, 0.0, 0.0},
                                               past = at_flap + glm::dvec3{0.0181, 0.0, 0.0};
    CHECK(errors(Role::left, at_flap, false) == 0);
    CHECK(errors(Role::left, beside, false) == 0); // 15 mm and the 3 that everybody has
    CHECK(errors(Role::left, past, false) == 1);
    CHECK(errors(Role::left, past, true) == 0);
    CHECK(errors(Role::right, at_flap, false) == 1);
    CHECK(errors(Role::right, past, true) == 1);
    CHECK(errors(Role::left, at_flap, false, false) == 1);
    CHECK(errors(Role::left, past, true, false) == 1);
}

TEST_CASE("find-tubes: the place to lift goes where the tissue goes") {
    Search search;
    Observation seen = search.hidden();
    seen.target[3].position_m = {0.0, 0.05, 0.05};
    touch(seen, Role::left, {0.0, 0.05, 0.05}, 0.2);
    search.go(seen, 1000);
    CHECK(search.kinds() == Kinds{});
    touch(seen, Role::left, {0.0, -0.05, 0.0}, 0.2);
    search.go(seen, 1000);
    CHECK(search.kinds() == Kinds{EventKind::off_target});
}

TEST_CASE("find-tubes: force over the limit is one error until it is below 80 percent of it, also "
          "of the lift") {
    Search search;
    const auto pull = [&](double force_n, int n) {
        Observation seen = search.hidden();
        touch(seen, Role::left, {0.0, -0.05, 0.0}, force_n);
        seen.tool[0].grasping = true;
        search.go(seen, n);
        return search.count_of(EventKind::over_force);
    };
    CHECK(pull(2.0, 100) == 0);
    CHECK(pull(2.01, 1) == 1);
    CHECK(pull(1.61, 10) == 1);
    CHECK(pull(3.0, 500) == 1);
    CHECK(pull(1.59, 1) == 1);
    CHECK(pull(2.01, 1) == 2);
    CHECK(search.kinds() == Kinds{EventKind::over_force, EventKind::over_force});
}

TEST_CASE("find-tubes: a tool that moves unseen for half a second is one error until it is seen") {
    Search search;
    search.go(search.hidden(), 10);
    Observation out = search.hidden();
    const auto wander = [&](int n) {
        for (int i = 0; i < n; ++i) {
            out.tool[2].tip_m = {0.5 + 1e-5 * i, 0.0, 0.0};
            search.go(out, 1);
        }
        return search.count_of(EventKind::out_of_view);
    };
    CHECK(wander(500) == 0);
    CHECK(wander(3000) == 1);
    search.go(search.hidden(), 1);
    CHECK(wander(502) == 2);
    CHECK(search.kinds() == Kinds{EventKind::out_of_view, EventKind::out_of_view});
}
