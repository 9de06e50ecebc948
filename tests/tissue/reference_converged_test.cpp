// tests/tissue/reference_converged_test.cpp
// Minutes: the heavy beam on a mesh so fine that nothing is left to extrapolate.
#include "tests/tissue/reference_bodies.h"

#include <doctest/doctest.h>

TEST_CASE("a heavy beam of 15360 quadratic tetrahedra hangs at the converged place") {
    // by CalculiX 2.20 and an independent solver of quadratic tetrahedra, to 0.1 mm
    struct Case {
        double young_pa, poisson;
        glm::dvec3 tip_m;
    };
    const Case cases[]{{100e3, 0.45, {-38.2e-3, -113.8e-3, 0}},
                       {30e3, 0.45, {-115.6e-3, -180.7e-3, 0}},
                       {100e3, 0.30, {-39.4e-3, -115.3e-3, 0}},
                       {30e3, 0.30, {-117.5e-3, -181.5e-3, 0}}};
    for (const Case& c : cases) {
        const auto s = reference_bodies::heavy_beam({40, 8, 8}, c.young_pa, c.poisson);
        CHECK(s.report.converged);
        const glm::dvec3 tip = reference_bodies::tip_m(s);
        MESSAGE("E ", c.young_pa, " Pa, nu ", c.poisson, ": tip ", tip.x * 1e3, " ", tip.y * 1e3,
                " mm, ", s.report.iterations, " iterations");
        // a digit of theirs is 0.05 mm, and 0.05 mm more for what both meshes still miss
        CHECK(std::abs(tip.x - c.tip_m.x) < 1e-4);
        CHECK(std::abs(tip.y - c.tip_m.y) < 1e-4);
    }
}
