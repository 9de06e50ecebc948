// tests/tasks/find_hint_test.cpp
// What the window says is missing, against what the score counts.
#include "attempt.h"
#include "tasks/exercise/find_hint.h"

#include <doctest/doctest.h>

using namespace tasks;
using namespace tasks::testing;

namespace {

constexpr auto kLeft = static_cast<std::size_t>(Role::left);
constexpr auto kRight = static_cast<std::size_t>(Role::right);

Exercise search() {
    Exercise exercise;
    exercise.kind = ExerciseKind::find_tubes;
    exercise.target = {{"a", Role::right, {-0.03, 0.0, 0.0}}, {"b", Role::right, {0.02, 0.0, 0.0}}};
    exercise.lift = Lift{.at_m = {0.0, -0.03, 0.0}, .organ = "flap", .to_m = {0.0, -0.03, 0.04}};
    return exercise;
}

Observation covered(const Exercise& exercise) {
    Observation seen = at_rest(exercise);
    seen.target[2].position_m = exercise.lift->at_m;
    seen.targets = 3;
    return seen;
}

Observation lifted(const Exercise& exercise) {
    Observation seen = covered(exercise);
    seen.target[2].position_m = exercise.lift->to_m;
    seen.tool[kLeft].tip_m = exercise.lift->to_m;
    seen.tool[kLeft].grasping = true;
    seen.target[0].clear_rays = seen.target[1].clear_rays = kSightRays;
    return seen;
}

/// The endoscope before a tube, straight above it.
void look_at(Observation& seen, std::size_t tube, double distance_m) {
    seen.view.eye_m = seen.target[tube].position_m + glm::dvec3{0.0, 0.0, distance_m};
}

std::string words(const Exercise& exercise, const Observation& seen, std::uint32_t found = 0) {
    return find_hint(exercise, seen, found).words;
}

} // namespace

TEST_CASE("Each step of find-tubes has its words, until it is done") {
    const Exercise exercise = search();
    Observation seen = covered(exercise);
    CHECK(words(exercise, seen) == "Lift the flap with the left tool");
    CHECK(find_hint(exercise, seen, 0).lift);
    seen.tool[kLeft].tip_m = exercise.lift->at_m;
    seen.tool[kLeft].grasping = true;
    CHECK(words(exercise, seen) == "Lift the flap higher");
    seen = lifted(exercise);
    seen.view.eye_m = {0.1, 0.0, 0.2};
    CHECK(words(exercise, seen) == "Bring tube 2 into the ring");
    look_at(seen, 1, 0.25);
    CHECK(words(exercise, seen) == "Nearer to tube 2");
    look_at(seen, 1, 0.06);
    CHECK(words(exercise, seen) == "Point at tube 2 with the right tool");
    seen.tool[kRight].tip_m = seen.target[1].position_m;
    CHECK(words(exercise, seen) == "Tube 2: hold still");
    CHECK(words(exercise, seen, 2U) == "Bring tube 1 into the ring");
    CHECK(words(exercise, seen, 3U) == "All tubes found");
}

TEST_CASE("Who does what the words say comes to a tube that is found") {
    const Exercise exercise = search();
    Observation seen = lifted(exercise);
    look_at(seen, 0, 0.06);
    seen.tool[kRight].tip_m = seen.target[0].position_m;
    Progress progress;
    repeat(progress, exercise, seen, static_cast<int>(exercise.hold_s / kTick_s) - 1);
    CHECK(words(exercise, seen, found_tubes(progress)) == "Tube 1: hold still");
    CHECK(share_at_next(progress, exercise) == doctest::Approx(1.0).scale(0.0).epsilon(0.01));
    repeat(progress, exercise, seen, 1);
    CHECK(found_tubes(progress) == 1U);
    CHECK(find_hint(exercise, seen, found_tubes(progress)).tube == 1);
}

TEST_CASE("Any order: the hold that is shown is that of the tube that is held") {
    const Exercise exercise = search();
    Observation seen = lifted(exercise);
    look_at(seen, 1, 0.06);
    seen.tool[kRight].tip_m = seen.target[1].position_m;
    Progress progress;
    repeat(progress, exercise, seen, static_cast<int>(0.5 * exercise.hold_s / kTick_s));
    CHECK(progress.next == 0);
    seen.view.eye_m += glm::dvec3{-0.004, 0.0, 0.0}; // nearer to a third tube, which is not meant
    Exercise crowded = exercise;
    crowded.target.push_back({"c", Role::right, {0.014, 0.0, 0.0}});
    crowded.lift.reset();
    seen.target[2] = {.position_m = crowded.target[2].at_m, .clear_rays = kSightRays};
    CHECK(words(crowded, seen) == "Tube 2: hold still");
    CHECK(share_at_next(progress, exercise) == doctest::Approx(0.5).scale(0.0).epsilon(0.01));
}

TEST_CASE("A hidden tube under a lifted flap is looked at from another side") {
    const Exercise exercise = search();
    Observation seen = lifted(exercise);
    seen.target[1].clear_rays = kEnoughRays - 1;
    look_at(seen, 1, 0.06);
    CHECK(words(exercise, seen) == "Tube 2 is hidden: look from another side");
}

TEST_CASE("With every tube behind the endoscope the words are about the first") {
    const Exercise exercise = search();
    Observation seen = lifted(exercise);
    seen.view.forward = {0.0, 0.0, 1.0};
    CHECK(find_hint(exercise, seen, 0).tube == 0);
    CHECK(find_hint(exercise, seen, 1U).tube == 1);
}
