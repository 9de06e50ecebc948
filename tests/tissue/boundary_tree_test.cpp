// tests/tissue/boundary_tree_test.cpp
// The box tree against looking at every triangle.
#include "tissue/response/boundary_tree.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <rapidcheck.h>

namespace {

using glm::dvec3;

dvec3 random_point(double size) {
    const auto coordinate = [size] {
        return *rc::gen::resize(100, rc::gen::inRange(-1000, 2000)) * 1e-3 * size;
    };
    const double x = coordinate(), y = coordinate();
    return {x, y, coordinate()};
}

} // namespace

TEST_CASE("boundary tree: the nearest point of a box is the point clamped to its faces") {
    const tissue::BoundaryTree tree =
        tissue::make_boundary_tree(tissue::box_mesh({1, 1, 1}, {4, 3, 5}));
    CHECK(rc::check([&] {
        const dvec3 p = random_point(1.0);
        dvec3 truth = glm::clamp(p, dvec3{0.0}, dvec3{1.0});
        double distance = glm::distance(p, truth);
        if (distance == 0.0) { // inside: the nearest of the six faces
            distance = 1.0;
            for (int axis = 0; axis < 3; ++axis)
                distance = std::min({distance, p[axis], 1.0 - p[axis]});
        }
        const tissue::BoundaryPoint found = tissue::nearest_point(tree, p);
        RC_ASSERT(std::abs(found.distance_m - distance) < 1e-12);
        RC_ASSERT(std::abs(glm::distance(p, position_m(tree, found)) - distance) < 1e-12);
        RC_ASSERT(std::abs(found.weight.x + found.weight.y + found.weight.z - 1.0) < 1e-12);
        RC_ASSERT(std::min({found.weight.x, found.weight.y, found.weight.z}) >= -1e-12);
    }));
}

TEST_CASE("boundary tree: a line enters and leaves a box where its planes are") {
    const tissue::BoundaryTree tree =
        tissue::make_boundary_tree(tissue::box_mesh({1, 1, 1}, {4, 3, 5}));
    CHECK(rc::check([&] {
        const dvec3 from = random_point(1.0);
        const dvec3 to = random_point(1.0);
        RC_PRE(glm::distance(from, to) > 0.01);
        const dvec3 direction = glm::normalize(to - from);
        double enter = -10.0, leave = 10.0; // slabs
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(direction[axis]) < 1e-12) {
                if (from[axis] <= 0.0 || from[axis] >= 1.0)
                    leave = -20.0;
                continue;
            }
            const double a = -from[axis] / direction[axis];
            const double b = (1.0 - from[axis]) / direction[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        RC_PRE(std::abs(leave - enter) > 1e-6); // not through an edge
        const auto hits = tissue::line_hits(tree, from, direction, -10.0, 10.0);
        if (leave < enter) {
            RC_ASSERT(hits.empty());
            return;
        }
        RC_ASSERT(hits.size() >= 2u);
        for (const auto& hit : hits) {
            const bool entry = std::abs(hit.distance_m - enter) < 1e-9;
            RC_ASSERT(entry || std::abs(hit.distance_m - leave) < 1e-9);
            RC_ASSERT(glm::dot(tree.normal[hit.triangle], direction) * (entry ? 1 : -1) <= 1e-9);
            RC_ASSERT(glm::distance(position_m(tree, hit), from + hit.distance_m * direction) <
                      1e-8);
        }
        // half a line sees only what lies ahead
        for (const auto& hit : tissue::line_hits(tree, from, direction, 0.0, 10.0))
            RC_ASSERT(hit.distance_m >= 0.0);
    }));
}

TEST_CASE("boundary tree: a body without tetrahedra is refused") {
    CHECK_THROWS_WITH(tissue::make_boundary_tree({}), doctest::Contains("no boundary"));
}
