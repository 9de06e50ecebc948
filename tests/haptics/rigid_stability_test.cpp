// A bare device in six degrees of freedom, held by nobody, on rigid contact: it must come to rest.
#include "haptics/rigid/step_rigid.h"

#include "tests/haptics/rigid_scenes.h"

#include <doctest/doctest.h>
#include <glm/gtc/quaternion.hpp>

namespace {

using glm::dvec3;
using haptics::RigidPose;
using haptics::Wrench;

constexpr double kTick_s = 1e-3;

// Half of what damping allows: half of it is left, so motion falls as exp(-t b / 4 m), by 2e-6 in
// the ten seconds of a run, its energy by the square of that.
constexpr double kShare = 0.5;

// A ball on a gimbal: m v' + b v = F, I w' + b_r w = T, exact while F and T are held.
struct BareDevice {
    RigidPose pose;
    dvec3 v_mps{0.0}, w_radps{0.0};
    double mass_kg = 0.1, inertia_kgm2 = 2e-5;

    static dvec3 advance(dvec3& rate, const dvec3& load, double mass, double damping) {
        const double decay = std::exp(-damping / mass * kTick_s);
        const dvec3 drift = load / damping;
        const dvec3 way = drift * kTick_s + (rate - drift) * (1.0 - decay) * (mass / damping);
        rate = drift + (rate - drift) * decay;
        return way;
    }
    void step(const Wrench& load) {
        pose.position_m += advance(v_mps, load.force_n, mass_kg, kTestDevice.force_nspm);
        const dvec3 turn =
            advance(w_radps, load.torque_nm, inertia_kgm2, kTestDevice.torque_nmsprad);
        const double angle = glm::length(turn);
        if (angle > 0.0)
            pose.rotation = glm::mat3_cast(glm::normalize(glm::angleAxis(angle, turn / angle) *
                                                          glm::quat_cast(pose.rotation)));
    }
    double energy_j() const {
        return 0.5 * mass_kg * glm::dot(v_mps, v_mps) +
               0.5 * inertia_kgm2 * glm::dot(w_radps, w_radps);
    }
};

// Kinetic energy over the last half second of ten, after a drop.
double unrest_j(RigidRig& rig, const RigidPose& start, const dvec3& push_n) {
    BareDevice device;
    device.pose = start;
    double most_j = 0.0;
    for (int tick = 0; tick < 10000; ++tick) {
        Wrench load = rig.step(device.pose);
        load.force_n += push_n;
        device.step(load);
        if (tick >= 9500)
            most_j = std::max(most_j, device.energy_j());
    }
    return most_j;
}

} // namespace

TEST_CASE("rigid stability: a bare device dropped askew on a plane lies down and rests") {
    RandomPieces random(95);
    for (const double contact_npm : {1000.0, 5000.0, 100000.0}) {
        for (int i = 0; i < 3; ++i) {
            RigidRig rig({body("table", {box({0.1, 0.1, 0.05}, {0, 0, -0.05})})},
                         {body("tool", {box({0.01, 0.015, 0.01})})},
                         {.contact_npm = contact_npm, .passivity_share = kShare});
            const double unrest =
                unrest_j(rig, {turn(random.in_ball(), 0.4), {0, 0, 0.025}}, {0, 0, -1.0});
            CAPTURE(contact_npm);
            CHECK(unrest < 1e-8);
            CHECK(rig.tick.wrench[0].force_n.z == doctest::Approx(1.0).scale(0.0).epsilon(1e-3));
            // flat: face down
            double most = 0.0;
            for (int axis = 0; axis < 3; ++axis)
                most = std::max(most, std::abs(rig.state.tool[0].rotation[axis].z));
            CHECK(most > 0.999);
        }
    }
}

TEST_CASE("rigid stability: pressed into the corner of an L or a U it rests as well") {
    for (const haptics::RigidSurface& surface : {l_surface(), u_surface()}) {
        RigidRig rig({body(surface)}, {body("tool", {box({3e-3, 4e-3, 3e-3})})},
                     {.passivity_share = kShare});
        const bool l = surface.name == "L";
        const double unrest = unrest_j(rig, {turn({1, 2, 3}, 0.2), {l ? 0.02 : 0.0, 0, 0.02}},
                                       {l ? -0.7 : 0.7, 0, -0.7});
        CAPTURE(surface.name);
        CHECK(unrest < 1e-8);
        CHECK(glm::length(rig.tick.wrench[0].force_n - dvec3{l ? 0.7 : -0.7, 0, 0.7}) < 5e-3);
    }
}

TEST_CASE("rigid stability: a spring beyond the bound and no cap rings, with the cap it rests") {
    for (const bool capped : {false, true}) {
        RigidRig rig({body("table", {box({0.1, 0.1, 0.05}, {0, 0, -0.05})})},
                     {body("tool", {box({0.01, 0.015, 0.01})})},
                     {.passivity_share = capped ? kShare : 1e9});
        rig.model.spring[0] = {2500.0, 0.16}; // 2 b / T is 1000
        const double unrest = unrest_j(rig, {glm::dmat3(1.0), {0, 0, 0.0105}}, {0, 0, -1.0});
        CHECK((unrest < 1e-8) == capped);
    }
}

namespace {

// Work put in along a closed path at 10 mm/s, with the mean of the forces before and after each
// step: what holding a force for a tick gives back is not counted.
struct Lap {
    double taken_j = 0.0, most_j = 0.0;
};

Lap lap(RigidRig& rig, const std::vector<dvec3>& path_m, const glm::dmat3& turned) {
    Lap sum;
    dvec3 at_m = path_m.back(), force_n = rig.step({turned, at_m}).force_n;
    for (std::size_t i = 0; i < path_m.size(); ++i) {
        const dvec3 from_m = at_m, way_m = path_m[i] - from_m;
        const int ticks = static_cast<int>(std::ceil(glm::length(way_m) / 1e-5));
        for (int t = 1; t <= ticks; ++t) {
            const dvec3 next_m = from_m + way_m * (double(t) / ticks);
            const dvec3 next_n = rig.step({turned, next_m}).force_n;
            sum.taken_j -= 0.5 * glm::dot(force_n + next_n, next_m - at_m);
            sum.most_j = std::max(sum.most_j, sum.taken_j);
            at_m = next_m;
            force_n = next_n;
        }
    }
    return sum;
}

} // namespace

TEST_CASE(
    "rigid stability: a lap gives back what was put in on a face, on edges 12 % more at most") {
    const std::vector<dvec3> on_face{
        {0, 0, 0.012}, {0, 0, 0.008}, {0.02, 0, 0.008}, {0.02, 0, 0.012}};
    const std::vector<dvec3> off_edge{
        {0.08, 0, 0.012}, {0.08, 0, 0.008}, {0.115, 0, 0.008}, {0.115, 0, 0.014}, {0.08, 0, 0.014}};
    for (const bool edge : {false, true}) {
        for (const double angle : {0.0, 0.05, 0.1, 0.2, 0.4}) {
            RigidRig rig({body("table", {box({0.1, 0.1, 0.05}, {0, 0, -0.05})})},
                         {body("tool", {box({0.01, 0.015, 0.01})})});
            const Lap sum = lap(rig, edge ? off_edge : on_face, turn({1, 2, 3}, angle));
            CAPTURE(edge);
            CAPTURE(angle);
            CHECK(sum.most_j > 1e-3);
            CHECK(sum.taken_j > (edge ? -0.12 : -0.001) * sum.most_j);
            if (!edge)
                CHECK(sum.taken_j < 0.02 * sum.most_j);
        }
    }
}
