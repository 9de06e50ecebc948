// Rods on springs: the line of a tube in a medium, and what it is held by.
#include "tests/tissue/rods.h"
#include "tissue/rod/rod_line.h"

#include <doctest/doctest.h>
#include <numbers>
#include <stdexcept>

using glm::dvec3;
using std::numbers::pi;

namespace {

constexpr double kRadius_m = 3e-3, kLength_m = 0.4;

tissue::RodLine line_along_x(int edges) {
    tissue::RodLine line;
    for (int i = 0; i <= edges; ++i)
        line.node_m.emplace_back(kLength_m * i / edges, 0.0, 0.0);
    line.radius_m.assign(line.node_m.size(), kRadius_m);
    line.held.assign(line.node_m.size(), 0);
    line.hold_m.assign(line.node_m.size(), 0.0);
    return line;
}

} // namespace

TEST_CASE("a rod in a medium sinks under a load as a beam on Winkler's foundation") {
    // Hetenyi 1946: w(x) = P b/(2 k) exp(-b |x|) (cos b|x| + sin b|x|), b^4 = k/(4 E I)
    tissue::RodLine line = line_along_x(400);
    line.bed_pa = 2e3;
    const tissue::RodModel model = make_rod(line, rods::elastic(), dvec3{0.0});
    const double bend_nm2 = 30e3 * pi / 4 * std::pow(kRadius_m, 4), load_n = 1e-4;
    const double b_1pm = std::pow(line.bed_pa / (4 * bend_nm2), 0.25);
    REQUIRE(b_1pm * 1e-3 < 0.15);          // an edge is short beside the wave
    REQUIRE(b_1pm * 0.5 * kLength_m > 10); // the ends are far
    tissue::RodState state = rest_state(model);
    tissue::RodSystem system = make_system(model);
    CHECK(rods::step(model, rods::kStatics_s, rods::load_at(model, 200, {0, 0, load_n}), system,
                     state)
              .converged);
    const double most_m = load_n * b_1pm / (2 * line.bed_pa);
    for (const std::size_t i : {200u, 202u, 204u, 210u, 220u}) {
        const double x = b_1pm * 1e-3 * static_cast<double>(i - 200);
        const double expected_m = most_m * std::exp(-x) * (std::cos(x) + std::sin(x));
        CHECK(std::abs(state.position_m[i].z - expected_m) < 0.01 * most_m);
    }
}

TEST_CASE("a held stretch of line has the stiffness of its volume over L squared") {
    tissue::RodLine line = line_along_x(37);
    const double from_m = 0.1, to_m = 0.25, hold_length_m = 5e-3, young_pa = 30e3;
    hold_line([&](const dvec3& x) { return x.x > from_m && x.x < to_m; }, hold_length_m, line);
    const double expected_npm =
        young_pa * pi * kRadius_m * kRadius_m * (to_m - from_m) / (hold_length_m * hold_length_m);
    CHECK(hold_npm(line, young_pa) == doctest::Approx(expected_npm).scale(0.0).epsilon(2e-3));
    // all of it moved aside or turned about itself: the energy of the springs
    const tissue::RodModel model = make_rod(line, rods::elastic(young_pa), dvec3{0.0});
    tissue::RodState state = rest_state(model);
    std::vector<double> aside(static_cast<std::size_t>(model.unknowns), 0.0), turned = aside;
    for (const auto d : model.dof)
        aside[static_cast<std::size_t>(d + 1)] = 1e-3;
    for (const auto d : model.spin)
        turned[static_cast<std::size_t>(d)] = 0.1;
    move(model, aside, state);
    CHECK(elastic_energy_j(model, state) ==
          doctest::Approx(0.5 * expected_npm * 1e-6).scale(0.0).epsilon(2e-3));
    state = rest_state(model);
    move(model, turned, state);
    CHECK(elastic_energy_j(model, state) ==
          doctest::Approx(0.5 * expected_npm * kRadius_m * kRadius_m / 2 * 0.01)
              .scale(0.0)
              .epsilon(2e-3));
    CHECK(has_hold(line));
    CHECK_FALSE(has_hold(line_along_x(3)));
}

TEST_CASE("springs that are negative, too few, or a material with a memory are refused") {
    tissue::RodLine line = line_along_x(4);
    line.hold_m[2] = -1.0;
    CHECK_THROWS_WITH_AS(make_rod(line, rods::elastic(), dvec3{0.0}), doctest::Contains("spring 2"),
                         std::invalid_argument);
    line.hold_m.pop_back();
    CHECK_THROWS_AS(make_rod(line, rods::elastic(), dvec3{0.0}), std::invalid_argument);
    auto viscous = rods::elastic();
    viscous.prony = {{0.3, 0.5}};
    CHECK_THROWS_WITH_AS(make_rod(line_along_x(4), viscous, dvec3{0.0}), doctest::Contains("Prony"),
                         std::invalid_argument);
}
