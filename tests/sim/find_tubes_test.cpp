// tests/sim/find_tubes_test.cpp
// Finding tubes under the flap by a script, and every mistake at it: exactly the expected events.
#include "tests/sim/flap_fixture.h"

#include <glm/geometric.hpp>

using namespace flap_tests;

namespace {

std::string events_of(const std::string& script, double max_seconds) {
    const Led led = led_to(script, max_seconds);
    CHECK(led.valid);
    return led.events;
}

std::string find(int tube) {
    return move("right", above(tube, 30e-3), 1.2) + look_at(tube) + point("right", tube) +
           wait(1.3) + leave("right", tube) + look_from_afar();
}

} // namespace

TEST_CASE("find-tubes: the flap lifted, each tube shown and pointed at, in any order: no error") {
    CHECK(events_of(lift_flap() + find(kVein) + find(kArtery) + find(kDuct), 30.0) ==
          "tube_found tube_found tube_found completed");
}

TEST_CASE("find-tubes: pointed at while the endoscope looks elsewhere is not seen, nothing else") {
    CHECK(events_of(lift_flap() + look({0.05, 0.02, 0.0}, 0.15) + point("right", kVein) + wait(3.0),
                    11.0) == "tube_not_seen");
}

TEST_CASE("find-tubes: in the picture for ten seconds, and nobody points, nothing else") {
    CHECK(events_of(lift_flap() + look_at(kArtery) + wait(12.0), 18.0) == "tube_not_pointed");
}

TEST_CASE("find-tubes: another tool at a tube has the wrong role, nothing else") {
    CHECK(events_of(lift_flap() + move("assist", above(kArtery, 30e-3), 1.2) + look_at(kArtery) +
                        point("assist", kArtery) + wait(1.0),
                    12.0) == "wrong_role");
}

TEST_CASE("find-tubes: pulled harder than a tube bears is too much force, nothing else") {
    CHECK(events_of(lift_flap() + move("left", {0.0, 0.055, 0.10}, 1.5), 7.8) == "over_force");
}

TEST_CASE("find-tubes: a contact beside the tubes is off target, nothing else") {
    CHECK(events_of(look_from_afar() + move("right", {0.075, -0.02, 0.01}, 1.5) +
                        "[[step]]\nverb = \"press\"\ntool = \"right\"\nforce_n = 0.4\n"
                        "seconds = 2.5\n" +
                        wait(1.0),
                    7.0) == "off_target");
}

TEST_CASE("find-tubes: a tool that moves out of the picture is that, nothing else") {
    CHECK(events_of(look_from_afar() + move("right", {0.01, -0.035, 0.05}, 1.0) +
                        look({0.0, 0.06, 0.0}, 0.1) + move("right", {0.05, -0.035, 0.07}, 1.0) +
                        wait(0.5),
                    6.0) == "out_of_view");
}

TEST_CASE("find-tubes: organs that meet change no event of it") {
    const ScriptFile file(lift_flap() + find(kVein) + find(kArtery) + find(kDuct));
    const auto session = sim::make_session(file.options(30.0));
    sim::TissueRig& tissue = session->tissue;
    tissue.organs = sim::make_organ_contact(tissue.bodies);
    const Led led = led_by(*session);
    CHECK(led.valid);
    CHECK(led.events == "tube_found tube_found tube_found completed");
    CHECK(tissue.organs->solves > 0); // the flap pressed on what is below it
    CHECK(tissue.organs->rows.left_out == 0);
}

TEST_CASE("find-tubes: a quadratic flap is lifted in steps of 20 ms, and every one is solved") {
    sim::RunOptions o;
    o.exercise = "find-tubes";
    o.model = "corotated,flap=quadratic";
    o.fem_hz = 50;
    const auto session = sim::make_session(o);
    const auto outcome = sim::run_lockstep(*session, nullptr, 0);
    CHECK(outcome.row.completed);
    CHECK(outcome.row.valid);
    CHECK(session->worst_linear_residual <= sim::kMostLinearResidual);
    CHECK(session->inverted_steps == 0);
}
