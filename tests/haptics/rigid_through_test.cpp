// Tools pushed so deep into thin and concave things that the nearest way out is not the way in.
#include "haptics/rigid/step_rigid.h"

#include "tests/haptics/rigid_scenes.h"

#include <doctest/doctest.h>

namespace {

using glm::dvec3;
using haptics::RigidParams;
using haptics::RigidPose;

// Contact so soft that the tool follows the device in.
constexpr RigidParams kSoft{.contact_npm = 4.0};

struct Turns {
    double most_deg = 0.0;    // between ticks
    double from_up_deg = 0.0; // from the way it came
    double deepest_m = 0.0;
    double most_step_n = 0.0;
};

// Along a path of poses at most 0.1 mm apart (100 mm/s).
Turns push(RigidRig& rig, const std::vector<dvec3>& path_m, const glm::dmat3& turned,
           const dvec3& up = {0, 0, 1}) {
    Turns turns;
    dvec3 last{0.0};
    dvec3 device_m = path_m[0];
    for (std::size_t i = 1; i < path_m.size(); ++i) {
        const dvec3 way_m = path_m[i] - path_m[i - 1];
        const int ticks = static_cast<int>(std::ceil(glm::length(way_m) / 1e-4));
        for (int t = 1; t <= ticks; ++t) {
            device_m = path_m[i - 1] + way_m * (double(t) / ticks);
            const dvec3 force_n = rig.step({turned, device_m}).force_n;
            turns.deepest_m = std::max(turns.deepest_m, rig.tick.deepest_m);
            const bool felt = glm::length(force_n) > 1e-5, before = glm::length(last) > 1e-5;
            if (felt && before)
                turns.most_deg = std::max(turns.most_deg, degrees_between(force_n, last));
            if (felt)
                turns.from_up_deg = std::max(turns.from_up_deg, degrees_between(force_n, up));
            turns.most_step_n = std::max(turns.most_step_n, glm::length(force_n - last));
            last = force_n;
            CHECK(rig.tick.solved);
            CHECK(rig.tick.dropped == 0);
        }
    }
    return turns;
}

} // namespace

// A tool of thickness t in a slab of thickness s comes out below as soon as it is (t + s) / 2 deep.
TEST_CASE("rigid through: a slab 10 : 1 pushed 60 % through another, and nothing flips") {
    const auto slab = body("slab", {box({0.01, 0.01, 1e-3}, {0, 0, -1e-3})}); // 20 x 20 x 2 mm
    for (const double angle : {0.0, 0.02, 0.1, 0.3}) {
        RigidRig rig({slab}, {body("tool", {box({5e-3, 5e-3, 0.5e-3})})}, kSoft);
        const double in_m = -1.4e-3; // 1.9 mm of 3
        const Turns t = push(
            rig,
            {{0, 0, 0.006}, {0, 0, in_m}, {3e-3, 2e-3, in_m}, {-3e-3, 0, in_m}, {-3e-3, 0, 0.006}},
            turn({1, 2, 0}, angle));
        CAPTURE(angle);
        CHECK(t.deepest_m > 0.6 * 3e-3);
        CHECK(t.most_deg <= 30.0);
        CHECK(t.from_up_deg < 45.0);
    }
}

TEST_CASE("rigid through: an L, as tool and as scenery, pushed 60 % through") {
    for (const double angle : {0.0, 0.1}) {
        CAPTURE(angle);
        // its lying leg, 10 mm thick, on a slab of 2 mm
        RigidRig tool({body("slab", {box({0.05, 0.05, 1e-3}, {0, 0, -1e-3})})}, {body(l_surface())},
                      kSoft);
        const Turns on_slab = push(
            tool, {{-0.01, 0, 0.01}, {-0.01, 0, -7.3e-3}, {0.01, 0.01, -7.3e-3}, {0.01, 0, 0.01}},
            turn({1, 0, 0}, angle));
        CHECK(on_slab.deepest_m > 0.6 * 12e-3);
        CHECK(on_slab.most_deg <= 30.0);
        CHECK(on_slab.from_up_deg < 60.0);
        // a small plate through the lying leg of an L
        RigidRig scenery({body(l_surface())}, {body("plate", {box({2e-3, 2e-3, 0.5e-3})})}, kSoft);
        const Turns through_leg = push(scenery,
                                       {{0.025, 0, 0.02},
                                        {0.025, 0, 3.6e-3},
                                        {0.03, 5e-3, 3.6e-3},
                                        {0.02, 5e-3, 3.6e-3},
                                        {0.02, 5e-3, 0.02}},
                                       turn({0, 1, 0}, angle));
        CHECK(through_leg.deepest_m > 0.6 * 11e-3);
        CHECK(through_leg.most_deg <= 30.0);
        CHECK(through_leg.from_up_deg < 60.0);
    }
}

TEST_CASE("rigid through: in a U too narrow for it a tool is centred and does not flip") {
    RigidRig rig({body(u_surface())}, {body("tool", {box({0.0102, 0.01, 5e-3})})}, kSoft);
    const Turns t = push(
        rig, {{0, 0, 0.03}, {0, 0, 4e-3}, {0.3e-3, 5e-3, 4e-3}, {-0.3e-3, 0, 4e-3}, {0, 0, 4e-3}},
        glm::dmat3(1.0));
    CHECK(t.most_deg <= 30.0);
    MESSAGE("in the U: turns by " << t.most_deg << " degrees, steps by " << t.most_step_n << " N");
    for (int i = 0; i < 200; ++i)
        rig.step({glm::dmat3(1.0), {0, 0, 4e-3}});
    const dvec3 force_n = rig.tick.wrench[0].force_n;
    CHECK(force_n.z > 0.0);
    CHECK(std::abs(force_n.x) < 0.05 * force_n.z);
}

// Stiff contact, as felt: 30 mm of wandering in and about, pressed by up to 25 N. Where the forces
// of several contacts all but cancel, their sum has no direction worth the name: 0.05 N is felt.
TEST_CASE("rigid through: wandering about L, U and torus at 100 mm/s never turns by 30 degrees") {
    RandomPieces random(90);
    for (const haptics::RigidSurface& surface :
         {l_surface(), u_surface(), torus_surface(0.02, 0.006, 16, 10)}) {
        double most_deg = 0.0, most_step_n = 0.0;
        int felt = 0;
        for (int run = 0; run < 4; ++run) {
            RigidRig rig({body(surface)}, {body("tool", {box({4e-3, 3e-3, 5e-3})})});
            dvec3 at_m{0.03, 0.0, 0.05}, way{0.0}, last{0.0};
            const glm::dmat3 attitude = random.rotation();
            for (int tick = 0; tick < 3000; ++tick) {
                if (tick % 100 == 0)
                    way = glm::normalize(0.03 * random.in_ball() - at_m);
                at_m += 1e-4 * way;
                const dvec3 force_n = rig.step({attitude, at_m}).force_n;
                most_step_n = std::max(most_step_n, glm::length(force_n - last));
                if (std::min(glm::length(force_n), glm::length(last)) > 0.05) {
                    ++felt;
                    most_deg = std::max(most_deg, degrees_between(force_n, last));
                }
                last = force_n;
            }
        }
        MESSAGE(surface.name << ": in " << felt << " ticks of contact at most " << most_deg
                             << " degrees and " << most_step_n << " N from tick to tick");
        CHECK(felt > 3000);
        CHECK(most_deg <= 30.0);
        CHECK(most_step_n <= 800.0 * 1.1e-3); // spring, times the steps of tool and device
    }
}
