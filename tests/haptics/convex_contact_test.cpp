#include "haptics/rigid/convex_contact.h"

#include "haptics/rigid/contact_clusters.h"
#include "haptics/rigid/penetration.h"
#include "tests/haptics/convex_pieces.h"

#include <doctest/doctest.h>

namespace {

using glm::dvec3;
using haptics::ConvexHull;
using haptics::PairContact;
using haptics::PairMemory;
using haptics::PatchList;
using haptics::RigidPose;

constexpr double kMargin_m = 1e-3;

struct Felt {
    PairContact pair;
    haptics::ContactList contacts;
    double area_m2 = 0.0, volume_m3 = 0.0;
};

Felt feel(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a, PairMemory& memory) {
    Felt felt;
    felt.pair = haptics::convex_contact(a, b, b_in_a, kMargin_m, memory);
    PatchList patches;
    if (felt.pair.depth_m > 0.0)
        haptics::overlap_patches(a, b, {}, b_in_a, felt.pair, patches);
    haptics::cluster_contacts({patches.begin(), patches.end()}, {}, felt.contacts);
    for (const haptics::ContactPatch& p : patches) {
        felt.area_m2 += p.area_m2;
        felt.volume_m3 += p.area_m2 * p.depth_m;
    }
    return felt;
}

Felt feel(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a) {
    PairMemory fresh;
    return feel(a, b, b_in_a, fresh);
}

double angle_deg(const dvec3& u, const dvec3& v) {
    return 57.29577951308232 * std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

} // namespace

TEST_CASE("convex contact: the overlap of a box on a block is that of the two rectangles") {
    const ConvexHull block = box({0.05, 0.05, 0.05}), tool = box({0.01, 0.02, 0.01});
    const double depth_m = 0.4e-3;
    struct Case {
        double x_m, area_m2, place_m;
    };
    for (const auto& [x_m, area_m2, place_m] :
         {Case{0.0, 8e-4, 0.0}, Case{0.045, 6e-4, 0.0425}, Case{-0.055, 2e-4, -0.0475}}) {
        for (const double turned : {0.0, 1.5707963267948966}) { // the block's, no matter
            const Felt felt = feel(box({0.05, 0.05, 0.05}), tool,
                                   {turn({0, 0, 1}, 2.0 * turned), {x_m, 0, 0.06 - depth_m}});
            CHECK(felt.area_m2 == doctest::Approx(area_m2).scale(0.0).epsilon(1e-9));
            CHECK(felt.volume_m3 == doctest::Approx(area_m2 * depth_m).scale(0.0).epsilon(1e-9));
            REQUIRE(felt.contacts.count == 1);
            CHECK(felt.contacts.item[0].depth_m ==
                  doctest::Approx(depth_m).scale(0.0).epsilon(1e-9));
            CHECK(std::abs(felt.contacts.item[0].place_m.x - place_m) < 1e-16); // of 0.05: rounding
            CHECK(felt.contacts.item[0].normal.z == doctest::Approx(1.0).scale(0.0));
        }
    }
}

// Corner of a cube standing on its diagonal: a three-sided pyramid of height d has the base
// 3 sqrt(3)/2 d^2 (edges 120 degrees apart, tan^2 = 2) and the mean depth, weighted by depth, d/2.
TEST_CASE("convex contact: a corner displaces a pyramid, an edge a wedge") {
    const ConvexHull block = box({0.05, 0.05, 0.05}), cube = box(dvec3{0.01});
    const glm::dmat3 on_edge = turn({1, 0, 0}, 0.7853981633974483);
    const glm::dmat3 on_corner =
        turn({1, 0, 0}, std::atan(std::sqrt(0.5))) * turn({0, 1, 0}, 0.7853981633974483);
    for (const double d : {1e-5, 1e-4, 1e-3}) {
        const Felt corner =
            feel(block, cube, {on_corner, {0, 0, 0.05 + std::sqrt(3.0) * 0.01 - d}});
        REQUIRE(corner.contacts.count == 1);
        CHECK(corner.area_m2 ==
              doctest::Approx(1.5 * std::sqrt(3.0) * d * d).scale(0.0).epsilon(1e-6));
        CHECK(corner.contacts.item[0].depth_m == doctest::Approx(d / 2).scale(0.0).epsilon(1e-6));
        const Felt edge = feel(block, cube, {on_edge, {0, 0, 0.05 + std::sqrt(2.0) * 0.01 - d}});
        CHECK(edge.area_m2 == doctest::Approx(2 * d * 0.02).scale(0.0).epsilon(1e-6));
        CHECK(edge.contacts.item[0].depth_m == doctest::Approx(d * 2 / 3).scale(0.0).epsilon(1e-6));
    }
}

TEST_CASE("convex contact: swapping the pieces swaps the sign and nothing else") {
    RandomPieces random(30);
    for (int i = 0; i < 200; ++i) {
        const ConvexHull a = box(1e-2 * (random.in_ball() + 1.1));
        const ConvexHull b = box(1e-2 * (random.in_ball() + 1.1));
        const RigidPose pose{random.rotation(), 0.02 * random.in_ball()};
        const RigidPose back = haptics::relative_pose(pose, {});
        const Felt there = feel(a, b, pose), here = feel(b, a, back);
        REQUIRE((there.pair.depth_m > 0.0) == (here.pair.depth_m > 0.0));
        if (there.pair.depth_m <= 0.0)
            continue;
        CHECK(there.pair.depth_m == doctest::Approx(here.pair.depth_m).scale(0.0).epsilon(1e-7));
        CHECK(there.area_m2 > 0.0);
        if (glm::length(pose.rotation * here.pair.normal + there.pair.normal) < 1e-6)
            CHECK(there.volume_m3 == doctest::Approx(here.volume_m3).scale(0.0).epsilon(1e-5));
    }
}

TEST_CASE("convex contact: whatever overlaps has an area, and is nowhere deeper than the pair") {
    RandomPieces random(31);
    int overlaps = 0;
    while (overlaps < 1000) {
        auto p = random.points(), q = random.points();
        if (p.size() < 6 || q.size() < 6)
            continue;
        const RigidPose pose{overlaps % 5 ? random.rotation() : glm::dmat3(1.0),
                             0.012 * random.in_ball()};
        const Felt felt = feel(haptics::convex_hull(p, "a"), haptics::convex_hull(q, "b"), pose);
        if (felt.pair.depth_m <= 0.0)
            continue;
        ++overlaps;
        CHECK(felt.contacts.count > 0);
        for (const haptics::RepresentativeContact& c : felt.contacts)
            CHECK(c.depth_m <= felt.pair.depth_m * (1.0 + 1e-9));
    }
}

// However deep it already is, and though the way on is shorter than the way back.
TEST_CASE("convex contact: a rod pushed through a plate is pushed back the way it came") {
    const ConvexHull plate = box({0.05, 0.05, 1e-3}), rod = box({1e-3, 1e-3, 1e-2});
    PairMemory memory;
    double last_m = 0.0;
    for (int tick = 0; tick < 30; ++tick) { // 0.1 mm per tick, 100 mm/s
        const double down_m = 1e-4 * tick - 0.5e-3;
        const Felt felt = feel(plate, rod, {turn({1, 2, 0}, 0.02), {0, 0, 0.011 - down_m}}, memory);
        if (felt.pair.depth_m > 0.0) {
            CHECK(felt.pair.normal.z > 0.99);
            CHECK(felt.contacts.count > 0);
            CHECK(felt.pair.depth_m >= last_m);
            last_m = felt.pair.depth_m;
        }
    }
    CHECK(last_m > 2e-3); // all the way through
}

TEST_CASE("convex contact: over the edge of a block the direction turns by degrees") {
    const ConvexHull block = box({0.05, 0.05, 0.05}), cube = box(dvec3{0.01});
    for (const double speed_mps : {0.005, 0.05, 0.1}) {
        PairMemory memory;
        dvec3 last_normal{0, 0, 1};
        dvec3 last_n{0.0};
        double most_deg = 0.0, most_step = 0.0;
        const double depth_m = 0.5e-3;
        for (double x_m = 0.058; x_m < 0.0605; x_m += 1e-3 * speed_mps) {
            const Felt felt =
                feel(block, cube, {glm::dmat3(1.0), {x_m, 0, 0.06 - depth_m}}, memory);
            dvec3 force{0.0}; // of a stiffness of 1
            for (const auto& c : felt.contacts)
                force += c.share * c.depth_m * c.normal;
            if (felt.pair.depth_m > 0.0) {
                most_deg = std::max(most_deg, angle_deg(felt.pair.normal, last_normal));
                last_normal = felt.pair.normal;
            }
            most_step = std::max(most_step, x_m > 0.0581 ? glm::length(force - last_n) : 0.0);
            last_n = force;
        }
        CHECK(most_deg <= 5.01);
        CHECK(glm::length(last_n) == 0.0);
        MESSAGE("at " << speed_mps << " m/s the force steps by " << 100 * most_step / depth_m
                      << " % of its size per tick");
        // the turn, the way itself, and half a turn for the columns
        CHECK(most_step / depth_m < 1.5 * haptics::kMostTurn_rad + 1e-3 * speed_mps / depth_m);
    }
}
