#include "haptics/collision/triangle.h"

#include "tests/haptics/effort.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <rapidcheck.h>

namespace {

using glm::dvec3;
using haptics::MovingSegment;
using haptics::MovingTriangle;
using haptics::TriangleCorners;
using haptics::TriangleSweep;
using Long = long double;
using Long3 = glm::tvec3<Long>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

struct Random {
    std::mt19937_64 engine;
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    double power(double low, double high) { return std::pow(10.0, between(low, high)); }
    dvec3 place(double size) {
        return {between(-size, size), between(-size, size), between(-size, size)};
    }
};

// All shapes: fair, slivers of both kinds down to where a double knows no width, needles of two
// corners in one, lines, points.
TriangleCorners any_triangle(Random& random) {
    const dvec3 a = random.place(1.0), b = random.place(1.0);
    const double s = random.between(-0.2, 1.2), thin = random.power(-17.0, 0.0);
    switch (random.engine() % 6) {
    case 0:
        return {a, b, random.place(1.0)};
    case 1: // cap: the third corner beside the edge
        return {a, b, a + s * (b - a) + thin * random.place(1.0)};
    case 2: // needle
        return {a, a + thin * random.place(1.0), b};
    case 3:
        return {a, b, b};
    case 4:
        return {a, b, a + s * (b - a)};
    default:
        return {a, a, a};
    }
}

Long distance_to_edge(const Long3& p, const Long3& a, const Long3& b) {
    const Long3 ab = b - a;
    const Long length2 = glm::dot(ab, ab);
    const Long s =
        length2 > 0 ? std::clamp(glm::dot(p - a, ab) / length2, Long(0), Long(1)) : Long(0);
    return glm::length(p - (a + s * ab));
}

// Independent: in long double, by an orthonormal base of the triangle's plane.
Long distance_to(const TriangleCorners& t, const Long3& p) {
    const Long3 a{t[0]}, b{t[1]}, c{t[2]};
    Long best =
        std::min({distance_to_edge(p, a, b), distance_to_edge(p, b, c), distance_to_edge(p, c, a)});
    const Long3 ab = b - a, ac = c - a;
    if (!(glm::dot(ab, ab) > 0))
        return best;
    const Long3 x = glm::normalize(ab);
    Long3 across = ac - x * glm::dot(ac, x);
    across -= x * glm::dot(across, x); // twice is enough
    const Long height = glm::length(across);
    if (!(height > 0))
        return best;
    const Long3 y = across / height;
    const Long px = glm::dot(p - a, x), py = glm::dot(p - a, y);
    const Long w = py / height, v = (px - w * glm::dot(ac, x)) / glm::length(ab);
    if (v >= 0 && w >= 0 && v + w <= 1)
        best = std::min(best, glm::length((p - a) - px * x - py * y));
    return best;
}

// The distance from a convex thing is convex along a line: ternary search.
Long distance_to_segment(const TriangleCorners& t, const dvec3& from, const dvec3& to) {
    const Long3 a{from}, d = Long3{to} - a;
    Long low = 0, high = 1;
    for (int i = 0; i < 120; ++i) {
        const Long s = low + (high - low) / 3, u = high - (high - low) / 3;
        (distance_to(t, a + s * d) < distance_to(t, a + u * d) ? high : low) =
            distance_to(t, a + s * d) < distance_to(t, a + u * d) ? u : s;
    }
    return std::min(
        {distance_to(t, a), distance_to(t, Long3{to}), distance_to(t, a + (low + high) / 2 * d)});
}

double coordinate(const TriangleCorners& t, std::initializer_list<dvec3> places) {
    double out = 0.0;
    const auto add = [&](const dvec3& p) {
        out = std::max({out, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    };
    for (const dvec3& p : t)
        add(p);
    for (const dvec3& p : places)
        add(p);
    return out;
}

MovingTriangle any_motion(Random& random, double amount) {
    MovingTriangle out{.before = any_triangle(random), .after = {}};
    const dvec3 together = random.place(amount);
    for (int k = 0; k < 3; ++k)
        out.after[k] = out.before[k] + together + random.place(amount);
    return out;
}

// What triangle.h promises of a sweep, against distances at many times: `distance(time)`.
template <class Distance>
void check_sweep(const TriangleSweep& sweep, const Distance& distance, double radius, double motion,
                 double rounding) {
    const double enough = haptics::kSweepGap * radius + rounding;
    if (distance(0.0) <= radius + enough)
        return; // in touch from the start
    if (sweep.hit()) {
        RC_ASSERT(sweep.time >= 0.0);
        RC_ASSERT(std::abs(std::sqrt(sweep.on_triangle.distance2_m2) -
                           static_cast<double>(distance(sweep.time))) <= rounding);
        // a swing that leaves more is rare; then the bound of triangle.h holds
        RC_ASSERT(distance(sweep.time) - radius <= std::max(enough, motion / 128.0));
    }
    constexpr int kTimes = 2000;
    const double until = sweep.hit() ? sweep.time : 1.0;
    for (int i = 0; i < kTimes; ++i)
        RC_ASSERT(distance(until * i / kTimes) >= radius - 2.0 * enough);
}

} // namespace

TEST_CASE("triangle: the nearest point is the true one to some roundings, also for slivers") {
    CHECK(rc::check([] {
        Random random{std::mt19937_64(*rc::gen::arbitrary<std::uint32_t>())};
        for (int i = 0; i < 300; ++i) {
            const double size = random.power(-6.0, 6.0);
            TriangleCorners t = any_triangle(random);
            const dvec3 at = i % 2 ? dvec3{0.0} : random.place(1.0) * random.power(0.0, 6.0);
            for (dvec3& p : t)
                p = size * (p + at);
            const double away = size * random.power(-12.0, 6.0);
            const dvec3 on = t[0] + random.between(0, 1) * (t[1] - t[0]) +
                             random.between(0, 0.5) * (t[2] - t[0]);
            const dvec3 place = on + random.place(away);
            const haptics::TrianglePoint near = haptics::nearest_on_triangle(t, place);
            const double rounding = 16.0 * kEpsilon * coordinate(t, {place});
            RC_ASSERT(std::abs(std::sqrt(near.distance2_m2) -
                               static_cast<double>(distance_to(t, place))) <= rounding);
            RC_ASSERT(std::min({near.weight.x, near.weight.y, near.weight.z}) >= 0.0);
            RC_ASSERT(std::abs(near.weight.x + near.weight.y + near.weight.z - 1.0) < 1e-12);
            const dvec3 sum = near.weight.x * t[0] + near.weight.y * t[1] + near.weight.z * t[2];
            RC_ASSERT(glm::length(sum - near.place_m) <= rounding);
        }
    }));
}

TEST_CASE("triangle: the nearest points of triangle and segment, also nearly parallel ones") {
    CHECK(rc::check([] {
        Random random{std::mt19937_64(*rc::gen::arbitrary<std::uint32_t>())};
        for (int i = 0; i < 60; ++i) {
            const TriangleCorners t = any_triangle(random);
            dvec3 from = random.place(1.0), to = random.place(1.0);
            if (i % 3 == 0) { // along an edge, or as good as
                const dvec3 beside = random.place(random.power(-12.0, 0.0));
                from = t[0] - 0.3 * (t[1] - t[0]) + beside;
                to = t[1] + beside + random.place(random.power(-14.0, 0.0));
            }
            if (i % 3 == 1) // short
                to = from + random.place(random.power(-14.0, -2.0));
            const haptics::SegmentPair pair = haptics::nearest_to_segment(t, from, to);
            const double expected = static_cast<double>(distance_to_segment(t, from, to));
            const double got = std::sqrt(pair.on_triangle.distance2_m2);
            // lying in a sliver to a rounding and nearly along its edges, both know less
            RC_ASSERT(std::abs(got - expected) <= (i % 3 == 0 ? 1e-10 : 32.0 * kEpsilon));
            RC_ASSERT(glm::length(pair.place_m - from - pair.along * (to - from)) <= 1e-15);
        }
    }));
}

TEST_CASE("triangle: a swept ball or point touches never late, and early by the gap at most") {
    int hits = 0;
    CHECK(rc::check([&hits] {
        Random random{std::mt19937_64(*rc::gen::arbitrary<std::uint32_t>())};
        for (int i = 0; i < 20; ++i) {
            const MovingTriangle t = any_motion(random, i % 2 ? 0.0 : random.power(-3.0, 0.0));
            const double radius = i % 4 < 2 ? 0.0 : random.power(-3.0, -0.5);
            const dvec3 from = random.place(1.0);
            const dvec3 middle = (t.at(0.5)[0] + t.at(0.5)[1] + t.at(0.5)[2]) / 3.0;
            const dvec3 to = from + random.between(0.5, 2.0) * (middle - from);
            const auto distance = [&](double time) {
                return distance_to(t.at(time), Long3{from + time * (to - from)});
            };
            const TriangleSweep sweep = haptics::sweep_ball(t, from, to, radius);
            hits += sweep.hit();
            check_sweep(sweep, distance, radius, 4.0, 80.0 * kEpsilon * 4.0);
            if (i % 2 == 0)
                continue;
            const TriangleSweep known = haptics::sweep_ball(
                t.before, haptics::nearest_on_triangle(t.before, from), from, to, radius);
            check_sweep(known, distance, radius, 4.0, 80.0 * kEpsilon * 4.0);
            RC_ASSERT(known.hit() == sweep.hit());
        }
    }));
    CHECK(hits > 100);
}

TEST_CASE("triangle: a swept capsule touches never late, and early by the gap at most") {
    CHECK(rc::check([] {
        Random random{std::mt19937_64(*rc::gen::arbitrary<std::uint32_t>())};
        for (int i = 0; i < 3; ++i) {
            const MovingTriangle t = any_motion(random, i % 2 ? 0.0 : random.power(-3.0, 0.0));
            const double radius = i % 3 ? random.power(-3.0, -0.5) : 0.0;
            const MovingSegment s{random.place(1.0), random.place(1.0), random.place(1.0),
                                  random.place(1.0)};
            const TriangleSweep sweep = haptics::sweep_capsule(t, s, radius);
            const auto distance = [&](double time) {
                const auto there = haptics::nearest_to_segment(
                    t.at(time), s.from_before_m + time * (s.from_after_m - s.from_before_m),
                    s.to_before_m + time * (s.to_after_m - s.to_before_m));
                return Long(std::sqrt(there.on_triangle.distance2_m2));
            };
            check_sweep(sweep, distance, radius, 4.0, 80.0 * kEpsilon * 4.0);
        }
    }));
}

TEST_CASE("triangle: a point aimed at a face, an edge or a corner hits, at rest and moving") {
    Random random{std::mt19937_64(3)};
    for (int i = 0; i < effort::cases(100000); ++i) {
        MovingTriangle t = any_motion(random, i % 2 ? 0.0 : 0.3);
        if (i % 3 == 0)
            for (int k = 0; k < 3; ++k)
                t.before[k] += 1000.0, t.after[k] += 1000.0;
        dvec3 weight{random.between(0, 1), random.between(0, 1), random.between(0, 1)};
        if (i % 5 == 0)
            weight.x = 0.0;
        if (i % 10 == 0)
            weight.y = 0.0;
        weight /= weight.x + weight.y + weight.z;
        const double time = i % 7 == 0 ? 1.0 : random.between(0.0, 1.0);
        const TriangleCorners there = t.at(time);
        const dvec3 aim = weight.x * there[0] + weight.y * there[1] + weight.z * there[2];
        const dvec3 way = random.place(random.power(-6.0, 0.0));
        REQUIRE(haptics::sweep_ball(t, aim - time * way, aim + (1.0 - time) * way, 0.0).hit());
    }
}

TEST_CASE("triangle: a ball at rest on a face may slide, over its edge too, and leave") {
    for (const double far : {0.0, 1.0, 1000.0}) {
        const dvec3 at{far, -far, far};
        const TriangleCorners left{at, at + dvec3{0.02, 0, 0}, at + dvec3{0, 0.02, 0}},
            right{at + dvec3{0.02, 0, 0}, at + dvec3{0.02, 0.02, 0}, at + dvec3{0, 0.02, 0}};
        const double radius = 5e-3;
        const dvec3 from = at + dvec3{0.004, 0.004, radius};
        for (const dvec3 way : {dvec3{0.01, 0.012, 0}, dvec3{0.01, 0.012, 1e-5}, dvec3{0, 0, 1e-3},
                                dvec3{-0.02, 0, 0}, dvec3{0.0}})
            for (const TriangleCorners& t : {left, right}) {
                CAPTURE(far);
                CAPTURE(way.x);
                CHECK_FALSE(haptics::sweep_ball({t, t}, from, from + way, radius).hit());
                CHECK_FALSE(haptics::sweep_ball(t, haptics::nearest_on_triangle(t, from), from,
                                                from + way, radius)
                                .hit());
            }
        const dvec3 press{0.0, 0.0, -1e-3};
        CHECK(haptics::sweep_ball({left, left}, from, from + press, radius).time <= 1e-6);
        CHECK(haptics::sweep_ball({left, left}, from + press, from + 2.0 * press, radius).time ==
              0.0);
        CHECK_FALSE(haptics::sweep_ball({left, left}, from + press, from, radius).hit());
        // the face comes up under it, or sinks away
        TriangleCorners up = left, down = left;
        for (int k = 0; k < 3; ++k)
            up[k].z += 1e-3, down[k].z -= 1e-3;
        CHECK(haptics::sweep_ball({left, up}, from, from, radius).time <= 1e-6);
        CHECK_FALSE(haptics::sweep_ball({left, down}, from, from, radius).hit());
    }
}

TEST_CASE("triangle: a power of two as unit changes no bit of an answer") {
    Random random{std::mt19937_64(5)};
    for (int i = 0; i < 2000; ++i) {
        const MovingTriangle t = any_motion(random, 0.2);
        MovingTriangle large = t;
        const double unit = 0x1p-10;
        for (int k = 0; k < 3; ++k)
            large.before[k] *= unit, large.after[k] *= unit;
        const dvec3 from = random.place(1.0), to = random.place(1.0);
        const TriangleSweep a = haptics::sweep_ball(t, from, to, 0.1);
        const TriangleSweep b = haptics::sweep_ball(large, unit * from, unit * to, unit * 0.1);
        CHECK(a.time == b.time);
        CHECK(a.on_triangle.weight == b.on_triangle.weight);
    }
}

TEST_CASE("triangle: what is not finite meets nothing") {
    const TriangleCorners t{dvec3{0, 0, 0}, dvec3{1, 0, 0}, dvec3{0, 1, 0}};
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        CHECK_FALSE(haptics::sweep_ball({t, t}, {0.2, 0.2, bad}, {0.2, 0.2, -1}, 0.0).hit());
        CHECK_FALSE(haptics::sweep_ball({t, t}, {0.2, 0.2, 1}, {0.2, bad, -1}, 0.1).hit());
        TriangleCorners torn = t;
        torn[2].y = bad;
        CHECK_FALSE(haptics::sweep_ball({t, torn}, {0.2, 0.2, 1}, {0.2, 0.2, -1}, 0.1).hit());
        const MovingSegment s{{0, 0, 1}, {0, 0, 2}, {0, bad, -1}, {0, 0, 1}};
        CHECK_FALSE(haptics::sweep_capsule({t, t}, s, 0.1).hit());
    }
}
