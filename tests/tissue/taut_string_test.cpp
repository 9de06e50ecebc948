// tests/tissue/taut_string_test.cpp
// Why the tangent needs the derivative of the rotation: a taut string of tets that meet in single
// nodes, 15 free masses of 1 g every 20 mm under 1 N. Without it the string has no lateral
// stiffness in the matrix and moves explicitly: stable up to dt = 2/w_max only,
//   w_max^2 = 4 T/(m l) sin^2(15 pi / 32),  2/w_max = 4.494 ms
#include "tests/tissue/bodies.h"

#include <doctest/doctest.h>
#include <glm/gtc/constants.hpp>

using glm::dvec3;

namespace {

constexpr int kFree = 15;
constexpr double kSpacing_m = 0.02, kMass_kg = 1e-3, kTension_n = 1.0;

struct String {
    tissue::CorotatedModel model;
    tissue::CorotatedState state;
};

// Hinge k is node 3k; nodes 3k+1, 3k+2 stand off the middle of the link behind it and turn with
// it. Hinges start up to `kick_m` to the side.
String taut_string(double kick_m) {
    const double young_pa = 2e7, offset_m = 0.01;
    // V = l0 offset^2 / 6 and f = V sigma / l0 in uniaxial stress sigma (nu = 0)
    const double strain = 6 * kTension_n / (offset_m * offset_m * young_pa);
    const double rest_m = kSpacing_m / (1 + strain);
    tissue::TetMesh mesh;
    std::vector<std::uint8_t> flags;
    for (std::uint32_t k = 0; k <= kFree; ++k) {
        mesh.rest_m.push_back({k * rest_m, 0, 0});
        mesh.rest_m.push_back({(k + 0.5) * rest_m, offset_m, 0});
        mesh.rest_m.push_back({(k + 0.5) * rest_m, 0, offset_m});
        flags.insert(flags.end(), {k == 0 ? std::uint8_t{1} : std::uint8_t{0}, 0, 0});
        mesh.tets.push_back({3 * k, 3 * k + 3, 3 * k + 1, 3 * k + 2});
    }
    mesh.rest_m.push_back({(kFree + 1) * rest_m, 0, 0});
    flags.push_back(1);

    String s{tissue::make_corotated(mesh, bodies::elastic(young_pa, 0.0), flags), {}};
    s.state = tissue::rest_state(s.model);
    std::vector<dvec3>& x = s.state.position_m;
    std::mt19937_64 random(2);
    for (std::size_t i = 0; i < x.size(); ++i) {
        s.model.mass_kg[i] = i % 3 == 0 ? kMass_kg : 1e-6 * kMass_kg; // the rest only carries
        x[i].x *= 1 + strain;
        if (i % 3 == 0 && !flags[i])
            x[i].y = kick_m * bodies::signed_unit(random);
    }
    for (std::size_t i = 0; i + 3 < x.size(); i += 3) {
        const double middle = 0.5 * (x[i].y + x[i + 3].y);
        const double turn = (x[i + 3].y - x[i].y) / kSpacing_m;
        x[i + 1] += dvec3{-turn * offset_m, middle, 0};
        x[i + 2].y += middle;
    }
    return s;
}

double sag_m(const String& s) {
    double largest = 0.0;
    for (std::size_t i = 0; i < s.state.position_m.size(); i += 3) {
        largest = std::max(
            {largest, std::abs(s.state.position_m[i].y), std::abs(s.state.position_m[i].z)});
    }
    return largest;
}

// Largest sag within the last tenth of a run over the sag at its start.
double growth(double dt_s, int steps, bool exact) {
    String s = taut_string(1e-8);
    tissue::CorotatedSystem system = tissue::make_system(s.model);
    const double start_m = sag_m(s);
    double last_m = 0.0;
    for (int i = 0; i < steps; ++i) {
        bodies::step(s.model, s.state, system, dt_s, exact);
        CHECK(system.exact_tangent == exact);
        if (i >= steps - steps / 10)
            last_m = std::max(last_m, sag_m(s));
        if (!(sag_m(s) < 1e3 * start_m))
            return 1e3; // gone
    }
    return last_m / start_m;
}

double critical_dt_s() {
    const double w = 2.0 * std::sqrt(kTension_n / (kMass_kg * kSpacing_m)) *
                     std::sin(kFree * glm::pi<double>() / 32.0);
    return 2.0 / w;
}

} // namespace

TEST_CASE("the string of the tests has the tension it should have") {
    CHECK(critical_dt_s() == doctest::Approx(4.494e-3).scale(0.0).epsilon(1e-4));
    const String s = taut_string(0.0);
    std::vector<dvec3> f(s.state.position_m.size());
    tissue::elastic_forces(s.model, s.state, f);
    CHECK(f.front().x == doctest::Approx(-kTension_n).scale(0.0).epsilon(1e-6));
    CHECK(f.back().x == doctest::Approx(kTension_n).scale(0.0).epsilon(1e-6));
}

TEST_CASE("without the derivative of the rotation a taut string is stable up to 2/w_max only") {
    CHECK(growth(0.99 * critical_dt_s(), 2000, false) < 5.0);
    CHECK(growth(1.01 * critical_dt_s(), 2000, false) >= 1e3);
    CHECK(growth(5.0 * critical_dt_s(), 2000, false) >= 1e3);
}

TEST_CASE("with the exact tangent a taut string decays at five times that step") {
    CHECK(growth(5.0 * critical_dt_s(), 200, true) < 1e-3);
}
