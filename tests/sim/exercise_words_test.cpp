// tests/sim/exercise_words_test.cpp
// Menu and card name what an exercise uses, and no more.
#include "sim/command/exercise_words.h"

#include <doctest/doctest.h>

using tasks::ExerciseKind;
using view::Role;

TEST_CASE("exercise words: the roles are those of its targets, of what it lifts, of who looks") {
    tasks::Exercise exercise;
    exercise.kind = ExerciseKind::follow_path;
    exercise.target = {{"1", tasks::Role::right}, {"2", tasks::Role::right}};
    CHECK(sim::menu_entry(exercise).hands == "right");
    CHECK(sim::card_model(exercise).roles == std::vector<Role>{Role::right});
    exercise.kind = ExerciseKind::find_tubes;
    exercise.scope = tasks::ScopeHold::assistant;
    exercise.lift = tasks::Lift{};
    CHECK(sim::menu_entry(exercise).hands == "left, right, endoscope");
    CHECK(sim::menu_entry(exercise).summary == "2 tubes");
    CHECK(sim::card_model(exercise).roles ==
          std::vector<Role>{Role::left, Role::right, Role::scope});
}

TEST_CASE("exercise words: find-tubes has a limit of force and no band") {
    tasks::Exercise exercise;
    exercise.kind = ExerciseKind::find_tubes;
    exercise.radius_m = 5e-3;
    exercise.hold_s = 1.0;
    exercise.force_limit_n = 1.25;
    const std::vector<std::string> limits = sim::card_model(exercise).limits;
    CHECK(limits.at(0) == "Force: error above 1.25 N");
    CHECK(limits.at(1) == "Hold 1.0 s within 5 mm, tube in the ring and large");
    exercise.kind = ExerciseKind::touch_points;
    exercise.force_limit_n = 2.0;
    CHECK(sim::card_model(exercise).limits.at(0) == "Force 0.1 to 1.0 N, error above 2.0 N");
}
