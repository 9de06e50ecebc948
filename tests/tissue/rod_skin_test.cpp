// The skin of a rod: where it goes, and that its rows are the derivative of that.
#include "tests/tissue/rods.h"
#include "tissue/rod/rod_skin.h"

#include <doctest/doctest.h>
#include <numbers>
#include <random>

using glm::dvec3;

namespace {

std::vector<dvec3> ring_points(double radius_m, double length_m) {
    std::vector<dvec3> x_m;
    for (int i = 0; i < 40; ++i) {
        const double angle = 2.4 * i;
        x_m.emplace_back(length_m * i / 39.0, radius_m * std::cos(angle),
                         radius_m * std::sin(angle));
    }
    return x_m;
}

} // namespace

TEST_CASE("the skin of a rod at rest is where it was") {
    const tissue::RodModel model = rods::straight({});
    const auto x_m = ring_points(3e-3, 0.1);
    const auto skin = attach(model, x_m);
    const tissue::RodState state = rest_state(model);
    for (std::size_t i = 0; i < x_m.size(); ++i)
        CHECK(glm::distance(place_m(state, skin[i]), x_m[i]) < 1e-15);
}

TEST_CASE("the row of a skin vertex is the derivative of its place") {
    const tissue::RodModel model = rods::straight({.edges = 8});
    const auto skin = attach(model, ring_points(3e-3, 0.1));
    tissue::RodState state = rest_state(model);
    std::mt19937 random(4);
    std::normal_distribution<double> any(0.0, 2e-3);
    const auto n = static_cast<std::size_t>(model.unknowns);
    std::vector<double> du(n), row(n);
    const auto draw = [&](double factor) {
        for (double& d : du)
            d = factor * any(random);
    };
    draw(1.0);
    move(model, du, state);
    const dvec3 direction = glm::normalize(dvec3{1, -2, 3});
    for (const tissue::RodVertex& v : skin) {
        draw(1e-3);
        std::fill(row.begin(), row.end(), 0.0);
        add_row(model, state, v, direction, 1.0, row);
        double expected_m = 0.0, size_m = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            expected_m += row[i] * du[i];
            size_m += std::abs(row[i] * du[i]);
        }
        tissue::RodState plus = state, minus = state;
        move(model, du, plus);
        for (double& d : du)
            d = -d;
        move(model, du, minus);
        const double way_m = 0.5 * glm::dot(direction, place_m(plus, v) - place_m(minus, v));
        CHECK(std::abs(way_m - expected_m) < 1e-5 * size_m);
    }
}

TEST_CASE("the skin of a rod bent to a circle is the torus of that circle") {
    // a loose rod of n edges, laid along a circle of radius R at their lengths
    constexpr int kEdges = 40;
    const double length_m = 0.1, radius_m = 3e-3, circle_m = 0.05;
    std::vector<dvec3> node_m, bent_m;
    for (int i = 0; i <= kEdges; ++i) {
        const double s = length_m * i / kEdges, angle = s / circle_m;
        node_m.emplace_back(s, 0.0, 0.0);
        bent_m.emplace_back(circle_m * std::sin(angle), circle_m * (1 - std::cos(angle)), 0.0);
    }
    const tissue::Material material = rods::elastic();
    const std::array section{tissue::round_section(material, radius_m)};
    const tissue::RodModel model = make_rod(node_m, section, material, {}, dvec3{0.0});
    tissue::RodState state = rest_state(model);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns), 0.0);
    for (std::size_t i = 0; i < node_m.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            du[static_cast<std::size_t>(model.dof[i] + k)] = bent_m[i][k] - node_m[i][k];
    }
    move(model, du, state);
    for (const tissue::RodVertex& v : attach(model, ring_points(radius_m, length_m))) {
        const dvec3 x = place_m(state, v) - dvec3{0, circle_m, 0};
        const double tube_m = std::hypot(std::hypot(x.x, x.y) - circle_m, x.z);
        // of the chord's sagitta, h^2/(8 R) = 16 um
        CHECK(std::abs(tube_m - radius_m) < 2e-5);
    }
}

TEST_CASE("a load on the skin holds a clamped rod as the same load and moment on its line do") {
    // a couple about the line, F at +r and -F at -r: twist M L/(G J) at the end
    const tissue::RodModel model = rods::straight({.edges = 20});
    const double radius_m = 3e-3, force_n = 1e-4;
    const std::vector<dvec3> x_m{{0.1, radius_m, 0}, {0.1, -radius_m, 0}};
    const auto skin = attach(model, x_m);
    tissue::RodState state = rest_state(model);
    tissue::RodSystem system = make_system(model);
    std::vector<double> load_n(static_cast<std::size_t>(model.unknowns), 0.0);
    add_row(model, state, skin[0], {0, 0, 1}, force_n, load_n);
    add_row(model, state, skin[1], {0, 0, 1}, -force_n, load_n);
    rods::step(model, rods::kStatics_s, load_n, system, state);
    const double turn_rad =
        2 * radius_m * force_n * (0.1 - 0.5 * 0.1 / 20) / model.section[0].twist_nm2;
    const dvec3 across = place_m(state, skin[0]) - place_m(state, skin[1]);
    CHECK(std::atan2(across.z, across.y) == doctest::Approx(turn_rad).scale(0.0).epsilon(1e-6));
}
