#include "haptics/collision/near_leaves.h"

#include "haptics/collision/brute_force.h"
#include "tests/haptics/ring_meshes.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <hwy/targets.h>
#include <memory>
#include <set>
#include <string>

using namespace haptics;
using glm::dvec3;

namespace {

std::set<std::uint32_t> triangles(const NearLeaves& near, const Places& place, int count) {
    std::set<std::uint32_t> out;
    for (int i = 0; i < count; ++i)
        out.insert(near.triangle(place[i]));
    return out;
}

// What of a mesh a question left out although it should not, and what it named for nothing.
struct Faults {
    int not_near = 0, not_touched = 0, not_met = 0, nearest_wrong = 0;
    int named = 0, named_for_nothing = 0, asked = 0;

    int missed() const { return not_near + not_touched + not_met + nearest_wrong; }
};

std::string told(const Faults& f) {
    return "near " + std::to_string(f.not_near) + ", touched " + std::to_string(f.not_touched) +
           ", met " + std::to_string(f.not_met) + ", nearest " + std::to_string(f.nearest_wrong) +
           " of " + std::to_string(f.asked);
}

struct Ask {
    dvec3 centre_m, from_m, to_m;
    double reach_m, radius_m;
};

// A ball that rests near a vertex of the mesh, a way that is short for it or long.
Ask an_ask(std::mt19937& random, const ring_meshes::Mesh& mesh, double size_m) {
    std::uniform_int_distribution<std::size_t> vertex(0, mesh.vertex_m.size() - 1);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    Ask ask;
    ask.radius_m = u(random) < 0.2 ? 0.0 : size_m * std::pow(10.0, -1.0 - 2.0 * u(random));
    const double way_m = size_m * std::pow(10.0, -1.0 - 3.0 * u(random));
    ask.centre_m = mesh.vertex_m[vertex(random)] +
                   ring_meshes::random_place(random, ask.radius_m + 0.5 * way_m);
    ask.from_m =
        u(random) < 0.5 ? ask.centre_m : ask.centre_m + ring_meshes::random_place(random, way_m);
    ask.to_m = ask.centre_m + ring_meshes::random_place(random, way_m);
    const double off_m =
        std::max(glm::length(ask.from_m - ask.centre_m), glm::length(ask.to_m - ask.centre_m));
    ask.reach_m = (1.0 + 0.1 * u(random)) * (ask.radius_m + off_m);
    return ask;
}

void look_for(const CollisionIndex& index, const MeshView& mesh, const Ask& ask, WideRing& ring,
              NearLeaves& near, Faults& out) {
    ++out.asked;
    REQUIRE(find_near(index, mesh, ask.centre_m, ask.reach_m, ring, near));
    std::set<std::uint32_t> known;
    for (int place = 0; place < near.count * NearLeaves::kWidth; ++place)
        known.insert(near.triangle(place));
    Places place;
    const auto touched = triangles(near, place, may_touch(near, ask.radius_m, place));
    const auto met =
        triangles(near, place, may_meet(near, ask.from_m, ask.to_m, ask.radius_m, place));
    double nearest_m = std::numeric_limits<double>::infinity();
    for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t) {
        const TriangleCorners corner = mesh.corners(t);
        const double distance_m = std::sqrt(nearest_on_triangle(corner, ask.centre_m).distance2_m2);
        nearest_m = std::min(nearest_m, distance_m);
        out.not_near += distance_m <= ask.reach_m && !known.contains(t);
        out.not_touched += distance_m <= ask.radius_m && !touched.contains(t);
        const double way_m =
            std::sqrt(nearest_to_segment(corner, ask.from_m, ask.to_m).on_triangle.distance2_m2);
        out.not_met += way_m < ask.radius_m * (1.0 - 1e-12) && !met.contains(t);
        out.named += met.contains(t);
        out.named_for_nothing += met.contains(t) && way_m > 1.001 * ask.radius_m;
    }
    if (const int best = nearest_place(near); best >= 0 && nearest_m < ask.reach_m)
        out.nearest_wrong += near.least(best) > near.bound(nearest_m);
}

// Asks, and checks that nothing was left out.
Faults faults(const std::string& method, const ring_meshes::Mesh& mesh, double size_m,
              std::uint32_t seed, int asks) {
    std::mt19937 random(seed);
    const MeshView view = mesh.view();
    const CollisionIndex index = make_index(method, view);
    WideRing ring;
    const auto near = std::make_unique<NearLeaves>();
    Faults out;
    for (int i = 0; i < asks; ++i)
        look_for(index, view, an_ask(random, mesh, size_m), ring, *near, out);
    CAPTURE(told(out));
    CHECK(out.missed() == 0);
    return out;
}

} // namespace

TEST_CASE("near leaves: no triangle that a ball touches or meets on its way is ruled out") {
    for (std::uint32_t seed = 1; seed <= 4; ++seed)
        for (const char* method : {"ours", "hash-grid"}) {
            CAPTURE(seed);
            CAPTURE(method);
            faults(method, ring_meshes::ball(6, 0.06, seed), 0.06, seed, 300);
            faults(method, ring_meshes::sheet(8, 0.1, 1e-3, seed), 0.1, seed, 300);
            faults(method, ring_meshes::soup(200, 0.1, seed), 0.1, seed, 300);
        }
}

TEST_CASE("near leaves: most that is named is really in the way") {
    Faults sum;
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        const Faults one = faults("ours", ring_meshes::ball(10, 0.06, seed), 0.06, seed, 400);
        sum.named += one.named;
        sum.named_for_nothing += one.named_for_nothing;
    }
    CHECK(sum.named > 1000);
    // planes from both ends' nearest points part most that is not met between them; not all, where
    // the way is as long as the triangles
    CHECK(sum.named_for_nothing < sum.named / 3);
}

TEST_CASE("near leaves: a thousand metres away and in millimetres nothing is ruled out either") {
    for (const double unit : {1e-3, 1.0, 1e3})
        for (const double offset : {0.0, 1.0, 1e3}) {
            CAPTURE(unit);
            CAPTURE(offset);
            ring_meshes::Mesh mesh = ring_meshes::ball(6, 0.06 * unit, 7);
            for (dvec3& v : mesh.vertex_m)
                v += offset * unit * dvec3{1.0, -0.5, 0.3};
            faults("ours", mesh, 0.06 * unit, 3, 300);
        }
}

TEST_CASE("near leaves: slivers, twins and points are not ruled out either") {
    ring_meshes::Mesh mesh = ring_meshes::soup(120, 0.1, 5);
    std::mt19937 random(5);
    std::uniform_int_distribution<std::size_t> any(0, mesh.vertex_m.size() - 1);
    for (std::size_t t = 0; t + 3 < mesh.triangle.size(); t += 4) {
        const auto [a, b, c] = mesh.triangle[t];
        mesh.vertex_m[c] = glm::mix(mesh.vertex_m[a], mesh.vertex_m[b], 0.3) +
                           ring_meshes::random_place(random, 1e-9);
        mesh.triangle[t + 1] = mesh.triangle[t];                // a twin
        mesh.triangle[t + 2] = {mesh.triangle[t + 2][0], b, b}; // an edge
        mesh.triangle[t + 3] = {a, a, a};                       // a point
    }
    faults("ours", mesh, 0.1, 11, 600);
}

TEST_CASE("near leaves: every instruction set leaves nothing out") {
    for (const std::int64_t one : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(one);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        CAPTURE(hwy::TargetName(one));
        faults("ours", ring_meshes::ball(6, 0.06, 2), 0.06, 2, 200);
        faults("ours", ring_meshes::soup(100, 0.1, 2), 0.1, 2, 200);
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST_CASE("near leaves: what does not fit is told, and what is not a number is nowhere") {
    const ring_meshes::Mesh mesh = ring_meshes::ball(24, 0.06, 1);
    const MeshView view = mesh.view();
    WideRing ring;
    const auto near = std::make_unique<NearLeaves>();
    for (const char* method : {"ours", "obb-tree"}) {
        CAPTURE(method);
        const CollisionIndex index = make_index(method, view);
        CHECK_FALSE(find_near(index, view, dvec3{0.0}, 0.1, ring, *near));
        CHECK(near->count <= NearLeaves::kRoom);
        CHECK(find_near(index, view, dvec3{0.0}, 0.01, ring, *near));
        CHECK(near->count == 0);
        CHECK(nearest_place(*near) == -1);
    }
    // a vertex that is lost at a refit takes its triangles out of the world
    ring_meshes::Mesh broken = ring_meshes::ball(4, 0.06, 1);
    CollisionIndex index = make_index("ours", broken.view());
    broken.vertex_m[0].x = std::numeric_limits<double>::quiet_NaN();
    refit(index, broken.view());
    Places place;
    REQUIRE(find_near(index, broken.view(), broken.vertex_m[1], 0.02, ring, *near));
    const auto found = triangles(*near, place, may_touch(*near, 0.02, place));
    CHECK_FALSE(found.empty());
    for (const std::uint32_t t : found)
        for (const std::uint32_t v : broken.triangle[t])
            CHECK(v != 0);
}
