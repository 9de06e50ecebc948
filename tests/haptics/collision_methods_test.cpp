// tests/haptics/collision_methods_test.cpp
// Every method of collision beside brute force, on meshes that move and degenerate.
#include "haptics/collision/index.h"
#include "haptics/collision/witness.h"
#include "tests/haptics/collision_meshes.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>
#include <rapidcheck.h>
#include <thread>

namespace {

using glm::dvec3;
using haptics::CollisionIndex;
using haptics::MeshView;
using haptics::SurfaceHit;
using haptics::SweepHit;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

double largest(const CollisionMesh& mesh) {
    double out = 0.0;
    for (const auto* places : {&mesh.vertex, &mesh.before})
        for (const dvec3& v : *places)
            out = std::max({out, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return out;
}

// What every method is asked, so that answers can be laid side by side.
struct Question {
    dvec3 from_m, to_m, from_before_m, to_before_m;
    double radius_m;
};

struct Answer {
    SurfaceHit closest, cast;
    SweepHit ball, shaft;
    std::vector<SurfaceHit> contact;
};

Question any_question(CollisionRandom& random, const CollisionMesh& mesh) {
    const dvec3 near = mesh.vertex[random.below(mesh.vertex.size())];
    const auto place = [&] { return near + random.place(random.power(-5.0, 0.3)); };
    Question q{place(), place(), place(), place(), random.power(-5.0, 0.0)};
    if (random.below(4) == 0)
        q.to_m = q.from_m;
    if (random.below(4) == 0)
        q.radius_m = 0.0;
    return q;
}

Answer ask(const CollisionIndex& index, const MeshView& mesh, const Question& q) {
    Answer out{.closest = closest_within(index, mesh, q.from_m, q.radius_m),
               .cast = cast_segment(index, mesh, q.from_m, q.to_m),
               .ball = sweep_sphere(index, mesh, q.from_m, q.to_m, q.radius_m),
               .shaft = sweep_shaft(index, mesh, {q.from_before_m, q.to_before_m, q.from_m, q.to_m},
                                    q.radius_m),
               .contact = std::vector<SurfaceHit>(mesh.triangle.size())};
    const std::size_t all =
        contacts_within(index, mesh, q.from_m, q.radius_m, std::span<SurfaceHit>(out.contact));
    out.contact.resize(std::min(all, mesh.triangle.size()));
    return out;
}

template <class Hit> bool same(const Hit& a, const Hit& b, double a_at, double b_at, double slack) {
    return a.hit() == b.hit() && (!a.hit() || std::abs(a_at - b_at) <= slack);
}

// Equal to the rounding of places that is stated; the same triangle unless they tie within it.
void check_same(const Answer& a, const Answer& b, double rounding, double time_rounding) {
    RC_ASSERT(same(a.closest, b.closest, a.closest.distance_m, b.closest.distance_m, rounding));
    RC_ASSERT(same(a.cast, b.cast, a.cast.distance_m, b.cast.distance_m, rounding));
    RC_ASSERT(same(a.ball, b.ball, a.ball.time, b.ball.time, time_rounding));
    RC_ASSERT(same(a.shaft, b.shaft, a.shaft.time, b.shaft.time, time_rounding));
    RC_ASSERT(a.contact.size() == b.contact.size());
    for (std::size_t i = 0; i < a.contact.size(); ++i)
        RC_ASSERT(std::abs(a.contact[i].distance_m - b.contact[i].distance_m) <= rounding);
}

} // namespace

TEST_CASE("collision: every method gives the answers of brute force, at rest and moving") {
    CHECK(rc::check([] {
        CollisionRandom random{std::mt19937_64(*rc::gen::arbitrary<std::uint32_t>())};
        const double unit = *rc::gen::element(1.0, 1e3, 0x1p-40);
        CollisionMesh mesh = any_mesh(random);
        const dvec3 at = random.place(1.0) * *rc::gen::element(0.0, 1.0, 1e3);
        for (dvec3& v : mesh.vertex)
            v = unit * (v + at);
        std::vector<CollisionIndex> index;
        for (const std::string_view name : haptics::kCollisionNames)
            index.push_back(haptics::make_index(name, mesh.view()));
        for (int pass = 0; pass < 3; ++pass) {
            for (int i = 0; i < 6; ++i) {
                Question q = any_question(random, mesh);
                q.radius_m *= unit;
                const Answer expected = ask(index[0], mesh.view(), q);
                for (std::size_t m = 1; m < index.size(); ++m) {
                    const Answer got = ask(index[m], mesh.view(), q);
                    RC_LOG() << haptics::kCollisionNames[m] << "\n";
                    // they measure the same triangles with the same code: not one bit differs
                    check_same(got, expected, 0.0, 0.0);
                    RC_ASSERT(got.closest.triangle == expected.closest.triangle);
                    RC_ASSERT(got.cast.triangle == expected.cast.triangle);
                    RC_ASSERT(got.ball.triangle == expected.ball.triangle);
                    RC_ASSERT(got.shaft.triangle == expected.shaft.triangle);
                }
            }
            move(random, mesh);
            if (pass == 1) // in the unit of the mesh, and far enough to leave all cells
                for (dvec3& v : mesh.vertex)
                    v *= 1.7;
            for (CollisionIndex& i : index)
                refit(i, mesh.view());
        }
    }));
}

TEST_CASE("collision: metres or millimetres, here or 1000 m away, the answers are the same") {
    CHECK(rc::check([] {
        CollisionRandom random{std::mt19937_64(*rc::gen::arbitrary<std::uint32_t>())};
        CollisionMesh near = any_mesh(random);
        const auto round = [](dvec3 v) { // so that 1000 m can be added without rounding
            for (int k = 0; k < 3; ++k)
                v[k] = std::round(v[k] * 0x1p30) * 0x1p-30;
            return v;
        };
        for (dvec3& v : near.vertex)
            v = round(v);
        move(random, near);
        for (dvec3& v : near.vertex)
            v = round(v);
        Question q = any_question(random, near);
        q.from_m = round(q.from_m);
        q.to_m = round(q.to_m);
        const double away_m = *rc::gen::element(0.0, 1.0, 1000.0);
        const double unit = *rc::gen::element(1.0, 1000.0);
        const auto put = [&](const dvec3& v) {
            return unit * (v + dvec3{away_m, -away_m, away_m});
        };
        CollisionMesh far = near;
        for (auto* places : {&far.vertex, &far.before})
            for (dvec3& v : *places)
                v = put(v);
        // nearest points are off by 16 roundings of the coordinates (triangle_test.cpp)
        const double rounding = 16.0 * kEpsilon * std::max(largest(far) / unit, 10.0);
        for (const std::string_view name : haptics::kCollisionNames) {
            const CollisionIndex a = haptics::make_index(name, near.view()),
                                 b = haptics::make_index(name, far.view());
            const SurfaceHit here = closest_within(a, near.view(), q.from_m, 1.0),
                             there = closest_within(b, far.view(), put(q.from_m), unit);
            if (std::abs(here.distance_m - 1.0) > rounding)
                RC_ASSERT(same(here, there, here.distance_m, there.distance_m / unit, rounding));
            // a cast is early by 64 roundings over the cosine: compare how near it gets, and that
            // whatever it meets there is met here by a segment longer by as much
            const SurfaceHit cast = cast_segment(a, near.view(), q.from_m, q.to_m);
            const SurfaceHit cast_there = cast_segment(b, far.view(), put(q.from_m), put(q.to_m));
            if (cast.hit() && cast_there.hit() && cast.triangle == cast_there.triangle) {
                const auto on =
                    haptics::nearest_on_triangle(near.view().corners(cast.triangle), q.from_m);
                const double sine = std::sqrt(on.distance2_m2) / std::max(cast.distance_m, 1e-300);
                RC_ASSERT(std::abs(cast.distance_m - cast_there.distance_m / unit) <=
                          8.0 * rounding / std::max(sine, 1e-300));
            }
        }
    }));
}

TEST_CASE("collision: a sweep over a moving mesh is never late, and early by the gap at most") {
    CHECK(rc::check([] {
        CollisionRandom random{std::mt19937_64(*rc::gen::arbitrary<std::uint32_t>())};
        CollisionMesh mesh = any_mesh(random);
        std::vector<CollisionIndex> index;
        for (const std::string_view name : haptics::kCollisionNames)
            index.push_back(haptics::make_index(name, mesh.view()));
        move(random, mesh);
        for (CollisionIndex& i : index)
            refit(i, mesh.view());
        Question q = any_question(random, mesh);
        q.radius_m = random.power(-4.0, -0.5);
        std::vector<dvec3> between(mesh.vertex.size());
        const auto distance = [&](double time) { // independent of sweeps: all triangles, one time
            for (std::size_t v = 0; v < between.size(); ++v)
                between[v] = mesh.before[v] + time * (mesh.vertex[v] - mesh.before[v]);
            const MeshView then{between, mesh.triangle, {}};
            return closest_within(haptics::make_brute_force(then), then,
                                  q.from_m + time * (q.to_m - q.from_m), 1e3)
                .distance_m;
        };
        const double gap = haptics::kSweepGap * q.radius_m + 1e-13;
        if (distance(0.0) < q.radius_m + gap)
            return; // in touch from the start: triangle_test.cpp
        double first = 2.0;
        constexpr int kTimes = 300;
        for (int i = 0; i <= kTimes && first > 1.0; ++i)
            if (distance(double(i) / kTimes) < q.radius_m - 2.0 * gap)
                first = double(i) / kTimes;
        for (const CollisionIndex& i : index) {
            const SweepHit hit = sweep_sphere(i, mesh.view(), q.from_m, q.to_m, q.radius_m);
            RC_ASSERT(hit.time <= first);
            if (hit.hit())
                RC_ASSERT(distance(hit.time) <= q.radius_m + gap);
        }
    }));
}

TEST_CASE("collision: the witness changes no answer, wherever the last one was") {
    CHECK(rc::check([] {
        CollisionRandom random{std::mt19937_64(*rc::gen::arbitrary<std::uint32_t>())};
        CollisionMesh mesh = any_mesh(random);
        const haptics::Neighbours neighbours = haptics::make_neighbours(mesh.view());
        for (const std::string_view name : haptics::kCollisionNames) {
            CollisionIndex index = haptics::make_index(name, mesh.view());
            haptics::Witness last{neighbours}, last_cast{neighbours};
            dvec3 at = random.place(1.0);
            for (int i = 0; i < 60; ++i) {
                const dvec3 to = i % 20 == 0 ? random.place(1.0) : at + random.place(0.05);
                const double radius = random.power(-3.0, 0.5);
                if (i == 30) {
                    move(random, mesh);
                    refit(index, mesh.view());
                }
                const SurfaceHit plain = closest_within(index, mesh.view(), to, radius);
                const SurfaceHit cast = cast_segment(index, mesh.view(), at, to);
                std::visit(
                    [&](const auto& method) {
                        const SurfaceHit closest =
                            closest_within_cached(method, mesh.view(), to, radius, last);
                        RC_ASSERT(closest.triangle == plain.triangle);
                        RC_ASSERT(closest.distance_m == plain.distance_m);
                        const SurfaceHit again =
                            cast_segment_cached(method, mesh.view(), at, to, last_cast);
                        RC_ASSERT(again.triangle == cast.triangle);
                        RC_ASSERT(again.place_m == cast.place_m);
                    },
                    index);
                at = to;
            }
        }
    }));
}

TEST_CASE("collision: a mesh blown up, flattened or turned to points is still found") {
    CollisionRandom random{std::mt19937_64(31)};
    const CollisionMesh rest = height_field(random, 12);
    for (const std::string_view name : haptics::kCollisionNames) {
        CAPTURE(name);
        CollisionMesh mesh = rest;
        CollisionIndex index = haptics::make_index(name, mesh.view());
        const haptics::BruteForce all = haptics::make_brute_force(mesh.view());
        const auto check = [&] {
            refit(index, mesh.view());
            for (int i = 0; i < 50; ++i) {
                const dvec3 from = random.place(3.0), to = random.place(3.0);
                CHECK(closest_within(index, mesh.view(), from, 1e9).triangle ==
                      closest_within(all, mesh.view(), from, 1e9).triangle);
                CHECK(cast_segment(index, mesh.view(), from, to).triangle ==
                      cast_segment(all, mesh.view(), from, to).triangle);
            }
        };
        for (dvec3& v : mesh.vertex) // every triangle as large as the mesh
            v = random.place(2.0);
        check();
        for (dvec3& v : mesh.vertex)
            v.z = 0.0;
        check();
        mesh.vertex[7] = {1e6, -1e6, 1e6}; // one corner far away
        check();
        for (dvec3& v : mesh.vertex)
            v = {1.0, 2.0, 3.0};
        check();
    }
}

TEST_CASE("collision: without triangles, or not finite, nothing is met and the rest still is") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    for (const std::string_view name : haptics::kCollisionNames) {
        CAPTURE(name);
        CollisionMesh none;
        CollisionIndex empty = haptics::make_index(name, none.view());
        refit(empty, none.view());
        CHECK_FALSE(closest_within(empty, none.view(), {0, 0, 0}, 1.0).hit());

        CollisionRandom random{std::mt19937_64(37)};
        CollisionMesh mesh = height_field(random, 8);
        CollisionIndex index = haptics::make_index(name, mesh.view());
        for (const double bad : {nan, inf, -inf}) {
            CHECK_FALSE(closest_within(index, mesh.view(), {0, bad, 0}, 1.0).hit());
            CHECK_FALSE(cast_segment(index, mesh.view(), {0, bad, 0}, {0, 0, -1}).hit());
            CHECK_FALSE(cast_segment(index, mesh.view(), {0, 0, 1}, {0, 0, bad}).hit());
            CHECK_FALSE(sweep_sphere(index, mesh.view(), {0, bad, 0}, {0, 0, -1}, 0.1).hit());
            const dvec3 kept = mesh.vertex[0];
            mesh.vertex[0].y = bad;
            refit(index, mesh.view());
            CHECK(cast_segment(index, mesh.view(), {0.5, 0.5, 1}, {0.5, 0.5, -1}).hit());
            CHECK(closest_within(index, mesh.view(), {0.5, 0.5, 1}, 5.0).hit());
            mesh.vertex[0] = kept;
        }
        refit(index, mesh.view());
        CHECK(cast_segment(index, mesh.view(), {0.9, 0.9, 1}, {0.9, 0.9, -1}).hit());
    }
    CHECK_THROWS_AS(haptics::make_index("sphere-tree", {}), std::invalid_argument);
}

TEST_CASE("collision: one copy is read while the other is refitted") {
    CollisionRandom random{std::mt19937_64(41)};
    const CollisionMesh first = ball(random, 16);
    for (const std::string_view name : haptics::kCollisionNames) {
        CAPTURE(name);
        CollisionMesh mesh[2] = {first, first};
        CollisionIndex index[2] = {haptics::make_index(name, first.view()), CollisionIndex{}};
        index[1] = index[0];
        for (int swap = 0; swap < 10; ++swap) {
            const int front = swap % 2, back = 1 - front;
            const auto read = [&](int seed, int& wrong) {
                CollisionRandom r{std::mt19937_64(static_cast<unsigned>(seed))};
                const MeshView view = mesh[front].view();
                const haptics::BruteForce all = haptics::make_brute_force(view);
                for (int i = 0; i < 30; ++i) {
                    const dvec3 from = r.place(1.5);
                    wrong += closest_within(index[front], view, from, 2.0).distance_m !=
                             closest_within(all, view, from, 2.0).distance_m;
                }
            };
            int wrong[2] = {0, 0};
            std::thread one(read, swap, std::ref(wrong[0]));
            std::thread two(read, swap + 100, std::ref(wrong[1]));
            for (std::size_t v = 0; v < first.vertex.size(); ++v)
                mesh[back].vertex[v] = first.vertex[v] + random.place(0.1);
            refit(index[back], mesh[back].view());
            one.join();
            two.join();
            CHECK(wrong[0] + wrong[1] == 0);
        }
    }
}
