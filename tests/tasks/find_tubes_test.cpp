// tests/tasks/find_tubes_test.cpp
// Finding tubes on observations made by hand; the mistakes are in find_tubes_errors_test.cpp.
#include "tasks/exercise/find_tubes.h"

#include "tests/tasks/relative.h"
#include "tests/tasks/tubes.h"

#include <cmath>
#include <rapidcheck.h>

using namespace tasks;
using namespace tasks::testing;

namespace {

/// Found within what a hold needs and a second more.
bool finds(const Observation& seen, const Exercise& exercise = three_tubes()) {
    Progress progress;
    repeat(progress, exercise, seen, 2000);
    return found_tubes(progress) != 0;
}

} // namespace

TEST_CASE("find-tubes: a place in the picture is where and as large as a pinhole shows it") {
    View view; // 2 high at depth 1, looks along x, up is z
    view.eye_m = {1.0, 2.0, 3.0};
    view.forward = {1.0, 0.0, 0.0};
    view.up = {0.0, 0.0, 1.0};
    view.field_of_view_rad = 2.0 * std::atan(1.0);
    const glm::dvec3 ahead = view.eye_m + glm::dvec3{0.4, 0.0, 0.0};
    CHECK(off_centre(view, ahead) == 0.0);
    CHECK(off_centre(view, ahead + glm::dvec3{0.0, 0.0, 0.2}) == relative(0.25));
    CHECK(off_centre(view, ahead + glm::dvec3{0.0, -0.2, 0.0}) == relative(0.25));
    CHECK(off_centre(view, ahead + glm::dvec3{0.0, 0.3, 0.4}) == relative(0.625)); // 0.5 m aside
    CHECK(size_in_view(view, ahead, 0.02) == relative(0.05)); // 0.04 m wide of 0.8 m
    CHECK(size_in_view(view, ahead + glm::dvec3{0.0, 0.3, 0.0}, 0.02) == relative(0.05));
    CHECK(size_in_view(view, ahead + glm::dvec3{0.4, 0.0, 0.0}, 0.02) == relative(0.025));
    const glm::dvec3 behind = view.eye_m - glm::dvec3{0.4, 0.0, 0.0};
    for (const glm::dvec3& place_m : {behind, view.eye_m}) {
        CHECK(std::isinf(off_centre(view, place_m)));
        CHECK(size_in_view(view, place_m, 0.02) == 0.0);
    }
}

TEST_CASE("find-tubes: a tube is found after hold_s seen and pointed at, and not one tick before") {
    Search search;
    search.go(search.hidden(), 10);
    const Observation both = search.shown(1, Role::right);
    search.go(both, 999);
    search.go(search.shown(1), 1); // for one tick nobody points
    search.go(both, 999);
    Observation covered = both; // for one tick something is before it
    covered.target[1].clear_rays = kEnoughRays - 1;
    search.go(covered, 1);
    search.go(both, 999);
    CHECK(search.kinds() == Kinds{});
    search.go(both, 1);
    CHECK(search.kinds() == Kinds{EventKind::tube_found});
    const Event& found = search.progress.events.back();
    CHECK(found.tick == 10 + 999 + 1 + 999 + 1 + 1000 - 1);
    CHECK(found.tool == static_cast<int>(Role::right));
    CHECK(found.target == 1);
    CHECK(found.value == relative(1.0));
    CHECK(found.place_m == search.exercise.target[1].at_m);
    CHECK(found_tubes(search.progress) == 0b010u);
}

TEST_CASE("find-tubes: seen is clear, centred and large, each up to its limit and not beyond") {
    Search search;
    const Observation good = search.shown(0, Role::right);
    const double half_height_m = kNear_m * std::tan(0.5 * good.view.field_of_view_rad);
    REQUIRE(finds(good));
    for (int rays = 0; rays <= kSightRays; ++rays) {
        Observation seen = good;
        seen.target[0].clear_rays = rays;
        CHECK(finds(seen) == (rays >= kEnoughRays));
    }
    for (const double share : {0.149, 0.151}) {
        for (const double angle : {0.0, 1.0, 2.0, 4.0}) {
            Observation seen = good;
            seen.view.eye_m +=
                2.0 * half_height_m * share * glm::dvec3{std::cos(angle), std::sin(angle), 0.0};
            CHECK(finds(seen) == (share < 0.15));
        }
    }
    // 3 mm of radius are 0.04 of the height from 75 mm / tan(half the field)
    const double far_m = 0.075 / std::tan(0.5 * good.view.field_of_view_rad);
    for (const double distance_m : {0.999 * far_m, 1.001 * far_m}) {
        Observation seen = good;
        seen.view.eye_m.z = distance_m;
        CHECK(finds(seen) == (distance_m < far_m));
    }
    Observation away = good;
    away.view.forward = -away.view.forward;
    CHECK_FALSE(finds(away));
}

TEST_CASE("find-tubes: pointed at is the tip of its role within the radius, touching or not") {
    Search search;
    for (const double distance_m : {0.0, 4.999e-3, 5.001e-3}) {
        Observation seen = search.shown(0);
        seen.tool[1].tip_m = distance_m * glm::dvec3{0.6, 0.0, 0.8};
        CHECK(finds(seen) == (distance_m < 5e-3));
    }
    Observation touching = search.shown(0);
    touch(touching, Role::right, {0.0, 0.0, 0.0}, 0.3);
    CHECK(finds(touching));
    Observation absent = search.shown(0, Role::right);
    absent.tool[1].present = false;
    CHECK_FALSE(finds(absent));
    for (const Role other : {Role::left, Role::assist})
        CHECK_FALSE(finds(search.shown(0, other)));
    CHECK(finds(search.shown(2, Role::assist)));
}

TEST_CASE("find-tubes: any order completes it, each tube counts once, nothing counts after it") {
    std::array<int, 3> order{0, 1, 2};
    do {
        Search search;
        std::uint32_t found = 0;
        for (int i = 0; i < 3; ++i) {
            const int k = order[i];
            CHECK(share_done(search.progress, search.exercise) == i / 3.0);
            search.go(search.shown(k, search.exercise.target[k].role), 2500);
            found |= 1u << k;
            CHECK(found_tubes(search.progress) == found);
        }
        CHECK(search.kinds() == Kinds{EventKind::tube_found, EventKind::tube_found,
                                      EventKind::tube_found, EventKind::completed});
        CHECK(share_done(search.progress, search.exercise) == 1.0);
        CHECK(search.progress.complete);
        CHECK(search.progress.complete_tick == 2 * 2500 + 999);
        CHECK(search.progress.events.back().target == -1);
        CHECK(search.progress.next == 3);
        const auto events = search.progress.events.size();
        Observation wild = search.hidden();
        touch(wild, Role::assist, {0.0, 0.06, 0.0}, 9.0);
        search.go(wild, 3000);
        CHECK(search.progress.events.size() == events);
        CHECK(search.progress.complete_tick == 2 * 2500 + 999);
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("find-tubes: how far the hold of a tube has come, whichever is pointed at") {
    Search search;
    const auto share = [&] { return share_at_next(search.progress, search.exercise); };
    search.go(search.shown(1, Role::right), 250);
    CHECK(share() == relative(0.25));
    search.go(search.shown(1, Role::right), 749);
    CHECK(share() == relative(0.999));
    search.go(search.shown(1, Role::right), 1);
    CHECK(search.progress.next == 0);
    CHECK(share() == 0.0);
    search.go(search.shown(2, Role::assist), 400);
    CHECK(share() == relative(0.4));
    search.go(search.hidden(), 1);
    CHECK(share() == 0.0);
}

TEST_CASE("find-tubes: a pause clears what was counted, and forgets no mistake") {
    Search search;
    const auto after_pause = [&](Observation seen, int before, int after) {
        search.go(seen, before);
        seen.tick = search.progress.last_tick + 60000;
        observe(search.progress, search.exercise, seen);
        search.go(seen, after - 1);
    };
    after_pause(search.shown(0, Role::right), 999, 999);
    CHECK(search.kinds() == Kinds{});
    search.go(search.shown(0, Role::right), 1);
    CHECK(search.kinds() == Kinds{EventKind::tube_found});
    after_pause(search.shown(1), 9999, 9999);
    Observation blind = search.hidden();
    point(blind, Role::right, 1);
    after_pause(blind, 1499, 1499);
    Observation wrong = search.hidden();
    point(wrong, Role::assist, 1);
    after_pause(wrong, 499, 499);
    CHECK(search.kinds() == Kinds{EventKind::tube_found});
    after_pause(wrong, 1, 5000); // the mistake from before the pause stays one
    CHECK(search.kinds() == Kinds{EventKind::tube_found, EventKind::wrong_role});
}

TEST_CASE("find-tubes: an observation of fewer places than the exercise has completes nothing") {
    Search search;
    Observation seen = search.shown(0, Role::right);
    seen.targets = 1;
    search.go(seen, 3000);
    CHECK(search.kinds() == Kinds{EventKind::tube_found});
    CHECK_FALSE(search.progress.complete);
    seen.targets = 0;
    search.go(seen, 3000);
    CHECK(search.kinds() == Kinds{EventKind::tube_found});
}

TEST_CASE("find-tubes: a fold that is stopped, copied and resumed anywhere ends the same") {
    CHECK(rc::check("resumable", [](const std::vector<unsigned>& choices, unsigned stop) {
        constexpr std::size_t kEach = 400;
        Search made;
        made.exercise.hold_s = 0.5;
        made.exercise.point_within_s = 1.0;
        const auto at = [&](std::size_t i) {
            const unsigned c = choices[i / kEach];
            Observation seen = made.hidden();
            if (c % 4 < 3)
                show(seen, static_cast<int>(c % 4));
            if (c / 4 % 4 < 3)
                point(seen, static_cast<Role>(c % 3), static_cast<int>(c / 4 % 4));
            if (c / 16 % 3 == 0)
                touch(seen, static_cast<Role>(c / 48 % 3), {0.0, -0.01 * (c % 7), 0.0},
                      0.5 * (c % 6));
            seen.tool[0].grasping = c / 5 % 2 == 0;
            seen.tick = static_cast<std::int64_t>(i + c % 2); // now and then a gap
            return seen;
        };
        const auto fold = [&](Progress progress, std::size_t from, std::size_t to) {
            for (std::size_t i = from; i < to; ++i)
                observe(progress, made.exercise, at(i));
            return progress;
        };
        const std::size_t n = choices.size() * kEach;
        const std::size_t half = n == 0 ? 0 : stop % n;
        const Progress whole = fold({}, 0, n), second = fold(fold({}, 0, half), half, n);
        RC_ASSERT(second.complete == whole.complete);
        RC_ASSERT(found_tubes(second) == found_tubes(whole));
        RC_ASSERT(second.lifted_sum_n == whole.lifted_sum_n);
        RC_ASSERT(second.events.size() == whole.events.size());
        for (std::size_t i = 0; i < whole.events.size(); ++i) {
            RC_ASSERT(second.events[i].tick == whole.events[i].tick);
            RC_ASSERT(second.events[i].kind == whole.events[i].kind);
            RC_ASSERT(second.events[i].target == whole.events[i].target);
            RC_ASSERT(second.events[i].value == whole.events[i].value);
        }
    }));
}
