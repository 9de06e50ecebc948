// tests/bake/shapes_for_tests.h
// Surfaces with known answers, shared by the tests of bake.
#pragma once

#include "assets/bake/polygonise.h"
#include "assets/bake/shape.h"

#include <doctest/doctest.h>

namespace bake_tests {

/// Relative, whatever the size: Approx alone allows epsilon x 1 too, more than a volume in m^3.
inline doctest::Approx near(double value, double relative = 1e-9) {
    return doctest::Approx(value).epsilon(relative).scale(0.0);
}

inline bake::Surface tetrahedron() {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
            {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

inline bake::Surface sphere(double radius_m, double cell_m) {
    const glm::dvec3 reach{1.2 * radius_m};
    return bake::polygonise([=](const glm::dvec3& p) { return glm::length(p) - radius_m; }, -reach,
                            reach, cell_m);
}

inline bake::SizeAt even(double edge_m) {
    return [edge_m](const glm::dvec3&) { return edge_m; };
}

} // namespace bake_tests
