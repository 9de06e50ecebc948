// tests/tissue/taut_string_test.cpp
// Why the tangent needs the derivative of the rotation: a taut string of tets that meet in single
// nodes, 15 free masses of 1 g every 20 mm under 1 N. Without it the string has no lateral
// stiffness in the matrix and moves explicitly: stable up to dt = 2/w_max only,
//   w_max^2 = 4 T/(m l) sin^2(15 pi / 32),  2/w_max = 4.494 ms
#include "tests/tissue/bodies.h"
#include "tissue/baseline/hinged.h"

#include <doctest/doctest.h>

using glm::dvec3;
using tissue::HingedRow;
using tissue::TautString;

namespace {

// Largest sag within the last tenth of a run over the sag at its start.
double growth(double dt_s, int steps, bool exact) {
    HingedRow s = tissue::taut_string({}, 1e-8, 2);
    tissue::CorotatedSystem system = tissue::make_system(s.model);
    const double start_m = tissue::sag_m(s.state.position_m);
    double last_m = 0.0;
    for (int i = 0; i < steps; ++i) {
        bodies::step(s.model, s.state, system, dt_s, exact);
        CHECK(system.exact_tangent == exact);
        const double now_m = tissue::sag_m(s.state.position_m);
        if (i >= steps - steps / 10)
            last_m = std::max(last_m, now_m);
        if (!(now_m < 1e3 * start_m))
            return 1e3; // gone
    }
    return last_m / start_m;
}

} // namespace

TEST_CASE("the string of the tests has the tension it should have") {
    CHECK(tissue::critical_step_s({}) == doctest::Approx(4.494e-3).scale(0.0).epsilon(1e-4));
    const HingedRow s = tissue::taut_string({}, 0.0, 2);
    std::vector<dvec3> f(s.state.position_m.size());
    tissue::elastic_forces(s.model, s.state, f);
    CHECK(f.front().x == doctest::Approx(-TautString{}.tension_n).scale(0.0).epsilon(1e-6));
    CHECK(f.back().x == doctest::Approx(TautString{}.tension_n).scale(0.0).epsilon(1e-6));
}

TEST_CASE("without the derivative of the rotation a taut string is stable up to 2/w_max only") {
    const double critical_s = tissue::critical_step_s({});
    CHECK(growth(0.99 * critical_s, 2000, false) < 5.0);
    CHECK(growth(1.01 * critical_s, 2000, false) >= 1e3);
    CHECK(growth(5.0 * critical_s, 2000, false) >= 1e3);
}

TEST_CASE("with the exact tangent a taut string decays at five times that step") {
    CHECK(growth(5.0 * tissue::critical_step_s({}), 200, true) < 1e-3);
}

TEST_CASE("a hanging chain stretches by alpha m g n (n + 1)/2, whatever the step") {
    // 2.060 mm; the strain, 0.4 % in the first link, is that of the corotated law
    for (const double dt_s : {1.0 / 60, 0.001}) {
        HingedRow c = tissue::hanging_chain({});
        tissue::CorotatedSystem system = tissue::make_system(c.model);
        c.model.material.damping_mass_1ps = 5.0;
        for (int i = 0; i < static_cast<int>(3.0 / dt_s); ++i)
            bodies::step(c.model, c.state, system, dt_s);
        const double stretch_m = c.state.position_m.back().x - 20 * 0.05;
        CHECK(stretch_m == doctest::Approx(2.0601e-3).scale(0.0).epsilon(1e-3));
        CHECK(stretch_m == doctest::Approx(tissue::hanging_stretch_m({})).scale(0.0).epsilon(1e-4));
    }
}
