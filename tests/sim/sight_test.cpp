// What the endoscope sees of a marker, mostly on bodies made by hand. This program counts
// allocations.
#include "sim/bridge/sight.h"

#include "sim/check/solid.h"

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>
#include <new>
#include <numbers>
#include <random>

namespace {

std::atomic<int> allocations{0};

void* counted(std::size_t size) {
    ++allocations;
    if (void* p = std::malloc(size > 0 ? size : 1))
        return p;
    throw std::bad_alloc{};
}

} // namespace

void* operator new(std::size_t size) {
    return counted(size);
}
void* operator new[](std::size_t size) {
    return counted(size);
}
void operator delete(void* p) noexcept {
    std::free(p);
}
void operator delete[](void* p) noexcept {
    std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
    std::free(p);
}
void operator delete[](void* p, std::size_t) noexcept {
    std::free(p);
}

namespace {

using glm::dvec3;

// One tetrahedron: nobody looks at it, but a soft body has tissue.
sim::SoftBody some_tissue() {
    const tissue::TetMesh mesh{{{0, 0, 0}, {1e-2, 0, 0}, {0, 1e-2, 0}, {0, 0, 1e-2}},
                               {{0, 1, 2, 3}}};
    const std::array<std::uint8_t, 4> anchored{1, 0, 0, 0};
    return {.solid = tissue::make_solid(tissue::Tier::corotated, {mesh, anchored, {}}, {},
                                        dvec3{0.0}, 1e-2),
            .basis = {},
            .skin_frame = {}};
}

sim::Body body_of(std::vector<dvec3> vertex_m, std::vector<tissue::Triangle> triangles,
                  bool soft = false) {
    auto organ = std::make_shared<tissue::BakedOrgan>();
    organ->rigid = !soft;
    organ->surface.rest_m = vertex_m;
    organ->surface.triangles = std::move(triangles);
    sim::Body body;
    body.organ = std::move(organ);
    body.skin_m = std::move(vertex_m);
    if (soft)
        body.soft.emplace(some_tissue());
    return body;
}

/// centre +- u +- v
sim::Body plate(const dvec3& centre_m, const dvec3& u_m, const dvec3& v_m, bool soft = false) {
    return body_of(
        {centre_m - u_m - v_m, centre_m + u_m - v_m, centre_m + u_m + v_m, centre_m - u_m + v_m},
        {{0, 1, 2}, {0, 2, 3}}, soft);
}

/// A grid of vertices wrapped around; `place`: of an angle, and 0 to 1 along the axis. At the
/// poles of a ball all the vertices of a row are one, and triangles without area close it.
template <typename Place>
sim::Body rounded(std::uint32_t around, std::uint32_t rows, const Place& place) {
    std::vector<dvec3> vertex_m;
    std::vector<tissue::Triangle> triangles;
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            vertex_m.push_back(place(2.0 * std::numbers::pi * i / around, j / (rows - 1.0)));
            if (j + 1 == rows)
                continue;
            const std::uint32_t a = j * around + i, b = j * around + (i + 1) % around;
            triangles.push_back({a, b, b + around});
            triangles.push_back({a, b + around, a + around});
        }
    }
    return body_of(std::move(vertex_m), std::move(triangles));
}

sim::Body ball(const dvec3& centre_m, double radius_m) {
    return rounded(24, 13, [&](double phi, double along) {
        const double theta = std::numbers::pi * along;
        return centre_m + radius_m * dvec3{std::sin(theta) * std::cos(phi),
                                           std::sin(theta) * std::sin(phi), std::cos(theta)};
    });
}

// One at the origin that faces up, and an endoscope above it.
constexpr double kRadius_m = 3e-3;
const sim::Marker kMarker{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, kRadius_m};
const dvec3 kEye_m{0.0, 0.0, 0.1}, kPort_m{0.06, 0.0, 0.18};
const dvec3 kAlong_m{0.03, 0.0, 0.0}, kAcross_m{0.0, 0.03, 0.0}; // half a plate

int seen(std::span<const sim::Body> bodies, const dvec3& port_m = kPort_m,
         const dvec3& eye_m = kEye_m, const sim::Marker& marker = kMarker) {
    return sim::clear_rays(sim::make_sight(bodies), bodies, port_m, eye_m, marker);
}

int seen(const sim::Body& body, const dvec3& port_m = kPort_m, const dvec3& eye_m = kEye_m,
         const sim::Marker& marker = kMarker) {
    return seen(std::span{&body, 1}, port_m, eye_m, marker);
}

} // namespace

TEST_CASE("sight: all of a marker is seen past nothing, past what is beside it or below") {
    CHECK(seen(std::span<const sim::Body>{}) == sim::kSightRays);
    CHECK(seen(plate({-0.04, 0.0, 0.05}, kAlong_m, kAcross_m)) == sim::kSightRays);
    CHECK(seen(plate({0.0, 0.0, -1e-3}, kAlong_m, kAcross_m)) == sim::kSightRays);
    CHECK(seen(plate({0.0, 0.0, 0.0}, kAlong_m, kAcross_m)) == sim::kSightRays); // its own skin
}

TEST_CASE("sight: nothing is seen behind a plate, from either side, wherever it stands") {
    for (const double height_m : {0.001, 0.05, 0.099}) {
        CHECK(seen(plate({0.0, 0.0, height_m}, kAlong_m, kAcross_m)) == 0);
        CHECK(seen(plate({0.0, 0.0, height_m}, kAcross_m, kAlong_m)) == 0);
    }
    CHECK(seen(plate({0.0, 0.0, 0.101}, {1e-3, 0, 0}, {0, 1e-3, 0}), kEye_m) == sim::kSightRays);
}

TEST_CASE("sight: an edge across the middle hides three of the ring's six, and the centre if it "
          "reaches past it") {
    // of two opposite places on the ring a line through the centre leaves one on each side
    const double height_m = 0.05;
    const double past_m = 0.01 * kRadius_m;
    for (int degree = 2; degree < 360; degree += 5) { // no multiple of 30 is within a degree
        const double angle = degree * std::numbers::pi / 180.0;
        const dvec3 out{std::cos(angle), std::sin(angle), 0.0};
        const dvec3 along = 0.04 * dvec3{-out.y, out.x, 0.0};
        for (const double edge_m : {-past_m, past_m}) {
            const dvec3 centre_m = (edge_m + 0.02) * out + dvec3{0.0, 0.0, height_m};
            CHECK(seen(plate(centre_m, 0.02 * out, along), kEye_m) == (edge_m > 0.0 ? 4 : 3));
        }
    }
}

TEST_CASE("sight: a hole as large as 0.7 of the marker shows the centre alone, of 0.9 all") {
    // a square frame at half the height shows twice its opening; the ring is at 0.8
    const double height_m = 0.05;
    const auto frame = [&](double opening_m) {
        const double wide_m = 0.02;
        std::vector<sim::Body> bars;
        for (const dvec3& out : {dvec3{1, 0, 0}, dvec3{-1, 0, 0}, dvec3{0, 1, 0}, dvec3{0, -1, 0}})
            bars.push_back(plate(dvec3{0, 0, height_m} + (opening_m + wide_m) * out, wide_m * out,
                                 0.05 * dvec3{-out.y, out.x, 0}));
        return bars;
    };
    // no ring place is nearer to the centre than 0.8 sin 60 degrees in its larger coordinate
    const double half = 0.5, least = 0.8 * 0.866;
    CHECK(seen(frame(half * (least - 0.1) * kRadius_m), kEye_m) == 1);
    CHECK(seen(frame(half * 0.9 * kRadius_m), kEye_m) == sim::kSightRays);
}

TEST_CASE("sight: a marker on a tube of its own radius is seen whole from the front and from the "
          "side, not from behind") {
    // a convex skin lies below the plane of the disc; facets and mixed normals may not undo that
    for (const std::uint32_t around : {12u, 13u, 48u}) {
        const sim::Body tube = rounded(around, 31, [](double phi, double along) {
            return dvec3{kRadius_m * std::sin(phi), 0.06 * along - 0.03, kRadius_m * std::cos(phi)};
        });
        for (int i = 0; i < 40; ++i) { // from one corner to the next and beyond
            const double turn = 0.02 * i;
            const double facet = 2.0 * std::numbers::pi / around;
            const double from_middle = std::remainder(turn - 0.5 * facet, facet);
            const double skin_m = kRadius_m * std::cos(0.5 * facet) / std::cos(from_middle);
            const dvec3 out{std::sin(turn), 0.0, std::cos(turn)};
            const dvec3 side{out.z, 0.0, -out.x};
            const sim::Marker marker{skin_m * out, out, kRadius_m};
            const double sixty = std::numbers::pi / 3.0;
            for (const dvec3& way :
                 {out, std::cos(sixty) * out + std::sin(sixty) * side,
                  std::cos(sixty) * out - std::sin(sixty) * side,
                  std::cos(sixty) * out + std::sin(sixty) * dvec3{0.0, 1.0, 0.0}}) {
                const dvec3 eye_m = 0.08 * way;
                CHECK(seen(tube, eye_m, eye_m, marker) == sim::kSightRays);
            }
            for (const dvec3& way : {-out, side, -side}) // no face to be seen, edge-on or behind
                CHECK(seen(tube, 0.08 * way, 0.08 * way, marker) == 0);
        }
    }
}

TEST_CASE("sight: a marker is not hidden by its own skin if that is turned against it by ten "
          "degrees, or hollow with 2.3 times its radius") {
    const sim::Body flat = plate({0.0, 0.0, 0.0}, kAlong_m, kAcross_m);
    const auto turned = [&](double degree) {
        const double angle = degree * std::numbers::pi / 180.0;
        const sim::Marker marker{
            {0.0, 0.0, 0.0}, {std::sin(angle), 0.0, std::cos(angle)}, kRadius_m};
        return seen(flat, 0.1 * marker.normal, 0.1 * marker.normal, marker);
    };
    CHECK(turned(10.0) == sim::kSightRays);
    CHECK(turned(15.0) < sim::kSightRays); // 12.5 where the ring is 0.8 sin 60 degrees wide

    const auto hollow = [&](double radius_m) {
        const sim::Body tube = rounded(200, 2, [&](double phi, double along) {
            return dvec3{radius_m * std::sin(phi), 0.06 * along - 0.03,
                         radius_m * (1.0 - std::cos(phi))};
        });
        const dvec3 axis_m{0.0, 0.0, radius_m};
        return seen(tube, axis_m, axis_m);
    };
    CHECK(hollow(2.3 * kRadius_m) == sim::kSightRays);
    CHECK(hollow(1.5 * kRadius_m) < sim::kSightRays);
}

TEST_CASE("sight: an eye behind an organ or inside it sees nothing") {
    const sim::Body organ = ball({0.0, 0.0, 0.05}, 0.02);
    CHECK(seen(organ) == 0);
    const dvec3 inside_m{0.005, 0.0, 0.05};
    CHECK(seen(organ, kPort_m, inside_m) == 0);
    CHECK(seen(organ, inside_m, inside_m) == 0); // by the rays alone
    const dvec3 between_m{0.0, 0.0, 0.02};
    CHECK(seen(organ, between_m, between_m) == sim::kSightRays);
}

TEST_CASE("sight: a shaft through a skin sees nothing, but for the first 20 mm") {
    const dvec3 way = glm::normalize(kEye_m - kPort_m);
    const dvec3 u = 5e-3 * glm::normalize(glm::cross(way, dvec3{0.0, 1.0, 0.0}));
    const dvec3 v{0.0, 5e-3, 0.0};
    for (const double at_m : {1e-3, 19.9e-3})
        CHECK(seen(plate(kPort_m + at_m * way, u, v)) == sim::kSightRays);
    for (const double at_m : {20.1e-3, 50e-3, 99.9e-3})
        CHECK(seen(plate(kPort_m + at_m * way, u, v)) == 0);
    CHECK(seen(plate(kPort_m + 50e-3 * way + 3.0 * v, u, v)) == sim::kSightRays); // beside it
    // an endoscope hardly in: no shaft to speak of
    const dvec3 near_m = kEye_m - 15e-3 * way;
    CHECK(seen(plate(kEye_m - 5e-3 * way, u, v), near_m) == sim::kSightRays);
}

TEST_CASE("sight: nothing is seen of what is not finite, or of a marker without a normal") {
    const std::span<const sim::Body> none;
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        for (int axis = 0; axis < 3; ++axis) {
            dvec3 eye_m = kEye_m, port_m = kPort_m;
            sim::Marker moved = kMarker, turned = kMarker, wide = kMarker;
            eye_m[axis] = port_m[axis] = moved.place_m[axis] = turned.normal[axis] = bad;
            wide.radius_m = bad;
            CHECK(seen(none, kPort_m, eye_m) == 0);
            CHECK(seen(none, port_m) == 0);
            for (const sim::Marker& marker : {moved, turned, wide})
                CHECK(seen(none, kPort_m, kEye_m, marker) == 0);
        }
    }
    CHECK(seen(none, kPort_m, kEye_m, {{}, {0.0, 0.0, 0.0}, kRadius_m}) == 0);
}

TEST_CASE("sight: a soft plate that is woken, moves away and comes to rest is followed") {
    std::vector<sim::Body> bodies;
    bodies.push_back(plate({0.0, 0.0, 0.05}, kAlong_m, kAcross_m, true));
    bodies.push_back(plate({0.0, 0.0, 0.0}, kAlong_m, kAcross_m));
    sim::Sight sight = sim::make_sight(bodies);
    sim::Body& soft = bodies[0];
    const auto step = [&](bool resting, double aside_m) {
        soft.soft->resting = resting;
        for (dvec3& place_m : soft.skin_m)
            place_m.x += aside_m;
        sim::refit(sight, bodies);
        return sim::clear_rays(sight, bodies, kPort_m, kEye_m, kMarker);
    };
    CHECK(step(true, 0.0) == 0);
    CHECK(step(false, -0.04) == sim::kSightRays); // woken
    CHECK(step(true, 0.04) == 0);                 // the step in which it comes to rest
    CHECK(step(true, 0.0) == 0);
    const double low_m = sight.tree[0].box[0].low_m.x;
    step(true, 1.0); // that cannot be: a resting body moves; nobody looks
    CHECK(sight.tree[0].box[0].low_m.x == low_m);
    CHECK(step(false, -1.04) == sim::kSightRays);
    CHECK(step(false, 0.04) == 0);
}

TEST_CASE("sight: bodies that moved before the sight was made are where they are") {
    sim::Body soft = plate({0.0, 0.0, 0.05}, kAlong_m, kAcross_m, true);
    for (dvec3& place_m : soft.skin_m)
        place_m.x -= 0.04;
    CHECK(seen(soft) == sim::kSightRays);
    // moving then, at rest in the step after
    soft.soft->resting = false;
    sim::Sight sight = sim::make_sight(std::span{&soft, 1});
    for (dvec3& place_m : soft.skin_m)
        place_m.x += 0.04;
    soft.soft->resting = true;
    sim::refit(sight, std::span{&soft, 1});
    CHECK(sim::clear_rays(sight, std::span{&soft, 1}, kPort_m, kEye_m, kMarker) == 0);
}

TEST_CASE("sight: taking bodies away never hides anything") {
    std::mt19937_64 random(1);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    int partly = 0;
    for (int scene = 0; scene < 300; ++scene) {
        std::vector<sim::Body> bodies;
        for (int b = 0; b < 6; ++b) {
            const auto side = [&] {
                return dvec3{between(-4e-3, 4e-3), between(-4e-3, 4e-3), between(-4e-3, 4e-3)};
            };
            const dvec3 centre_m{between(-6e-3, 6e-3), between(-6e-3, 6e-3), between(0.01, 0.09)};
            bodies.push_back(plate(centre_m, side(), side()));
        }
        int before = 0;
        for (; !bodies.empty(); bodies.pop_back()) {
            const int now = seen(bodies, kEye_m);
            CHECK(now >= before);
            partly += now > before && now < sim::kSightRays;
            before = now;
        }
        CHECK(seen(bodies) == sim::kSightRays);
    }
    CHECK(partly > 100);
}

TEST_CASE("sight: agrees with the scene's check, which has a ray and a tree of its own") {
    const sim::LoadedScene scene = sim::load_scene("two_organs");
    const std::vector<sim::Body> bodies = sim::make_bodies(scene, 0.01);
    const std::vector<sim::Solid> solids = sim::make_solids(scene);
    const sim::Sight sight = sim::make_sight(bodies);
    const dvec3 eye_m = scene.scene.view.eye_m;
    constexpr double kLike_m = 0.5e-3 / 0.15; // whose centre is lifted by as much as in the check
    int all = 0, none = 0;
    for (const sim::Body& body : bodies) {
        for (std::size_t v = 0; v < body.skin_m.size(); v += 7) {
            const sim::Marker marker{body.skin_m[v], body.skin_normal[v], kLike_m};
            if (glm::dot(eye_m - marker.place_m, marker.normal) < 1e-3)
                continue; // the check does not ask which way it faces
            const int clear = sim::clear_rays(sight, bodies, eye_m, eye_m, marker);
            const bool hidden =
                sim::sight_obstacle(solids, eye_m, marker.place_m, marker.normal).body >= 0;
            CHECK_FALSE((clear == sim::kSightRays && hidden));
            CHECK_FALSE((clear == 0 && !hidden));
            all += clear == sim::kSightRays;
            none += clear == 0;
        }
    }
    CHECK(all > 100);
    CHECK(none > 10);
}

TEST_CASE("sight: a step allocates nothing") {
    std::vector<sim::Body> bodies;
    bodies.push_back(plate({0.0, 0.0, 0.05}, kAlong_m, {0.0, 0.5e-3, 0.0}, true));
    bodies.push_back(ball({0.0, 0.03, 0.05}, 0.02));
    sim::Sight sight = sim::make_sight(bodies);
    bodies[0].soft->resting = false;
    const int before = allocations;
    int clear = 0;
    for (int i = 0; i < 100; ++i) {
        bodies[0].skin_m[0].z -= 1e-5;
        sim::refit(sight, bodies);
        clear += sim::clear_rays(sight, bodies, kPort_m, kEye_m, kMarker);
    }
    CHECK(allocations == before);
    CHECK(clear > 0);
    CHECK(clear < 100 * sim::kSightRays);
    ::operator delete(::operator new(8)); // a new expression may be optimised away
    CHECK(allocations == before + 1);     // the counter counts
}
