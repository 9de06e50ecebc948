// tests/tissue/tangle_test.cpp
#include "tissue/solver/tangle.h"

#include "tests/tissue/tangled.h"

#include <doctest/doctest.h>

using glm::dmat3;
using glm::dvec3;

namespace {

double distance(const dmat3& a, const dmat3& b) {
    return std::max({glm::length(a[0] - b[0]), glm::length(a[1] - b[1]), glm::length(a[2] - b[2])});
}

} // namespace

TEST_CASE("however its inside is thrown about, a tangle turns as its rim does") {
    // the mean of F over a region is a sum over its rim alone: exactly R if the rim is turned by R
    std::mt19937_64 random(1);
    for (int i = 0; i < 20; ++i) {
        const tissue::TetMesh mesh = tissue::box_mesh({0.05, 0.05, 0.05}, {5, 5, 5}, 0.1, random());
        const tissue::CorotatedModel model =
            tissue::make_corotated(mesh, bodies::elastic(1e3, 0.4), {});
        const dmat3 R = bodies::rotation(bodies::signed_vector(random), 3.0);
        std::vector<dvec3> place_m;
        for (const dvec3& x : mesh.rest_m)
            place_m.push_back(R * x);
        for (std::size_t k = 0; k < place_m.size(); ++k) // one node, out through its star
            if (glm::length(mesh.rest_m[k] - dvec3{0.02}) < 0.004)
                place_m[k] += 0.03 * glm::normalize(bodies::signed_vector(random));
        tissue::Tangles tangles = tissue::make_tangles(model);
        tissue::find_tangles(model, place_m, tangles);
        REQUIRE(tangles.inverted > 0);
        int in_it = 0;
        for (const tissue::Tet& t : mesh.tets) {
            if (const dmat3* turned = tissue::rotation_of(tangles, t)) {
                CHECK(distance(*turned, R) < 1e-12);
                ++in_it;
            }
        }
        CHECK(in_it > tangles.inverted); // the tets around them too
        CHECK(in_it < static_cast<int>(mesh.tets.size()));
    }
}

TEST_CASE("two tangles apart turn each as its own surroundings") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.12, 0.03, 0.03}, {12, 3, 3});
    const tissue::CorotatedModel model =
        tissue::make_corotated(mesh, bodies::elastic(1e3, 0.4), {});
    const dmat3 left = bodies::rotation({1, 0, 0}, -0.4), right = bodies::rotation({1, 0, 0}, 0.4);
    std::vector<dvec3> place_m; // twisted in the middle, each end rigid
    for (const dvec3& x : mesh.rest_m) {
        const double share = std::clamp((x.x - 0.05) / 0.02, 0.0, 1.0);
        place_m.push_back(bodies::rotation({1, 0, 0}, -0.4 + 0.8 * share) * x);
        const bool knot = std::abs(x.y - 0.01) < 1e-9 && std::abs(x.z - 0.01) < 1e-9 &&
                          (std::abs(x.x - 0.02) < 1e-9 || std::abs(x.x - 0.10) < 1e-9);
        if (knot)
            place_m.back() += dvec3{0.015, 0.0, 0.0}; // through the far side of its star
    }
    tissue::Tangles tangles = tissue::make_tangles(model);
    tissue::find_tangles(model, place_m, tangles);
    REQUIRE(tangles.inverted > 0);
    int of_left = 0, of_right = 0;
    for (const tissue::Tet& t : mesh.tets) {
        const dmat3* turned = tissue::rotation_of(tangles, t);
        if (turned == nullptr)
            continue;
        const bool at_left = mesh.rest_m[t[0]].x < 0.06;
        CHECK(distance(*turned, at_left ? left : right) < 1e-12);
        ++(at_left ? of_left : of_right);
    }
    CHECK(of_left > 0);
    CHECK(of_right > 0);
}

TEST_CASE("a body that is only bent has no tangle") {
    const tissue::TetMesh mesh = tangled::cube(1);
    const tissue::CorotatedModel model =
        tissue::make_corotated(mesh, bodies::elastic(1e3, 0.4), {});
    const tissue::CorotatedState state =
        bodies::moved(model, tissue::rest_state(model), bodies::random_unknowns(model, 4), 1e-3);
    tissue::Tangles tangles = tissue::make_tangles(model);
    tissue::find_tangles(model, state.position_m, tangles);
    CHECK(tangles.inverted == 0);
    for (const tissue::Tet& t : mesh.tets)
        CHECK(tissue::rotation_of(tangles, t) == nullptr);
}
