#include "haptics/contact/surface_walk.h"

#include "tests/haptics/walk_meshes.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <rapidcheck.h>

namespace {

using haptics::SurfacePoint;
using haptics::WalkResult;
using namespace walk_tests;

// A fan of n triangles about the origin of the plane, radius 1.
Mesh fan_mesh(int n) {
    Mesh m;
    m.vertex.push_back({0, 0, 0});
    for (int i = 0; i < n; ++i)
        m.vertex.push_back({std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n), 0});
    for (int i = 0; i < n; ++i)
        m.triangle.push_back({0, 1 + i, 1 + (i + 1) % n});
    m.connect();
    return m;
}

double random_in(double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 1000001) * 1e-6;
}

} // namespace

TEST_CASE("surface walk: on a flat mesh it ends where the offset points") {
    CHECK(rc::check([] {
        const Mesh m = flat_mesh(*rc::gen::arbitrary<std::uint32_t>(), 6, 0.3);
        const glm::dvec3 from{random_in(0.1, 0.9), random_in(0.1, 0.9), 0};
        const glm::dvec3 to{random_in(0.1, 0.9), random_in(0.1, 0.9), 0};
        const glm::dvec3 off_plane{0, 0, random_in(-1, 1)};
        const WalkResult r = haptics::walk(m, find(m, from), to - from + off_plane);
        RC_ASSERT(sound(r.point));
        RC_ASSERT(!r.at_rim);
        RC_ASSERT(glm::length(m.at(r.point) - to) < 1e-12);
    }));
}

TEST_CASE("surface walk: on a folded strip it ends where the unfolded strip says") {
    // a flat mesh rolled over prisms: creases along y, each piece flat
    constexpr int kCells = 6;
    CHECK(rc::check([] {
        Mesh flat = flat_mesh(*rc::gen::arbitrary<std::uint32_t>(), kCells, 0.0);
        Mesh folded = flat;
        std::array<double, kCells + 1> x{};
        std::array<double, kCells + 1> z{};
        for (int i = 0; i < kCells; ++i) {
            const double slope = random_in(-1.4, 1.4);
            x[i + 1] = x[i] + std::cos(slope) / kCells;
            z[i + 1] = z[i] + std::sin(slope) / kCells;
        }
        for (glm::dvec3& v : folded.vertex) {
            const auto column = static_cast<std::size_t>(std::lround(v.x * kCells));
            v = {x[column], v.y, z[column]};
        }
        const glm::dvec3 from{random_in(0.05, 0.95), random_in(0.1, 0.9), 0};
        const glm::dvec3 to{random_in(0.05, 0.95), random_in(0.1, 0.9), 0};
        const SurfacePoint start = find(flat, from);
        // the offset in the plane of the first piece
        const int piece = std::min(kCells - 1, static_cast<int>(from.x * kCells));
        const double slope = std::atan2(z[piece + 1] - z[piece], x[piece + 1] - x[piece]);
        const glm::dvec3 d = to - from;
        const WalkResult r =
            haptics::walk(folded, start, {d.x * std::cos(slope), d.y, d.x * std::sin(slope)});
        RC_ASSERT(sound(r.point));
        RC_ASSERT(glm::length(flat.at(r.point) - to) < 1e-12);
    }));
}

TEST_CASE("surface walk: on a sphere the way walked is as long as the offset") {
    const Mesh m = sphere_mesh(5);
    CHECK(rc::check([&m] {
        const glm::dvec3 from =
            glm::normalize(glm::dvec3{random_in(-1, 1), random_in(-1, 1), random_in(-1, 1)} + 1e-3);
        const SurfacePoint start = [&] {
            for (int t = 0; t < static_cast<int>(m.triangle.size()); ++t) {
                const glm::dvec3 c = (m.position(t, 0) + m.position(t, 1) + m.position(t, 2)) / 3.0;
                if (glm::length(c - from) < 0.05)
                    return SurfacePoint{t, glm::dvec3{1.0 / 3.0}};
            }
            return SurfacePoint{};
        }();
        RC_ASSERT(start.triangle >= 0);
        const glm::dvec3 here = glm::normalize(m.at(start));
        const glm::dvec3 side =
            glm::normalize(glm::cross(here, glm::dvec3{random_in(-1, 1), random_in(-1, 1), 0.7}));
        const double way = random_in(0.05, 0.9);
        const WalkResult r = haptics::walk(m, start, way * side);
        RC_ASSERT(sound(r.point));
        RC_ASSERT(!r.at_rim);
        // facets of side 0.05 cut the arc short by (0.05)^2/8 and scatter the heading by as much
        const double arc = std::acos(glm::dot(here, glm::normalize(m.at(r.point))));
        RC_ASSERT(std::abs(arc - way) < 0.003 * (1.0 + way));
    }));
}

TEST_CASE("surface walk: a vertex of eight triangles is crossed a thousand times, never lost") {
    for (const int n : {3, 8, 40}) {
        const Mesh m = fan_mesh(n);
        std::mt19937 rng(7);
        std::uniform_real_distribution<double> uniform(0.0, 2.0 * M_PI);
        SurfacePoint p = find(m, {0.3, 0.01, 0});
        for (int i = 0; i < 1000; ++i) {
            // exactly to the vertex, or one rounding past it, then out on another side
            const glm::dvec3 back = -m.at(p) * (i % 3 == 0 ? 1.0 : i % 3 == 1 ? 1.0 + 1e-16 : 2.0);
            p = haptics::walk(m, p, back).point;
            const double angle = i % 7 == 0 ? 2.0 * M_PI / n * (i % n) : uniform(rng);
            const glm::dvec3 to = 0.25 * glm::dvec3{std::cos(angle), std::sin(angle), 0};
            const WalkResult r = haptics::walk(m, p, to - m.at(p));
            REQUIRE(sound(r.point));
            REQUIRE(glm::length(m.at(r.point) - to) < 1e-12);
            p = r.point;
        }
    }
}

TEST_CASE("surface walk: along edges and through their ends the point keeps to the line") {
    // vertices in rows, so the line y = 0.5 is all edges; turned and a metre off, so that no
    // direction is exactly along an edge any more
    const Mesh flat = flat_mesh(3, 8, 0.0);
    std::mt19937 rng(5);
    std::normal_distribution<double> normal;
    const SurfacePoint start = find(flat, {0.125, 0.5, 0});
    for (int trial = 0; trial < 1000; ++trial) {
        const glm::dvec3 x = glm::normalize(glm::dvec3{normal(rng), normal(rng), normal(rng)});
        const glm::dvec3 y = glm::normalize(glm::cross(x, {normal(rng), normal(rng), 1.0}));
        const auto place = [&](const glm::dvec3& v) { return 1.0 + x * v.x + y * v.y; };
        Mesh m = flat;
        for (glm::dvec3& v : m.vertex)
            v = place(v);
        const double way = trial % 2 == 0 ? 0.75 : -0.125;
        const WalkResult r = haptics::walk(m, start, way * x);
        REQUIRE(sound(r.point));
        REQUIRE(glm::length(m.at(r.point) - place({0.125 + way, 0.5, 0})) < 1e-12);
    }
}

TEST_CASE("surface walk: the rim holds the point and lets it slide along") {
    const Mesh m = flat_mesh(11, 6, 0.3);
    const WalkResult r = haptics::walk(m, find(m, {0.8, 0.4, 0}), {0.5, 0.3, 0});
    CHECK(r.at_rim);
    CHECK(sound(r.point));
    // straight to x = 1 at y = 0.52, then the part along the rim
    CHECK(glm::length(m.at(r.point) - glm::dvec3{1.0, 0.7, 0}) < 1e-12);
    const WalkResult corner = haptics::walk(m, r.point, {0.4, 0.9, 0});
    CHECK(corner.at_rim);
    CHECK(glm::length(m.at(corner.point) - glm::dvec3{1.0, 1.0, 0}) < 1e-12);
    const WalkResult home = haptics::walk(m, corner.point, {-0.5, -0.5, 0});
    CHECK_FALSE(home.at_rim);
    CHECK(glm::length(m.at(home.point) - glm::dvec3{0.5, 0.5, 0}) < 1e-12);
}

TEST_CASE("surface walk: slivers without an area are crossed, not fallen into") {
    CHECK(rc::check([] {
        // columns of the mesh squeezed to nothing: their triangles are lines
        Mesh m = flat_mesh(*rc::gen::arbitrary<std::uint32_t>(), 6, 0.0);
        const Mesh full = m;
        for (glm::dvec3& v : m.vertex)
            v.x = v.x < 0.5 - 1e-9 ? v.x : v.x - 1.0 / 6.0; // column 3 has no width
        const glm::dvec3 from{random_in(0.02, 0.3), random_in(0.2, 0.8), 0};
        const glm::dvec3 to{random_in(0.35, 0.8), random_in(0.2, 0.8), 0};
        const WalkResult r = haptics::walk(m, find(m, from), to - from);
        RC_ASSERT(sound(r.point));
        RC_ASSERT(glm::length(m.at(r.point) - to) < 1e-9);
    }));
}

TEST_CASE("surface walk: absurd offsets and broken corners leave the point on the surface") {
    Mesh m = flat_mesh(5, 6, 0.3);
    const SurfacePoint start = find(m, {0.4, 0.4, 0});
    for (const double bad : {std::nan(""), HUGE_VAL, -1e300, 1e5}) {
        const WalkResult r = haptics::walk(m, start, {bad, 0.1, 0});
        CHECK(sound(r.point));
        CHECK(r.at_rim);
    }
    CHECK(haptics::walk(m, {}, {1, 0, 0}).point.triangle == haptics::kNoTriangle);
    for (glm::dvec3& v : m.vertex)
        v.y = v.x < 0.6 ? v.y : std::nan("");
    CHECK(sound(haptics::walk(m, start, {0.5, 0.1, 0}).point));
    for (glm::dvec3& v : m.vertex)
        v = glm::dvec3{0.2};
    CHECK(sound(haptics::walk(m, start, {0.5, 0.1, 0}).point));
}
