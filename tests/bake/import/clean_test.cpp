#include "assets/bake/import/clean.h"

#include "assets/bake/import/bodies.h"
#include "assets/bake/import/crossing.h"
#include "assets/bake/import/resample.h"
#include "assets/bake/import/topology.h"
#include "assets/bake/import/winding.h"
#include "tests/bake/import/surface_files.h"
#include "tests/bake/shapes_for_tests.h"

#include <doctest/doctest.h>

using namespace bake_tests;

namespace {

/// As STL has them: three points for each triangle.
bake::Soup soup_of(const Surface& s) {
    bake::Soup soup;
    for (const auto& t : s.triangles) {
        for (const auto v : t) {
            soup.point.push_back(s.point_m[v]);
        }
        const auto first = static_cast<std::uint32_t>(soup.point.size() - 3);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    return soup;
}

std::string all_of(const std::vector<std::string>& lines) {
    std::string text;
    for (const auto& line : lines) {
        text += line + "\n";
    }
    return text;
}

struct Cleaned {
    bake::Notes notes{.unit = {"mm", 1e-3}, .repairs = {}, .problems = {}};
    bake::Pieces pieces;
    explicit Cleaned(const Surface& s) : pieces(bake::clean(soup_of(s), notes)) {}
    [[nodiscard]] std::string said() const { return all_of(notes.repairs); }
    [[nodiscard]] double volume_mm3(std::size_t i) const {
        return 1e9 * bake::volume_m3(pieces.closed.at(i));
    }
};

void refuses(const Surface& s, const char* message) {
    CHECK_THROWS_WITH_AS(Cleaned{s}, doctest::Contains(message), bake::ImportRefused);
}

const Surface kGlobe = globe(30.0, 16, 10);

} // namespace

TEST_CASE("clean: a whole surface is left as it is") {
    const Cleaned c(kGlobe);
    CHECK(c.said().empty());
    REQUIRE(c.pieces.closed.size() == 1);
    CHECK(c.pieces.closed[0].triangles.size() == kGlobe.triangles.size());
    CHECK(c.volume_mm3(0) == near(bake::volume_m3(kGlobe), 1e-12));
}

TEST_CASE("clean: triangles that face the wrong way are turned, as few as possible") {
    auto s = kGlobe;
    for (const std::size_t t : {3, 17, 40}) {
        std::swap(s.triangles[t][0], s.triangles[t][1]);
    }
    const Cleaned c(s);
    CHECK(c.said() == "3 triangles turned over to agree with their neighbours\n");
    CHECK(c.volume_mm3(0) == near(bake::volume_m3(kGlobe), 1e-12));
}

TEST_CASE("clean: a small hole is filled, a large one is refused with its size and place") {
    auto s = kGlobe;
    s.triangles.erase(s.triangles.begin() + 20, s.triangles.begin() + 22);
    CHECK(Cleaned(s).said().substr(0, 14) == "2 holes filled");
    CHECK(Cleaned(s).pieces.closed.size() == 1);
    s = kGlobe;
    std::erase_if(s.triangles, [&](const tissue::Triangle& t) { return s.point_m[t[0]].z > 5.0; });
    refuses(s, "it is open: a hole");
}

TEST_CASE("clean: doubles, flat triangles and points apart by a rounding are mended") {
    auto s = kGlobe;
    s.triangles.push_back(s.triangles[5]);
    s.triangles.push_back({1, 2, 2});
    s.point_m.push_back(s.point_m[40] + glm::dvec3{2e-5, 0, 0});
    bool done = false;
    for (auto& t : s.triangles) { // one triangle at point 40 gets the other one
        for (auto& v : t) {
            if (v == 40 && !done) {
                v = static_cast<std::uint32_t>(s.point_m.size() - 1);
                done = true;
            }
        }
    }
    const Cleaned c(s);
    CHECK(c.pieces.closed.size() == 1);
    CHECK(c.said().find("1 triangles without area dropped") != std::string::npos);
    CHECK(c.said().find("1 double triangles dropped") != std::string::npos);
    CHECK(c.said().find("points on open edges welded") != std::string::npos);
    CHECK(c.volume_mm3(0) == near(bake::volume_m3(kGlobe), 1e-5));
}

TEST_CASE("clean: a T-junction is closed without a new hole or bump") {
    auto s = brick({0, 0, 0}, {40, 30, 20});
    s.point_m.emplace_back(20, 0, 0); // on the edge from 0 to 1, known to one of its two triangles
    s.triangles[1] = {0, 3, 8};
    s.triangles.push_back({8, 3, 1});
    const Cleaned c(s);
    CHECK(c.said().find("T-junctions") != std::string::npos);
    REQUIRE(c.pieces.closed.size() == 1);
    CHECK(std::abs(c.volume_mm3(0)) == near(40.0 * 30.0 * 20.0));
}

TEST_CASE("clean: a Moebius strip is refused with a place") {
    refuses(moebius_strip(), "it has one side only, like a Moebius strip, found at (");
}

TEST_CASE("clean: a size that fits another unit is refused, and the unit named") {
    auto s = kGlobe;
    for (auto& p : s.point_m) {
        p *= 1e-3;
    }
    refuses(s, "--unit m (60 mm long) would fit");
}

TEST_CASE("clean: two bricks that share an edge come apart") {
    // both have corners (40,30,0) and (40,30,20)
    const auto s = both(brick({0, 0, 0}, {40, 30, 20}), brick({40, 30, 0}, {80, 60, 20}));
    const Cleaned c(s);
    CHECK(c.pieces.closed.size() == 2);
    CHECK(c.said().find("1 edges of more than two triangles") != std::string::npos);
}

TEST_CASE("clean: two bricks that share a wall come apart") {
    const auto s = both(brick({0, 0, 0}, {40, 30, 20}), brick({40, 0, 0}, {80, 30, 20}));
    const Cleaned c(s);
    REQUIRE(c.pieces.closed.size() == 2);
    CHECK(c.volume_mm3(0) == near(24000.0));
    CHECK(c.volume_mm3(1) == near(24000.0));
}

TEST_CASE("bodies: a shell in a shell is a cavity, whichever way it faces") {
    auto inner = globe(15.0, 16, 10);
    for (int way = 0; way < 2; ++way) {
        Cleaned c(both(kGlobe, inner));
        const auto bodies = bake::make_bodies(std::move(c.pieces.closed), c.notes);
        REQUIRE(bodies.size() == 1);
        REQUIRE(bodies[0].cavity_m.size() == 1);
        const double solid = bake::volume_m3(kGlobe) * (1.0 - 0.125); // half the radius
        CHECK(1e9 * bodies[0].volume_m3 == near(solid, 1e-9));
        CHECK(1e9 * bake::volume_m3(bodies[0].surface) == near(solid, 1e-9));
        CHECK(std::abs(bake::winding_number(bodies[0].surface, bodies[0].cavity_m[0])) < 1e-13);
        for (auto& t : inner.triangles) {
            std::swap(t[0], t[1]);
        }
    }
}

TEST_CASE("bodies: a body in a cavity is a body, a speck is dropped and said") {
    Cleaned c(both(both(kGlobe, globe(20.0, 16, 10)),
                   both(globe(10.0, 16, 10), globe(0.5, 8, 6, {50, 0, 0}))));
    const auto bodies = bake::make_bodies(std::move(c.pieces.closed), c.notes);
    CHECK(bodies.size() == 2);
    CHECK(c.said().find("1 specks") != std::string::npos);
}

TEST_CASE("winding: one inside a closed surface, nought outside, and fast agrees with exact") {
    const auto s = globe(30.0, 40, 24);
    const bake::FastWinding fast(s);
    for (const double x : {0.0, 12.0, 28.0, 31.0, 45.0, 200.0}) {
        const glm::dvec3 p{x, 0.3 * x / 10, 0.1};
        CHECK(std::abs(bake::winding_number(s, p) - (x < 30.0 ? 1.0 : 0.0)) < 1e-13); // rounding
        CHECK(std::abs(fast(p) - bake::winding_number(s, p)) < 0.02);
    }
}

TEST_CASE("crossing: a closed surface has none, two that overlap have, with the place") {
    CHECK(bake::find_crossings(kGlobe, 10).empty());
    CHECK(bake::find_crossings(brick({0, 0, 0}, {40, 30, 20}), 10).empty());
    const auto s = both(brick({0, 0, 0}, {10, 10, 10}), brick({9, 4, 4}, {20, 6, 6}));
    const auto crossings = bake::find_crossings(s, 1000);
    REQUIRE(!crossings.empty());
    for (const auto& c : crossings) {
        CHECK(c.at_m.x == doctest::Approx(10.0).scale(0.0).epsilon(0.1));
    }
}

TEST_CASE("crossing: touching in a point, along an edge or folded flat counts") {
    const Surface point{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {2, 2, 0}, {2, 2, 5}, {4, 4, 5}},
                        {{0, 1, 2}, {3, 4, 5}}};
    CHECK(bake::find_crossings(point, 10).size() == 1);
    const Surface folded{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {3, 3, 0}}, {{0, 1, 2}, {1, 0, 3}}};
    CHECK(bake::find_crossings(folded, 10).size() == 1);
    Surface flat = folded; // the same two, unfolded
    flat.point_m[3] = {3, -3, 0};
    CHECK(bake::find_crossings(flat, 10).empty());
}

TEST_CASE("resample: two overlapping balls become one body of their union's volume") {
    const double r = 30.0, d = 40.0; // lens of two equal spheres: pi (4 r + d) (2 r - d)^2 / 12
    const auto s = both(globe(r, 60, 40), globe(r, 60, 40, {d, 0.01, 0.02}));
    const auto sampled = bake::resample(s, 1.5);
    const double lens = std::numbers::pi * (4 * r + d) * (2 * r - d) * (2 * r - d) / 12.0;
    const double ball = bake::volume_m3(globe(r, 60, 40));
    CHECK(bake::volume_m3(sampled.surface) == near(2.0 * ball - lens, 0.01));
    const auto problems = bake::check_surface(sampled.surface);
    CHECK(problems.refused_triangles + problems.open_edges + problems.pinched_vertices == 0);
    // caps of height r - d/2 on both: 2 pi r h of 4 pi r^2 each
    CHECK(sampled.hidden_share ==
          doctest::Approx((r - 0.5 * d) / (2.0 * r)).scale(0.0).epsilon(0.2));
}

TEST_CASE("topology: a point where two fans meet is split") {
    auto s = both(tetrahedron(), tetrahedron());
    for (std::size_t v = 4; v < 8; ++v) {
        s.point_m[v] = -s.point_m[v];
    }
    for (auto& t : s.triangles) { // the two origins become one point
        for (auto& v : t) {
            v = v == 4 ? 0 : v;
        }
    }
    const auto topology = bake::make_manifold(s);
    CHECK(topology.open_edges == 0);
    CHECK(bake::check_surface(s).pinched_vertices == 0);
    std::size_t count = 0;
    bake::pieces(topology, count);
    CHECK(count == 2);
}
