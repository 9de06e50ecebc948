// tests/tissue/patch_test.cpp
#include "tissue/response/patch.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <rapidcheck.h>
#include <set>
#include <stdexcept>

using glm::dvec3;

namespace {

tissue::ContactSurface box_skin() {
    const tissue::TetMesh mesh = tissue::box_mesh({0.08, 0.06, 0.04}, {8, 6, 4});
    tissue::ContactSurface s;
    s.rest_m = mesh.rest_m;
    s.triangles = tissue::boundary_triangles(mesh);
    s.neighbours = tissue::triangle_neighbours(s.triangles);
    return s;
}

dvec3 centroid(const tissue::ContactSurface& s, std::uint32_t t) {
    dvec3 sum{0.0};
    for (const std::uint32_t v : s.triangles[t])
        sum += s.rest_m[v];
    return sum / 3.0;
}

bool within(const tissue::ContactSurface& s, std::uint32_t t, const dvec3& middle, double r) {
    return std::any_of(s.triangles[t].begin(), s.triangles[t].end(),
                       [&](std::uint32_t v) { return glm::length(s.rest_m[v] - middle) <= r; });
}

} // namespace

TEST_CASE("a patch speaks of the same triangles, corners and neighbours as its surface") {
    const tissue::ContactSurface skin = box_skin();
    tissue::Patch patch = tissue::make_patch(skin, 60, 100);
    CHECK(rc::check("consistent, also when used again", [&](std::uint32_t pick, unsigned size) {
        const auto centre = static_cast<std::uint32_t>(pick % skin.triangles.size());
        tissue::gather_patch(skin, skin.rest_m, centre, size % 100 * 1e-3, patch);
        RC_ASSERT(patch.triangle.front() == centre);
        RC_ASSERT(patch.corner.size() == patch.triangle.size());
        RC_ASSERT(patch.neighbour.size() == patch.triangle.size());
        RC_ASSERT(patch.vertex.size() <= 60u);
        RC_ASSERT(patch.triangle.size() <= 100u);
        const std::set<std::uint32_t> members(patch.triangle.begin(), patch.triangle.end());
        RC_ASSERT(members.size() == patch.triangle.size());
        for (std::size_t i = 0; i < patch.triangle.size(); ++i) {
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t t = patch.triangle[i];
                RC_ASSERT(patch.vertex[patch.corner[i][k]] == skin.triangles[t][k]);
                const auto across = static_cast<std::uint32_t>(skin.neighbours[t][k]);
                const int local = patch.neighbour[i][k];
                RC_ASSERT((local >= 0) == (members.count(across) == 1));
                if (local >= 0)
                    RC_ASSERT(patch.triangle[local] == across);
            }
        }
    }));
}

TEST_CASE("with room enough a patch holds all triangles within the radius that hang together") {
    const tissue::ContactSurface skin = box_skin();
    tissue::Patch patch = tissue::make_patch(skin, 2000, 2000);
    for (const double radius_m : {0.0, 0.012, 0.025, 1.0}) {
        const std::uint32_t centre = 40;
        tissue::gather_patch(skin, skin.rest_m, centre, radius_m, patch);
        const std::set<std::uint32_t> members(patch.triangle.begin(), patch.triangle.end());
        for (std::uint32_t t = 0; t < skin.triangles.size(); ++t) {
            const bool touches =
                std::any_of(skin.neighbours[t].begin(), skin.neighbours[t].end(), [&](int n) {
                    return members.count(static_cast<std::uint32_t>(n)) == 1;
                });
            const bool wanted = within(skin, t, centroid(skin, centre), radius_m) && touches;
            CHECK((members.count(t) == 1) == (wanted || t == centre));
        }
        if (radius_m == 1.0)
            CHECK(members.size() == skin.triangles.size());
    }
}

TEST_CASE("a full patch keeps the nearest rings") {
    const tissue::ContactSurface skin = box_skin();
    tissue::Patch small = tissue::make_patch(skin, 12, 200), few = tissue::make_patch(skin, 200, 4);
    tissue::gather_patch(skin, skin.rest_m, 40, 1.0, small);
    CHECK(small.vertex.size() == 12);
    tissue::gather_patch(skin, skin.rest_m, 40, 1.0, few);
    CHECK(few.triangle.size() == 4); // itself and its three neighbours
    for (const int n : skin.neighbours[40]) {
        CHECK(std::count(few.triangle.begin(), few.triangle.end(), static_cast<unsigned>(n)) == 1);
    }
}

TEST_CASE("limits that cannot work are refused") {
    const tissue::ContactSurface skin = box_skin();
    CHECK_THROWS_AS(tissue::make_patch(skin, 2, 10), std::invalid_argument);
    CHECK_THROWS_AS(tissue::make_patch(skin, 40000, 10), std::invalid_argument);
}
