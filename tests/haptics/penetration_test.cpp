#include "haptics/rigid/penetration.h"

#include "tests/haptics/convex_pieces.h"

#include <doctest/doctest.h>
#include <stdexcept>

namespace {

using glm::dvec3;
using haptics::ConvexHull;
using haptics::Penetration;
using haptics::RigidPose;

struct Pair {
    ConvexHull a, b;
    RigidPose b_in_a;
};

// Pieces that overlap: some just, some with their centres nearly together.
Pair overlapping(RandomPieces& random, double scale = 1.0, const dvec3& at_m = {}) {
    for (;;) {
        auto p = random.points(), q = random.points();
        RigidPose pose{random.rotation(), 12e-3 * random.in_ball() * random.number(0.0, 1.0)};
        for (auto* points : {&p, &q})
            for (dvec3& x : *points)
                x *= scale;
        pose.position_m *= scale;
        for (dvec3& x : q)
            x += at_m;
        pose.position_m -= pose.rotation * at_m;
        try {
            Pair pair{haptics::convex_hull(p, "a"), haptics::convex_hull(q, "b"), pose};
            if (brute_depth(pair.a, pair.b, pair.b_in_a) > 1e-5 * scale)
                return pair;
        } catch (const std::invalid_argument&) { // three points, or as good as flat
        }
    }
}

} // namespace

TEST_CASE("penetration: within 1 % of brute-force Minkowski on 1000 random convex pairs") {
    RandomPieces random(10);
    double worst = 0.0, worst_single = 0.0;
    int single_high = 0, high = 0, hubs = 0, single_hubs = 0;
    constexpr int kPairs = 1000;
    for (int i = 0; i < kPairs; ++i) {
        const Pair pair = overlapping(random);
        const double exact_m = brute_depth(pair.a, pair.b, pair.b_in_a);
        const Penetration found = haptics::penetration(pair.a, pair.b, pair.b_in_a);
        const Penetration single = haptics::walk_penetration(
            pair.a, pair.b, pair.b_in_a,
            haptics::to_world(pair.b_in_a, pair.b.centre_m) - pair.a.centre_m);
        CHECK(found.depth_m >= exact_m * (1.0 - 1e-6));
        CHECK(support_distance(pair.a, pair.b, pair.b_in_a, found.normal) ==
              doctest::Approx(found.depth_m).scale(0.0).epsilon(1e-6));
        worst = std::max(worst, found.depth_m / exact_m - 1.0);
        worst_single = std::max(worst_single, single.depth_m / exact_m - 1.0);
        high += found.depth_m > 1.01 * exact_m;
        single_high += single.depth_m > 1.01 * exact_m;
        hubs += found.hubs;
        single_hubs += single.hubs;
    }
    MESSAGE("one walk from the centres ends in a local minimum in "
            << 100.0 * single_high / kPairs << " % (worst " << 100.0 * worst_single << " %), "
            << single_hubs / kPairs << " pairs of vertices; the default in "
            << 100.0 * high / kPairs << " % (worst " << 100.0 * worst << " %), " << hubs / kPairs
            << " pairs");
    CHECK(high == 0);
}

TEST_CASE("penetration: metres, millimetres and 1000 m from the origin give the same depth") {
    for (int i = 0; i < 200; ++i) {
        RandomPieces metres(100 + i), small(100 + i), far(100 + i);
        const Pair plain = overlapping(metres);
        const Pair in_mm = overlapping(small, 1e3);
        const Pair away = overlapping(far, 1.0, {1000, 1000, -1000});
        const double depth_m = haptics::penetration(plain.a, plain.b, plain.b_in_a).depth_m;
        CHECK(haptics::penetration(in_mm.a, in_mm.b, in_mm.b_in_a).depth_m ==
              doctest::Approx(1e3 * depth_m).scale(0.0).epsilon(1e-9));
        CHECK(std::abs(haptics::penetration(away.a, away.b, away.b_in_a).depth_m - depth_m) <
              1e-11);
    }
}

// The local minimum everyone knows: a plate 2 mm thick with a rod 60 % through it. The way out is
// shorter on the far side, the walk from the near side stays on it.
TEST_CASE("penetration: a walk from the side of entry stays there, the default comes out beyond") {
    const ConvexHull plate = box({0.05, 0.05, 1e-3});
    const ConvexHull rod = box({1e-3, 1e-3, 1e-2});
    for (const double through_m : {0.2e-3, 0.8e-3, 1.2e-3, 1.6e-3}) {
        CAPTURE(through_m);
        // the rod's middle is level with the plate: 1 mm up, then down through
        const RigidPose pose{turn({1, 0, 0}, 0.01), {0, 0, 1.1e-2 - through_m}};
        const Penetration coherent = haptics::walk_penetration(plate, rod, pose, {0.1, 0.1, 1});
        CHECK(coherent.normal.z > 0.99);
        CHECK(coherent.depth_m == doctest::Approx(through_m).scale(0.0).epsilon(0.1));
    }
    const ConvexHull cube = box(dvec3{0.2e-3});
    const RigidPose inside{glm::dmat3(1.0), {0, 0, -0.2e-3}}; // nearer to the far side
    CHECK(haptics::walk_penetration(plate, cube, inside, {0, 0, 1}).depth_m ==
          doctest::Approx(1.4e-3).scale(0.0));
    const Penetration out = haptics::penetration(plate, cube, inside);
    CHECK(out.depth_m == doctest::Approx(1.0e-3).scale(0.0));
    CHECK(out.normal.z == doctest::Approx(-1.0).scale(0.0));
}

TEST_CASE("penetration: boxes face to face and all alike, where every tie is exact") {
    const ConvexHull cube = box(dvec3{1e-2});
    for (const dvec3 at_m : {dvec3{1.9e-2, 0, 0}, dvec3{0, -1.9e-2, 0}, dvec3{0, 0, 1.9e-2},
                             dvec3{1.9e-2, 1.8e-2, 1e-2}}) {
        for (const dvec3 start : {dvec3{1, 0, 0}, dvec3{0, 1, 0}, dvec3{-1, -1, -1}}) {
            const Penetration out =
                haptics::walk_penetration(cube, cube, {.position_m = at_m}, start);
            CHECK(out.depth_m == doctest::Approx(1e-3).scale(0.0));
            CHECK(glm::dot(out.normal, at_m) > 0.0);
        }
    }
    CHECK(haptics::penetration(cube, cube, {}).depth_m == doctest::Approx(2e-2).scale(0.0));
}

TEST_CASE("penetration: never comes out through a face inside the solid") {
    ConvexHull half = box({1e-2, 1e-2, 1e-2}); // left half of a longer block
    const ConvexHull tip = box(dvec3{1e-3});
    for (std::size_t f = 0; f < half.normal.size(); ++f)
        half.inner[f] = half.normal[f].x > 0.5;
    const RigidPose at_seam{turn({1, 2, 3}, 0.3), {1e-2, 0, 9e-3}}; // x: as good as out
    for (const Penetration& out : {haptics::penetration(half, tip, at_seam),
                                   haptics::walk_penetration(half, tip, at_seam, {1, 0, 0})}) {
        CHECK(out.found);
        CHECK(out.normal.x < 0.9);
        CHECK(out.normal.z > 0.5);
    }
}
