#include "haptics/collision/box_tree.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <random>
#include <rapidcheck.h>

namespace {

using glm::dvec3;
using haptics::BoxTree;
using Triangle = std::array<std::uint32_t, 3>;
using Whole = dvec3; // of small whole numbers: their products are exact

struct Mesh {
    std::vector<dvec3> vertex;
    std::vector<Triangle> triangle;
    std::array<dvec3, 3> corners(std::size_t t) const {
        return {vertex[triangle[t][0]], vertex[triangle[t][1]], vertex[triangle[t][2]]};
    }
};

struct Random {
    std::mt19937_64 engine;
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    dvec3 place(double size) {
        return {between(-size, size), between(-size, size), between(-size, size)};
    }
    template <typename T> const T& one_of(const std::vector<T>& all) {
        return all[engine() % all.size()];
    }
};

// A ball of 2 x rings x segments triangles whose radius varies at random: closed, folded,
// with silhouettes everywhere.
Mesh crumpled_ball(Random& random, std::uint32_t rings, std::uint32_t segments) {
    Mesh mesh;
    const auto vertex = [&](double theta, double phi) {
        mesh.vertex.push_back(random.between(0.5, 1.0) * dvec3{std::sin(theta) * std::cos(phi),
                                                               std::sin(theta) * std::sin(phi),
                                                               std::cos(theta)});
    };
    vertex(0.0, 0.0);
    for (std::uint32_t j = 1; j <= rings; ++j)
        for (std::uint32_t i = 0; i < segments; ++i)
            vertex(3.14159265 * j / (rings + 1), 6.2831853 * i / segments);
    vertex(3.14159265, 0.0);
    const auto last = static_cast<std::uint32_t>(mesh.vertex.size() - 1);
    for (std::uint32_t i = 0; i < segments; ++i) {
        const std::uint32_t next = (i + 1) % segments;
        mesh.triangle.push_back({0, 1 + i, 1 + next});
        for (std::uint32_t j = 0; j + 1 < rings; ++j) {
            const std::uint32_t row = 1 + j * segments, below = row + segments;
            mesh.triangle.push_back({row + i, below + i, below + next});
            mesh.triangle.push_back({row + i, below + next, row + next});
        }
        const std::uint32_t row = 1 + (rings - 1) * segments;
        mesh.triangle.push_back({row + i, last, row + next});
    }
    return mesh;
}

// The independent answer, by Moeller & Trumbore in long double; 0 within a billionth of an edge
// or an end, where rounding may decide.
int brute_force(const Mesh& mesh, const dvec3& from, const dvec3& to) {
    using Long3 = glm::tvec3<long double>;
    constexpr long double kDoubt = 1e-9L;
    bool doubt = false;
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
        const auto [a, b, c] = mesh.corners(t);
        const Long3 d = Long3(to) - Long3(from), s = Long3(from) - Long3(a);
        const Long3 ab = Long3(b) - Long3(a), ac = Long3(c) - Long3(a);
        const Long3 h = glm::cross(d, ac), q = glm::cross(s, ab);
        const long double det = glm::dot(ab, h);
        const long double v = glm::dot(s, h) / det, w = glm::dot(d, q) / det;
        const long double at = glm::dot(ac, q) / det;
        const long double inside = std::min({v, w, 1.0L - v - w, at, 1.0L - at});
        if (inside > kDoubt)
            return 1;
        doubt |= !(inside < -kDoubt);
    }
    return doubt ? 0 : -1;
}

bool hits(const Mesh& mesh, const dvec3& from, const dvec3& to) {
    return haptics::segment_hits(haptics::make_box_tree(mesh.vertex, mesh.triangle), mesh.vertex,
                                 from, to);
}

} // namespace

TEST_CASE("box tree: agrees with brute force on crumpled balls, also after they deform") {
    CHECK(rc::check([] {
        Random random{std::mt19937_64(*rc::gen::arbitrary<std::uint32_t>())};
        Mesh mesh = crumpled_ball(random, 9, 14);
        BoxTree tree = haptics::make_box_tree(mesh.vertex, mesh.triangle);
        int hit = 0, missed = 0;
        for (int pass = 0; pass < 3; ++pass) {
            for (int i = 0; i < 100; ++i) {
                const dvec3 from = random.place(1.5), to = random.place(1.5);
                const int expected = brute_force(mesh, from, to);
                if (expected == 0)
                    continue;
                RC_ASSERT(haptics::segment_hits(tree, mesh.vertex, from, to) == (expected > 0));
                RC_ASSERT(haptics::segment_hits(tree, mesh.vertex, to, from) == (expected > 0));
                ++(expected > 0 ? hit : missed);
            }
            for (dvec3& v : mesh.vertex)
                v += random.place(0.3);
            haptics::refit(tree, mesh.vertex);
        }
        RC_ASSERT(hit > 30);
        RC_ASSERT(missed > 30);
    }));
}

TEST_CASE("box tree: refitted, its boxes hold what they should and answers are a new tree's") {
    Random random{std::mt19937_64(7)};
    Mesh mesh = crumpled_ball(random, 20, 30);
    BoxTree tree = haptics::make_box_tree(mesh.vertex, mesh.triangle);
    for (dvec3& v : mesh.vertex)
        v = 3.0 * dvec3{v.z, v.x, v.y} + random.place(0.1);
    haptics::refit(tree, mesh.vertex);
    for (std::size_t at = 0; at < tree.box.size(); ++at) {
        dvec3 low{1e9}, high{-1e9};
        for (std::size_t in = at; in < tree.box[at].after; ++in)
            for (std::uint32_t i = 0; i < tree.box[in].count; ++i)
                for (const std::uint32_t v : tree.triangle[tree.box[in].first + i]) {
                    low = glm::min(low, mesh.vertex[v]);
                    high = glm::max(high, mesh.vertex[v]);
                }
        REQUIRE(tree.box[at].low_m == low);
        REQUIRE(tree.box[at].high_m == high);
    }
    const BoxTree anew = haptics::make_box_tree(mesh.vertex, mesh.triangle);
    CHECK(anew.largest_m == tree.largest_m);
    for (int i = 0; i < 2000; ++i) {
        const dvec3 from = random.place(4.0), to = random.place(4.0);
        CHECK(haptics::segment_hits(tree, mesh.vertex, from, to) ==
              haptics::segment_hits(anew, mesh.vertex, from, to));
    }
}

TEST_CASE("box tree: a segment aimed at an edge or a vertex hits, in any unit and place") {
    CHECK(rc::check([] {
        Random random{std::mt19937_64(*rc::gen::arbitrary<std::uint32_t>())};
        const double unit = *rc::gen::element(1e-3, 1.0, 1e3, 1e-30, 1e30);
        const double far = *rc::gen::element(0.0, 1.0, 1e6); // a metre, 1000 m of millimetres
        Mesh mesh = crumpled_ball(random, 5, 8);
        const dvec3 offset = random.place(far);
        for (dvec3& v : mesh.vertex)
            v = unit * (v + offset);
        const BoxTree tree = haptics::make_box_tree(mesh.vertex, mesh.triangle);
        for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
            const auto [a, b, c] = mesh.corners(t);
            const double s = random.between(0.0, 1.0);
            for (const dvec3& aim : {a, b, c, a + s * (b - a), 0.5 * (b + c)}) {
                dvec3 way = unit * random.place(2.0);
                if (t % 4 == 0) // along an axis, or in the plane of the triangle
                    way = {0.0, unit, 0.0};
                if (t % 4 == 1)
                    way = 0.4 * (b - a) + 0.9 * (c - a);
                RC_ASSERT(haptics::segment_hits(tree, mesh.vertex, aim - way, aim + way));
                RC_ASSERT(haptics::segment_hits(tree, mesh.vertex, aim - way, aim));
                RC_ASSERT(haptics::segment_hits(tree, mesh.vertex, aim, aim + 0.3 * way));
                RC_ASSERT(haptics::segment_hits(tree, mesh.vertex, aim, aim));
            }
        }
    }));
}

TEST_CASE("box tree: nothing gets out of a closed mesh through its edges and vertices") {
    Random random{std::mt19937_64(3)};
    for (int pass = 0; pass < 20; ++pass) {
        const Mesh mesh = crumpled_ball(random, 6, 9);
        const BoxTree tree = haptics::make_box_tree(mesh.vertex, mesh.triangle);
        for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
            const auto [a, b, c] = mesh.corners(t);
            for (const dvec3& aim : {a, b, c, 0.5 * (a + b), 0.3 * b + 0.7 * c})
                for (int i = 0; i < 20; ++i) { // beside the aim by less than anything resolves
                    const dvec3 from = random.place(0.1);
                    const dvec3 to = from + 5.0 * (aim + random.place(1e-15) - from);
                    REQUIRE(haptics::segment_hits(tree, mesh.vertex, from, to));
                }
        }
    }
}

namespace {

double volume(const Whole& a, const Whole& b, const Whole& c, const Whole& d) {
    return glm::dot(glm::cross(b - a, c - a), d - a);
}

int sign(double x) {
    return (x > 0) - (x < 0);
}

// In a plane seen without its axis `out`.
double area(const Whole& a, const Whole& b, const Whole& c, int out) {
    return glm::cross(b - a, c - a)[out];
}

bool within(const Whole& p, const Whole& a, const Whole& b) {
    return glm::min(a, b) == glm::min(glm::min(a, b), p) &&
           glm::max(a, b) == glm::max(glm::max(a, b), p);
}

bool flat_segments_meet(const Whole& p, const Whole& q, const Whole& a, const Whole& b, int out) {
    const int pa = sign(area(p, q, a, out)), pb = sign(area(p, q, b, out));
    const int ap = sign(area(a, b, p, out)), aq = sign(area(a, b, q, out));
    if (pa * pb < 0 && ap * aq < 0)
        return true;
    return (pa == 0 && within(a, p, q)) || (pb == 0 && within(b, p, q)) ||
           (ap == 0 && within(p, a, b)) || (aq == 0 && within(q, a, b));
}

// Exact, of closed sets; the triangle must have an area.
bool exactly_meets(const Whole& p, const Whole& q, const std::array<Whole, 3>& t) {
    const double above = volume(t[0], t[1], t[2], p), below = volume(t[0], t[1], t[2], q);
    if (above != 0 || below != 0) {
        if (sign(above) * sign(below) > 0)
            return false;
        const int u = sign(volume(p, q, t[1], t[2])), v = sign(volume(p, q, t[2], t[0])),
                  w = sign(volume(p, q, t[0], t[1]));
        return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    }
    const Whole n = glm::cross(t[1] - t[0], t[2] - t[0]);
    const int out = n.x != 0 ? 0 : n.y != 0 ? 1 : 2;
    const int u = sign(area(p, t[1], t[2], out)), v = sign(area(p, t[2], t[0], out)),
              w = sign(area(p, t[0], t[1], out));
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0) ||
           flat_segments_meet(p, q, t[0], t[1], out) || flat_segments_meet(p, q, t[1], t[2], out) ||
           flat_segments_meet(p, q, t[2], t[0], out);
}

} // namespace

TEST_CASE("box tree: exact on whole numbers: edges, vertices, ends, triangles seen edge-on") {
    Random random{std::mt19937_64(11)};
    const auto place = [&](std::uint64_t size) {
        Whole out;
        for (int axis = 0; axis < 3; ++axis)
            out[axis] = static_cast<double>(random.engine() % size);
        return out;
    };
    int hit = 0, missed = 0, flat = 0;
    for (int i = 0; i < 200000; ++i) {
        const std::uint64_t size = i % 2 ? 4 : 12; // small: most cases are special ones
        const std::array<Whole, 3> t{place(size), place(size), place(size)};
        const Whole p = place(size), q = place(size);
        if (glm::cross(t[1] - t[0], t[2] - t[0]) == Whole{0.0} || p == q)
            continue;
        const Mesh mesh{{t[0], t[1], t[2]}, {{0, 1, 2}}};
        const bool expected = exactly_meets(p, q, t);
        REQUIRE(hits(mesh, p, q) == expected);
        ++(expected ? hit : missed);
        flat += volume(t[0], t[1], t[2], p) == 0 && volume(t[0], t[1], t[2], q) == 0;
    }
    CHECK(hit > 10000);
    CHECK(missed > 10000);
    CHECK(flat > 1000);
}

TEST_CASE("box tree: a triangle without an area is met where it is, and nowhere else") {
    const dvec3 a{0.01, 0.02, 0.03}, b{0.05, -0.01, 0.02};
    const Mesh line{{a, b, a + 0.25 * (b - a)}, {{0, 1, 2}}}, dot{{a, a, a}, {{0, 1, 2}}};
    Random random{std::mt19937_64(5)};
    for (int i = 0; i < 1000; ++i) {
        const dvec3 way = random.place(0.1);
        const dvec3 on = a + random.between(0.0, 1.0) * (b - a);
        CHECK(hits(line, on - way, on + way));
        CHECK(hits(dot, a - way, a + way));
        const dvec3 beyond = b + 1e-9 * (b - a), beside = on + 1e-12 * glm::cross(way, b - a);
        CHECK_FALSE(hits(line, beyond - way, beyond + way));
        CHECK_FALSE(hits(line, beyond, beyond + (b - a))); // along it
        CHECK_FALSE(hits(dot, beside - way, beside + way));
    }
    CHECK(hits(line, a - (b - a), b));
}

TEST_CASE("box tree: a sliver is missed by a nanometre") {
    const Mesh sliver{{{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.1, 1e-12, 0.0}}, {{0, 1, 2}}};
    CHECK(hits(sliver, {0.05, 0.25e-12, 0.1}, {0.05, 0.25e-12, -0.1}));
    CHECK_FALSE(hits(sliver, {0.05, 1e-9, 0.1}, {0.05, 1e-9, -0.1}));
    CHECK_FALSE(hits(sliver, {-1e-9, 0.0, 0.1}, {-1e-9, 0.0, -0.1}));
    CHECK_FALSE(hits(sliver, {-0.1, 0.0, 0.0}, {-1e-9, 0.0, 0.0}));
}

TEST_CASE("box tree: a triangle seen nearly edge-on is met at its own depth, not its edge's") {
    // 8e-13 wide and 1 deep: x = 3e-15 cannot be told from the edge x = 0, the depth there can
    const Mesh steep{{{0, -1, 0}, {0, 1, 0}, {8e-13, 0, 1}}, {{0, 1, 2}}};
    const double x = 3e-15, depth = x / 8e-13;
    CHECK(hits(steep, {x, 0, 1}, {x, 0, 0.9 * depth}));
    CHECK_FALSE(hits(steep, {x, 0, 1}, {x, 0, 2.0 * depth}));
    CHECK(hits(steep, {x, 0, -1}, {x, 0, 1.1 * depth}));
}

TEST_CASE("box tree: a power of two as unit changes no answer") {
    Random random{std::mt19937_64(13)};
    Mesh mesh = crumpled_ball(random, 8, 12), large = mesh;
    const double unit = 1024.0; // exact, so that both meshes are the same one
    for (dvec3& v : large.vertex)
        v *= unit;
    for (int i = 0; i < 500; ++i) {
        const dvec3 from = random.place(1.2), to = random.one_of(mesh.vertex);
        CHECK(hits(mesh, from, to) == hits(large, unit * from, unit * to));
        const dvec3 short_of = from + 0.999 * (to - from);
        CHECK(hits(mesh, from, short_of) == hits(large, unit * from, unit * short_of));
    }
}

TEST_CASE("box tree: a thousand metres away the answers are the same") {
    Random random{std::mt19937_64(17)};
    const double mm = 1e-3;
    const dvec3 away{1000.0, -1000.0, 1000.0};
    Mesh near = crumpled_ball(random, 8, 12);
    for (dvec3& v : near.vertex)
        v *= mm;
    Mesh far = near;
    for (dvec3& v : far.vertex)
        v += away;
    int hit = 0, missed = 0;
    for (int i = 0; i < 1000; ++i) {
        const dvec3 from = mm * random.place(1.2), to = mm * random.place(1.2);
        bool clear_cut = true; // by more than the 1e-13 m that coordinates there are rounded by
        const int expected = brute_force(near, from, to);
        for (int k = 0; k < 6; ++k) {
            const dvec3 aside = random.place(1e-11);
            clear_cut &= brute_force(near, from + aside, to + aside) == expected;
        }
        if (expected == 0 || !clear_cut)
            continue;
        CHECK(hits(far, from + away, to + away) == (expected > 0));
        ++(expected > 0 ? hit : missed);
    }
    CHECK(hit > 100);
    CHECK(missed > 100);
}

TEST_CASE("box tree: an empty mesh and what is not finite meet nothing") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    CHECK_FALSE(hits({}, {0, 0, 1}, {0, 0, -1}));
    const std::vector<dvec3> none;
    BoxTree empty = haptics::make_box_tree(none, {});
    haptics::refit(empty, none);

    Mesh two{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {9, -1, 0}, {11, -1, 0}, {10, 1, 0}},
             {{0, 1, 2}, {3, 4, 5}}};
    BoxTree tree = haptics::make_box_tree(two.vertex, two.triangle);
    for (const double bad : {nan, inf, -inf}) {
        const dvec3 kept = two.vertex[1];
        CHECK_FALSE(haptics::segment_hits(tree, two.vertex, {0, bad, 1}, {0, 0, -1}));
        CHECK_FALSE(haptics::segment_hits(tree, two.vertex, {0, 0, 1}, {0, 0, bad}));
        for (int axis = 0; axis < 3; ++axis) {
            two.vertex[1][axis] = bad;
            haptics::refit(tree, two.vertex);
            CHECK_FALSE(haptics::segment_hits(tree, two.vertex, {0, 0, 1}, {0, 0, -1}));
            CHECK_FALSE(haptics::segment_hits(tree, two.vertex, {-1, -1, 1}, {-1, -1, -1}));
            CHECK(haptics::segment_hits(tree, two.vertex, {10, 0, 1}, {10, 0, -1}));
            two.vertex[1] = kept;
        }
    }
    haptics::refit(tree, two.vertex);
    CHECK(haptics::segment_hits(tree, two.vertex, {0, 0, 1}, {0, 0, -1}));
}

TEST_CASE("box tree: bad meshes are refused at setup") {
    Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}};
    CHECK_THROWS_AS(haptics::make_box_tree(mesh.vertex, mesh.triangle), std::invalid_argument);
    mesh.triangle = {{0, 1, 2}};
    mesh.vertex[1].y = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(haptics::make_box_tree(mesh.vertex, mesh.triangle),
                         "box tree: vertex 1 is not finite", std::invalid_argument);
}

TEST_CASE("box tree: the same mesh gives the same tree, also if all centres are one") {
    const Mesh same{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<Triangle>(1000, {0, 1, 2})};
    const BoxTree tree = haptics::make_box_tree(same.vertex, same.triangle);
    CHECK(tree.box.size() < 1000);
    CHECK(haptics::segment_hits(tree, same.vertex, {0.2, 0.2, 1}, {0.2, 0.2, -1}));
    Random random{std::mt19937_64(19)};
    const Mesh ball = crumpled_ball(random, 12, 12);
    const BoxTree one = haptics::make_box_tree(ball.vertex, ball.triangle);
    CHECK(one.triangle == haptics::make_box_tree(ball.vertex, ball.triangle).triangle);
}
