// tests/haptics/carried_point_test.cpp
// Contact points under tips as round as the skin is curved: carry() ends at the foot of the tip,
// where a whole slip goes past it and comes back as far.
#include "haptics/contact/carried_point.h"

#include "tests/haptics/walk_meshes.h"

#include <cmath>
#include <doctest/doctest.h>
#include <rapidcheck.h>

namespace {

using haptics::SurfacePlace;
using haptics::SurfacePoint;
using haptics::WalkResult;
using namespace walk_tests;

// A mesh with a normal at each vertex, mixed between them as both loops do.
struct Skin {
    Mesh mesh;
    std::vector<glm::dvec3> normal;

    explicit Skin(Mesh m) : mesh(std::move(m)), normal(mesh.vertex.size(), glm::dvec3{0.0}) {
        for (const auto& t : mesh.triangle) {
            const glm::dvec3 a = mesh.vertex[t[0]];
            const glm::dvec3 twice_area = glm::cross(mesh.vertex[t[1]] - a, mesh.vertex[t[2]] - a);
            for (const int v : t)
                normal[v] += twice_area;
        }
        for (glm::dvec3& n : normal)
            n = glm::normalize(n);
    }
    SurfacePlace operator()(const SurfacePoint& at) const {
        const auto& t = mesh.triangle[at.triangle];
        glm::dvec3 n{0.0};
        for (int k = 0; k < 3; ++k)
            n += at.weight[k] * normal[t[k]];
        return {mesh.at(at), glm::normalize(n)};
    }
};

// Radius 1 about the x axis, `length` long, open ends; triangle 0 is at angle 0 in y, z.
Mesh cylinder_mesh(int around, int along, double length) {
    Mesh m;
    for (int i = 0; i <= along; ++i)
        for (int j = 0; j < around; ++j) {
            const double angle = 2.0 * M_PI * (j + 0.5 * (i % 2)) / around;
            m.vertex.push_back({length * (static_cast<double>(i) / along - 0.5), std::sin(angle),
                                std::cos(angle)});
        }
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
            const int a = i * around + j, b = i * around + (j + 1) % around;
            const int c = a + around, d = b + around;
            if (i % 2 == 0) {
                m.triangle.push_back({a, c, b});
                m.triangle.push_back({b, c, d});
            } else {
                m.triangle.push_back({a, c, d});
                m.triangle.push_back({a, d, b});
            }
        }
    m.connect();
    return m;
}

// What both loops carry a free point by: the whole tangential offset of the tip.
glm::dvec3 slip_to(const SurfacePlace& from, const glm::dvec3& tip) {
    const glm::dvec3 out = tip - from.place_m;
    return out - glm::dot(out, from.normal) * from.normal;
}

struct Arrival {
    double first = 0.0, third = 0.0; // offset of the tip after calls, as a share of the first slip
    bool on_far_side = false;        // at some time, of where the tip's foot is
};

template <class Carry>
Arrival three_calls(const Skin& skin, SurfacePoint at, const glm::dvec3& tip,
                    const glm::dvec3& foot_normal, Carry carry) {
    Arrival out;
    const double slip = glm::length(slip_to(skin(at), tip));
    for (int call = 0; call < 3; ++call) {
        at = carry(at, slip_to(skin(at), tip)).point;
        const SurfacePlace now = skin(at);
        out.third = glm::length(slip_to(now, tip)) / slip;
        if (call == 0)
            out.first = out.third;
        out.on_far_side = out.on_far_side || glm::dot(now.normal, foot_normal) < 0.0;
    }
    return out;
}

struct Round {
    Arrival carried, walked;
};

Round round(const Skin& skin, const SurfacePoint& from, const glm::dvec3& tip,
            const glm::dvec3& foot_normal) {
    return {three_calls(skin, from, tip, foot_normal,
                        [&](const SurfacePoint& at, const glm::dvec3& slip) {
                            return haptics::carry(skin.mesh, skin, at, slip, tip);
                        }),
            three_calls(skin, from, tip, foot_normal,
                        [&](const SurfacePoint& at, const glm::dvec3& slip) {
                            return haptics::walk(skin.mesh, at, slip);
                        })};
}

SurfacePoint find_near(const Skin& skin, const glm::dvec3& place) {
    int nearest = 0;
    const auto away = [&](int t) {
        return glm::distance(skin.mesh.at({t, glm::dvec3{1.0 / 3.0}}), place);
    };
    for (int t = 1; t < static_cast<int>(skin.mesh.triangle.size()); ++t)
        nearest = away(t) < away(nearest) ? t : nearest;
    return {nearest, glm::dvec3{1.0 / 3.0}};
}

// Somewhere on the skin, in a triangle whose first corner is within 1 of the middle.
SurfacePoint start_on(const Skin& skin) {
    const int triangles = static_cast<int>(skin.mesh.triangle.size());
    int t = *rc::gen::inRange(0, triangles);
    while (std::abs(skin.mesh.position(t, 0).x) > 1.0)
        t = (t + 1) % triangles;
    const double w = 0.8 * *rc::gen::inRange(0, 1001) * 1e-3;
    return {t, {w, 0.2, 0.8 - w}};
}

double random_in(double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 1000001) * 1e-6;
}

} // namespace

// Tips from a third of the skin's radius, where a whole slip begins to go too far, to three times
// it. Facets of 0.13 rad, so slips from 0.3 rad on: the mixed normal is no circle's between them.
TEST_CASE("carried point: across a cylinder it ends at the foot of the tip, in one call nearly") {
    const Skin tube(cylinder_mesh(48, 60, 8.0));
    CHECK(rc::check([&tube] {
        const SurfacePoint from = start_on(tube);
        const glm::dvec3 place = tube.mesh.at(from);
        const glm::dvec3 out = glm::normalize(glm::dvec3{0.0, place.y, place.z});
        const double tip_radius = random_in(0.3, 3.0), turn = random_in(0.3, 1.5);
        const glm::dvec3 foot_normal =
            std::cos(turn) * out + std::sin(turn) * glm::cross(glm::dvec3{1, 0, 0}, out);
        const glm::dvec3 tip = glm::dvec3{place.x, 0, 0} + (1.0 + tip_radius) * foot_normal;
        const Round r = round(tube, from, tip, foot_normal);
        RC_ASSERT(!r.carried.on_far_side);
        RC_ASSERT(r.carried.first < 0.4);
        RC_ASSERT(r.carried.third < 0.03);
        if (tip_radius > 1.7 && turn < 1.0) // there a whole slip is thrown about
            RC_ASSERT(r.walked.third > 0.3);
    }));
}

TEST_CASE("carried point: over a sphere it ends at the foot of the tip, in one call nearly") {
    const Skin ball(sphere_mesh(4));
    CHECK(rc::check([&ball] {
        const SurfacePoint from = start_on(ball);
        const glm::dvec3 out = glm::normalize(ball.mesh.at(from));
        const glm::dvec3 side =
            glm::normalize(glm::cross(out, {random_in(-1, 1), random_in(-1, 1), 0.7}));
        const double tip_radius = random_in(0.3, 3.0), turn = random_in(0.05, 1.5);
        const glm::dvec3 foot_normal = std::cos(turn) * out + std::sin(turn) * side;
        const Round r = round(ball, from, (1.0 + tip_radius) * foot_normal, foot_normal);
        RC_ASSERT(!r.carried.on_far_side);
        RC_ASSERT(r.carried.first < 0.4);
        RC_ASSERT(r.carried.third < 0.01);
        if (tip_radius > 1.7 && turn < 1.0)
            RC_ASSERT(r.walked.third > 0.3);
    }));
}

TEST_CASE("carried point: on a flat mesh it is the walk, to the last bit") {
    CHECK(rc::check([] {
        const Skin flat(flat_mesh(*rc::gen::arbitrary<std::uint32_t>(), 6, 0.3));
        const SurfacePoint from = find(flat.mesh, {random_in(0.1, 0.9), random_in(0.1, 0.9), 0.0});
        const glm::dvec3 tip{random_in(0.1, 0.9), random_in(0.1, 0.9), random_in(0.0, 0.3)};
        const double share = random_in(0.05, 1.0); // friction keeps the rest
        const glm::dvec3 slip = share * slip_to(flat(from), tip);
        const WalkResult whole = haptics::walk(flat.mesh, from, slip);
        const WalkResult r = haptics::carry(flat.mesh, flat, from, slip, tip);
        RC_ASSERT(r.point.triangle == whole.point.triangle);
        RC_ASSERT(r.point.weight == whole.point.weight);
        RC_ASSERT(r.at_rim == whole.at_rim);
    }));
}

TEST_CASE("carried point: what friction keeps on a cylinder is kept, to a tenth of the slip") {
    const Skin tube(cylinder_mesh(48, 60, 8.0));
    CHECK(rc::check([&tube] {
        const SurfacePoint from = start_on(tube);
        const SurfacePlace start = tube(from);
        const glm::dvec3 out = glm::normalize(glm::dvec3{0.0, start.place_m.y, start.place_m.z});
        const double turn = random_in(0.4, 1.0);
        const glm::dvec3 tip =
            glm::dvec3{start.place_m.x, 0, 0} +
            2.5 * (std::cos(turn) * out + std::sin(turn) * glm::cross(glm::dvec3{1, 0, 0}, out));
        const glm::dvec3 whole = slip_to(start, tip);
        const double share = random_in(0.2, 0.9);
        const WalkResult r = haptics::carry(tube.mesh, tube, from, share * whole, tip);
        const double kept = glm::length(slip_to(tube(r.point), tip));
        RC_ASSERT(std::abs(kept - (1.0 - share) * glm::length(whole)) <
                  0.13 * share * glm::length(whole)); // a little is across the way
    }));
}

TEST_CASE("carried point: over the edge of a sheet it stays where the tip is") {
    // upper and lower face of a sheet 2 thick, joined by a round edge of radius 1: the flap's edge
    const Skin sheet([] {
        Mesh m = cylinder_mesh(48, 60, 8.0);
        for (glm::dvec3& v : m.vertex)
            v.y = v.y < -1e-9 ? v.y - 6.0 : v.y; // the far half stands back
        return m;
    }());
    for (const double tip_radius : {0.5, 1.5, 3.0})
        for (const double turn : {0.2, 0.8, 1.4}) { // of the foot, round the edge from the top
            CAPTURE(tip_radius);
            CAPTURE(turn);
            const SurfacePoint from = find_near(sheet, {0.1, -0.5, 1.0});
            const glm::dvec3 foot_normal{0.0, std::sin(turn), std::cos(turn)};
            const glm::dvec3 tip = glm::dvec3{0.1, 0.0, 0.0} + (1.0 + tip_radius) * foot_normal;
            const Round r = round(sheet, from, tip, foot_normal);
            CHECK_FALSE(r.carried.on_far_side);
            CHECK(r.carried.third < 0.03);
        }
}

TEST_CASE("carried point: absurd slips, tips and corners leave the point on the surface") {
    Mesh mesh = sphere_mesh(3);
    const SurfacePoint start{5, {0.3, 0.3, 0.4}};
    const double nan = std::nan("");
    {
        const Skin ball(mesh);
        const glm::dvec3 tip = 2.0 * ball(start).place_m;
        for (const double bad : {nan, HUGE_VAL, -1e300, 1e5, 1e-320})
            CHECK(sound(haptics::carry(mesh, ball, start, {bad, 0.1, 0.0}, tip).point));
        for (const double bad : {nan, HUGE_VAL, -1e300, 1e5})
            CHECK(sound(haptics::carry(mesh, ball, start, {0.0, 0.1, 0.0}, {bad, 0, 0}).point));
        const WalkResult none = haptics::carry(mesh, ball, start, glm::dvec3{0.0}, tip);
        CHECK(none.point.weight == start.weight);
    }
    for (glm::dvec3& v : mesh.vertex)
        v.y = v.x < 0.6 ? v.y : nan;
    const Skin broken(mesh);
    CHECK(sound(haptics::carry(mesh, broken, start, {0.5, 0.1, 0.0}, {0.0, 2.0, 0.0}).point));
}
