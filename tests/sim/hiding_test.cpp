// tests/sim/hiding_test.cpp
// The tubes cannot be found without lifting the flap, nor by looking through an organ: asked of
// every endoscope that the port allows, with the rays and the rule that the exercise has.
#include "tasks/exercise/find_tubes.h"
#include "tests/sim/flap_fixture.h"

#include <glm/geometric.hpp>
#include <numbers>
#include <random>

using namespace flap_tests;
using glm::dvec3;

namespace {

constexpr double kAnyTurn = 2.0 * std::numbers::pi;

/// What an endoscope in the scene's port sees of a session's tissue as it is now.
struct Bench {
    sim::Session& session;
    std::mt19937_64 random{1};

    explicit Bench(sim::Session& at) : session(at) {}

    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    dvec3 between(const dvec3& low, const dvec3& high) {
        return {between(low.x, high.x), between(low.y, high.y), between(low.z, high.z)};
    }
    const haptics::Endoscope& optics() const { return session.scene.scene.scope->optics; }

    bool reaches(const dvec3& eye_m) const {
        const haptics::Trocar& trocar = optics().trocar;
        const double inside_m = glm::distance(eye_m, trocar.fulcrum_m);
        return inside_m >= trocar.min_insertion_m &&
               inside_m <= trocar.shaft_m - trocar.min_outside_m;
    }
    tasks::View view(const dvec3& eye_m, double optic_turn_rad) const {
        const haptics::EndoscopePicture picture = haptics::picture_of(
            optics(),
            haptics::shaft_pose(optics().trocar, haptics::handle_for_tip(optics().trocar, eye_m)),
            0.0, optic_turn_rad);
        tasks::View out = session.scene.scene.view;
        out.eye_m = picture.eye_m;
        out.forward = picture.forward;
        out.up = picture.up;
        return out;
    }
    tasks::Observation seen(const dvec3& eye_m) {
        sim::ScopeNow scope;
        scope.view = view(eye_m, 0.0);
        scope.port_m = optics().trocar.fulcrum_m;
        sim::ClearRays clear;
        sim::see_targets(session.tissue, scope, clear);
        tasks::Observation out;
        out.view = scope.view;
        out.targets = static_cast<int>(session.tissue.targets.size());
        for (std::size_t k = 0; k < session.tissue.targets.size(); ++k) {
            const sim::EmbeddedTarget& target = session.tissue.targets[k];
            out.target[k].position_m = sim::place_on(
                session.tissue.bodies[static_cast<std::size_t>(target.body)], target.at);
            out.target[k].clear_rays = clear[k];
        }
        return out;
    }
};

/// Of many eyes: how many had a tube clear, and how many as the exercise wants it, with some turn
/// of the optic.
struct Swept {
    int eyes = 0;
    std::array<int, 3> clear{}, shown{};
    std::array<dvec3, 3> from_m{}; // the last one that showed it
};

void look_from(Bench& bench, const dvec3& eye_m, Swept& swept) {
    if (!bench.reaches(eye_m))
        return;
    ++swept.eyes;
    tasks::Observation seen = bench.seen(eye_m); // the optic's turn does not move the eye
    for (std::size_t k = 0; k < kTube.size(); ++k) {
        if (seen.target[k].clear_rays < tasks::kEnoughRays)
            continue;
        ++swept.clear[k];
        bool shown = false;
        for (int turn = 0; turn < 60 && !shown; ++turn) {
            seen.view = bench.view(eye_m, kAnyTurn * turn / 60.0);
            shown = tasks::tube_seen(bench.session.exercise, seen, k);
        }
        swept.shown[k] += shown;
        if (shown)
            swept.from_m[k] = eye_m;
    }
}

/// Over the field, and close around and under the flap's rim, where an eye might slip past it.
Swept sweep(Bench& bench, int over_field, int at_rim) {
    Swept swept;
    for (int i = 0; i < over_field; ++i)
        look_from(bench, bench.between({-0.13, -0.11, -0.02}, {0.13, 0.11, 0.15}), swept);
    for (int i = 0; i < at_rim; ++i) {
        const double along = bench.between(-1.0, 1.0), out_m = bench.between(-0.012, 0.012);
        const dvec3 front{0.06 * along, -0.037 + out_m, bench.between(-0.015, 0.012)};
        const double side = i % 4 == 0 ? -1.0 : 1.0;
        const dvec3 aside{side * (0.05 + out_m), 0.04 * along, front.z};
        look_from(bench, i % 2 == 0 ? aside : front, swept);
    }
    return swept;
}

void hides_all(const Swept& swept) {
    for (std::size_t k = 0; k < kTube.size(); ++k) {
        INFO(std::string(kTube[k]) << " clear from " << swept.clear[k] << " of " << swept.eyes
                                   << " eyes, last as wanted from " << mm(swept.from_m[k]));
        CHECK(swept.shown[k] == 0);
    }
}

/// The exercise after a tool has pressed at a place and still does, as hard as the limit allows.
struct Pressed {
    std::unique_ptr<sim::Session> session;
    Led led;
};
Pressed press_at(const dvec3& place_m) {
    const ScriptFile file(look_from_afar() + move("left", place_m, 1.0) +
                          "[[step]]\nverb = \"press\"\ntool = \"left\"\nforce_n = 1.2\n"
                          "seconds = 3\n" +
                          wait(0.5));
    Pressed out;
    out.session = sim::make_session(file.options(5.0));
    out.led = led_by(*out.session);
    CHECK(out.led.valid);
    CHECK(out.led.found == 0);
    return out;
}

} // namespace

TEST_CASE("hiding: with the flap at rest no endoscope shows a tube as the exercise wants it") {
    const auto session = flap_session();
    Bench bench(*session);
    const Swept swept = sweep(bench, 20000, 40000);
    CHECK(swept.eyes > 50000);
    hides_all(swept);
}

TEST_CASE("hiding: with the flap away they show all three: the search would have found them") {
    const auto session = flap_session();
    for (dvec3& place_m : session->tissue.bodies[0].skin_m)
        place_m.z += 1.0;
    session->tissue.sight = sim::make_sight(session->tissue.bodies);
    Bench bench(*session);
    const Swept swept = sweep(bench, 4000, 0);
    for (const int shown : swept.shown)
        CHECK(shown > 20);
}

TEST_CASE("hiding: an endoscope pushed through the flap sees no tube at all") {
    const auto session = flap_session();
    Bench bench(*session);
    for (int i = 0; i < 5000; ++i) { // from in the flap down to the tubes, off its rim
        const dvec3 eye_m = bench.between({-0.04, -0.025, -0.02}, {0.04, 0.03, 0.006});
        const tasks::Observation seen = bench.seen(eye_m);
        for (std::size_t k = 0; k < kTube.size(); ++k)
            CHECK(seen.target[k].clear_rays == 0);
    }
}

TEST_CASE("hiding: pointing at the right place under the flap finds nothing and is not seen") {
    // in under the free edge; the flap and the ground are in the way, and are mistakes of their own
    const Led led = led_to(look_at(kVein) + move("right", {-0.02, -0.06, 0.02}, 1.5) +
                               move("right", {-0.02, -0.05, -0.002}, 1.0) +
                               move("right", above(kVein, 3.8e-3), 1.0) + wait(2.5),
                           7.0);
    CHECK(led.valid);
    CHECK(led.found == 0);
    CHECK(led.events.find("tube_not_seen") != std::string::npos);
    CHECK(led.events.find("tube_not_seen") == led.events.rfind("tube_not_seen"));
}

TEST_CASE("hiding: the flap pressed down, as hard as the exercise allows, shows no tube") {
    for (const dvec3& place_m :
         {dvec3{0.0, -0.034, 0.02}, dvec3{-0.02, -0.034, 0.02}, dvec3{0.0, -0.01, 0.02}}) {
        CAPTURE(mm(place_m));
        const Pressed pressed = press_at(place_m);
        const sim::Body& flap = pressed.session->tissue.bodies[0];
        double moved_m = 0.0;
        for (std::size_t v = 0; v < flap.skin_m.size(); ++v)
            moved_m =
                std::max(moved_m, glm::distance(flap.skin_m[v], flap.organ->surface.rest_m[v]));
        CHECK(moved_m > 5e-3); // it was pressed
        Bench bench(*pressed.session);
        hides_all(sweep(bench, 4000, 8000));
    }
}

TEST_CASE("hiding: swept aside at its side edge the flap bares a tube, never all, and that is off "
          "target") {
    int bared = 0;
    for (const dvec3& place_m : {dvec3{-0.046, 0.0, 0.02}, dvec3{-0.035, 0.0, 0.02}}) {
        CAPTURE(mm(place_m));
        const Pressed pressed = press_at(place_m);
        CHECK(pressed.led.events == "off_target");
        Bench bench(*pressed.session);
        const Swept swept = sweep(bench, 8000, 0);
        bared += swept.shown[kDuct] + swept.shown[kVein] > 0;
        CHECK(swept.shown[kArtery] == 0);
    }
    CHECK(bared > 0); // else the case above may ask for these places too
}
