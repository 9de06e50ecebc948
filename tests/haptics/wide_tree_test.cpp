#include "haptics/collision/wide_tree.h"

#include "haptics/collision/brute_force.h"
#include "tests/haptics/ring_meshes.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/gtc/constants.hpp>
#include <hwy/targets.h>
#include <limits>
#include <string>

using namespace haptics;
using glm::dvec3;

namespace {

bool same(const SurfaceHit& a, const SurfaceHit& b) {
    return a.triangle == b.triangle &&
           (!a.hit() ||
            (a.distance_m == b.distance_m && a.place_m == b.place_m && a.weight == b.weight));
}

// Where a hand might go: steps of all sizes, back and forth, now and then somewhere else.
std::vector<dvec3> walk(std::mt19937& random, const ring_meshes::Mesh& mesh, double size_m,
                        int steps) {
    std::uniform_int_distribution<std::size_t> vertex(0, mesh.vertex_m.size() - 1);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    std::vector<dvec3> out;
    dvec3 place = mesh.vertex_m[vertex(random)], heading{0.0};
    for (int i = 0; i < steps; ++i) {
        if (u(random) < 0.01)
            place = mesh.vertex_m[vertex(random)] + ring_meshes::random_place(random, 0.1 * size_m);
        if (u(random) < 0.02)
            heading =
                ring_meshes::random_place(random, size_m * std::pow(10.0, -1 - 3 * u(random)));
        place += heading + ring_meshes::random_place(random, 0.01 * glm::length(heading));
        out.push_back(place);
    }
    return out;
}

int differences(const ring_meshes::Mesh& mesh, double size_m, std::uint32_t seed, int steps) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    const MeshView view = mesh.view();
    const WideTree tree = make_wide_tree(view);
    const BruteForce all = make_brute_force(view);
    WideRing ring;
    int out = 0;
    for (const dvec3& place : walk(random, mesh, size_m, steps)) {
        const double radius_m = size_m * std::pow(10.0, 1.0 - 3.0 * u(random));
        const SurfaceHit right = closest_within(all, view, place, radius_m);
        out += !same(closest_within(tree, view, ring, place, radius_m), right);
        out += !same(closest_within(tree, view, place, radius_m), right);
    }
    CHECK(ring.made < ring.asked); // or it would be no use
    return out;
}

} // namespace

TEST_CASE("wide tree: with or without a ring the answer is that of brute force, to the bit") {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        CAPTURE(seed);
        CHECK(differences(ring_meshes::ball(12, 0.06, seed), 0.06, seed, 1500) == 0);
        CHECK(differences(ring_meshes::sheet(20, 0.1, 1e-3, seed), 0.1, seed, 1000) == 0);
        CHECK(differences(ring_meshes::soup(600, 0.1, seed), 0.1, seed, 1000) == 0);
        CHECK(differences(ring_meshes::soup(3, 0.1, seed), 0.1, seed, 300) == 0);
    }
}

TEST_CASE("wide tree: a thousand metres away and in millimetres it answers as well") {
    for (const double unit : {1e-3, 1.0, 1e3, 1e6})
        for (const double offset : {0.0, 1.0, 1e3}) {
            CAPTURE(unit);
            CAPTURE(offset);
            ring_meshes::Mesh mesh = ring_meshes::ball(10, 0.06 * unit, 7);
            for (dvec3& v : mesh.vertex_m)
                v += offset * unit * dvec3{1.0, -0.5, 0.3};
            CHECK(differences(mesh, 0.06 * unit, 3, 800) == 0);
        }
}

TEST_CASE("wide tree: every instruction set gives the same bits") {
    const ring_meshes::Mesh mesh = ring_meshes::ball(15, 0.06, 2);
    int sets = 0;
    for (const std::int64_t one : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(one);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        CAPTURE(wide_tree_instructions());
        CHECK(std::string(wide_tree_instructions()) == hwy::TargetName(one));
        CHECK(differences(mesh, 0.06, 5, 600) == 0);
        ++sets;
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    CHECK(sets >= 1);
}

TEST_CASE("wide tree: after a refit the ring is not believed any more") {
    std::mt19937 random(4);
    ring_meshes::Mesh mesh = ring_meshes::ball(14, 0.06, 9);
    const std::vector<dvec3> rest = mesh.vertex_m;
    WideTree tree = make_wide_tree(mesh.view());
    WideRing ring;
    int wrong = 0;
    for (int frame = 0; frame < 200; ++frame) {
        for (std::size_t v = 0; v < rest.size(); ++v)
            mesh.vertex_m[v] = rest[v] * (1.0 + 0.1 * std::sin(0.3 * frame + 40.0 * rest[v].x));
        refit(tree, mesh.view());
        for (int i = 0; i < 5; ++i) {
            const dvec3 place = dvec3{0.061, 1e-3 * i, 1e-4 * frame};
            wrong += !same(closest_within(tree, mesh.view(), ring, place, 0.02),
                           closest_within(make_brute_force(mesh.view()), mesh.view(), place, 0.02));
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("wide tree: a mesh that wanders off takes its frame along") {
    ring_meshes::Mesh mesh = ring_meshes::ball(10, 0.06, 11);
    WideTree tree = make_wide_tree(mesh.view());
    WideRing ring;
    for (const double far : {0.1, 10.0, 1e4}) {
        for (dvec3& v : mesh.vertex_m)
            v += dvec3{far, 0.0, far};
        refit(tree, mesh.view());
        const dvec3 place = mesh.vertex_m[20] * (1.0 + 1e-7) + dvec3{1e-3, 0.0, 0.0};
        const SurfaceHit right =
            closest_within(make_brute_force(mesh.view()), mesh.view(), place, 0.05);
        CHECK(right.hit());
        CHECK(same(closest_within(tree, mesh.view(), ring, place, 0.05), right));
    }
}

TEST_CASE("wide tree: a vertex that is no number takes its triangles out, the others stay") {
    ring_meshes::Mesh mesh = ring_meshes::ball(10, 0.06, 13);
    WideTree tree = make_wide_tree(mesh.view());
    WideRing ring;
    const dvec3 there = mesh.vertex_m[30];
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const dvec3& bad : {dvec3{nan}, dvec3{0.0, nan, 0.0}}) {
        mesh.vertex_m[30] = bad;
        refit(tree, mesh.view());
        const SurfaceHit hit = closest_within(tree, mesh.view(), ring, there, 0.05);
        REQUIRE(hit.hit());
        for (const std::uint32_t v : mesh.triangle[hit.triangle])
            CHECK(v != 30);
        CHECK(hit.distance_m > 1e-3);
        CHECK(same(hit, closest_within(make_brute_force(mesh.view()), mesh.view(), there, 0.05)));
    }
    CHECK_FALSE(closest_within(tree, mesh.view(), ring, dvec3{nan}, 0.05).hit());
    CHECK_FALSE(closest_within(tree, mesh.view(), ring, there, nan).hit());
}

TEST_CASE("wide tree: a mesh without triangles answers nothing") {
    const ring_meshes::Mesh mesh;
    WideTree tree = make_wide_tree(mesh.view());
    refit(tree, mesh.view());
    WideRing ring;
    CHECK_FALSE(closest_within(tree, mesh.view(), ring, dvec3{0.0}, 1e9).hit());
    CHECK_FALSE(cast_segment(tree, mesh.view(), dvec3{0.0}, dvec3{1.0}).hit());
}

TEST_CASE("wide tree: among equally near triangles the first is taken, however many there are") {
    // 400 times the same: more than there is room to remember
    ring_meshes::Mesh mesh;
    mesh.vertex_m = {{0.0, 0.0, 0.0}, {0.01, 0.0, 0.0}, {0.0, 0.01, 0.0}};
    mesh.triangle.assign(1000, {0, 1, 2});
    const WideTree tree = make_wide_tree(mesh.view());
    WideRing ring;
    for (int i = 0; i < 5; ++i) {
        const SurfaceHit hit =
            closest_within(tree, mesh.view(), ring, dvec3{0.002, 0.002, 0.001 * i}, 0.1);
        CHECK(hit.triangle == 0);
        CHECK(std::abs(hit.distance_m - 0.001 * i) < 1e-18); // rounding
    }
}
