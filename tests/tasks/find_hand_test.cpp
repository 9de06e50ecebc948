// tests/tasks/find_hand_test.cpp
// The scripted person of find-tubes on a toy flap: lifts, points, and tries again what failed.
#include "tests/tasks/toy_flap.h"

#include <doctest/doctest.h>

using namespace tasks;
using namespace tasks::testing;

namespace {

constexpr std::array<const char*, 5> kSkills{"expert", "intermediate", "novice", "fast-careless",
                                             "slow-precise"};

int errors(const ToyFlap& rig) {
    return static_cast<int>(std::count_if(rig.progress.events.begin(), rig.progress.events.end(),
                                          [](const Event& e) { return is_error(e.kind); }));
}

} // namespace

TEST_CASE("find hand: every skill lifts the flap once and finds every tube") {
    for (const char* name : kSkills) {
        CAPTURE(std::string(name));
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            const ToyFlap rig = performed(skill_named(name), seed);
            CHECK(rig.progress.complete);
            CHECK(rig.grasps >= 1);
            CHECK(rig.let_go == 0);
            CHECK(count(rig.progress, EventKind::tube_found) == 3);
        }
    }
}

TEST_CASE("find hand: without errors there is none, and one grasp is enough") {
    for (const char* name : kSkills) {
        CAPTURE(std::string(name));
        const ToyFlap rig = performed(without_errors(skill_named(name)), 1);
        CHECK(rig.progress.complete);
        CHECK(rig.grasps == 1);
        CHECK(errors(rig) == 0);
    }
}

TEST_CASE("find hand: closings that catch nothing are tried again") {
    ToyFlap rig = make_flap();
    rig.misses = 2;
    rig = performed(without_errors(skill_named("expert")), 1, rig);
    CHECK(rig.progress.complete);
    CHECK(rig.grasps == 1);
    CHECK(errors(rig) == 0);
}

TEST_CASE("find hand: a flap that slips away is taken hold of again, whenever it does") {
    const HandSkill skill = without_errors(skill_named("expert"));
    const ToyFlap whole = performed(skill, 1);
    for (std::int64_t tick = 4000; tick < whole.progress.complete_tick; tick += 1500) {
        ToyFlap rig = make_flap();
        rig.slip_ticks = {tick};
        rig = performed(skill, 1, rig);
        CAPTURE(tick);
        CHECK(rig.progress.complete);
        CHECK(rig.grasps == 1 + rig.losses);
    }
    ToyFlap often = make_flap();
    for (int i = 1; i <= 6; ++i)
        often.slip_ticks.push_back(6000 * i);
    often = performed(skill, 1, often);
    CHECK(often.progress.complete);
    CHECK(often.losses >= 2);
}

TEST_CASE("find hand: jaws that lost the flap on the way up open after a reaction time") {
    const HandSkill skill = without_errors(skill_named("expert"));
    ToyFlap rig = make_flap();
    FindHand hand(skill, rig.exercise, 1, rig.start_tip_m);
    const auto go = [&](int ticks) {
        for (int i = 0; i < ticks; ++i)
            step(rig, hand.tick(sight_of(rig)), start_scope());
    };
    while (!rig.held && rig.now.tick < 20000)
        go(1);
    REQUIRE(rig.held);
    go(1000); // on its way
    REQUIRE(rig.held);
    REQUIRE_FALSE(rig.up);
    rig.slip_ticks = {rig.now.tick + 1};
    go(1 + static_cast<int>(skill.reaction_s / kTick_s));
    CHECK(rig.losses == 1);
    CHECK(rig.closed);
    go(2);
    CHECK_FALSE(rig.closed);
}

TEST_CASE("find hand: who mistakes the tool never takes the one that holds the flap") {
    HandSkill skill = without_errors(skill_named("expert"));
    skill.lapse = 1.0;
    int wrong = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const ToyFlap rig = performed(skill, seed);
        CHECK(rig.progress.complete);
        CHECK(rig.grasps == 1);
        CHECK(rig.let_go == 0);
        CHECK(rig.up);
        CHECK(rig.strayed_m < 6e-3); // it is held still
        for (const Event& event : rig.progress.events) {
            if (event.kind != EventKind::wrong_role)
                continue;
            ++wrong;
            CHECK(event.tool != static_cast<int>(rig.exercise.lift->role));
        }
    }
    CHECK(wrong > 10); // half of 60 lapses
}

TEST_CASE("find hand: nothing to lift, nothing is lifted") {
    ToyFlap rig = make_flap();
    const Exercise all = rig.exercise;
    Exercise bare = all; // the toy's tubes lie open then
    bare.lift.reset();
    FindHand hand(without_errors(skill_named("expert")), bare, 1, rig.start_tip_m);
    Progress progress;
    for (int i = 0; i < 60000 && !progress.complete; ++i) {
        HandSight sight = sight_of(rig);
        sight.found = found_tubes(progress);
        sight.done = progress.complete;
        const HandGoals goals = hand.tick(sight);
        CHECK(goals.jaw[0] == 0.0);
        int next = 0;
        while (next < 2 && (sight.found & (1U << next)))
            ++next;
        step(rig, goals, {true, all.target[static_cast<std::size_t>(next)].at_m, 0.08, 0.0});
        for (std::size_t k = 0; k < all.target.size(); ++k)
            rig.now.target[k].clear_rays = kSightRays;
        observe(progress, bare, rig.now);
    }
    CHECK(progress.complete);
}

TEST_CASE("find hand: the same seed gives the same attempt to the tick, another seed another") {
    const HandSkill skill = skill_named("novice");
    const auto at = [&](std::uint64_t seed) {
        return performed(skill, seed).progress.complete_tick;
    };
    CHECK(at(5) == at(5));
    CHECK(at(5) != at(6));
}
