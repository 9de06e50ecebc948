// Rods in motion: frequency, momentum, energy, rotation, what is folded or not finite.
#include "tests/tissue/allocations.h"
#include "tests/tissue/rods.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

using glm::dvec3;
using rods::kStatics_s;
using rods::load_at;
using std::numbers::pi;

namespace {

tissue::RodModel loose(int edges, double length_m = 0.1) {
    std::vector<dvec3> node_m;
    for (int i = 0; i <= edges; ++i)
        node_m.emplace_back(length_m * i / edges, 0.0, 0.0);
    const tissue::Material material = rods::elastic();
    const std::array section{tissue::round_section(material, 2e-3)};
    return tissue::make_rod(node_m, section, material, {}, dvec3{0.0});
}

void shake(tissue::RodState& state, unsigned seed, double speed_mps) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-speed_mps, speed_mps);
    for (dvec3& v : state.velocity_mps)
        v = {any(random), any(random), any(random)};
}

double kinetic_j(const tissue::RodModel& model, const tissue::RodState& state) {
    double sum_j = 0.0;
    for (std::size_t i = 0; i < model.mass_kg.size(); ++i) {
        if (model.dof[i] >= 0)
            sum_j +=
                0.5 * model.mass_kg[i] * glm::dot(state.velocity_mps[i], state.velocity_mps[i]);
    }
    for (std::size_t e = 0; e < model.spin.size(); ++e)
        sum_j += 0.5 * model.inertia_kgm2[e] * state.spin_radps[e] * state.spin_radps[e];
    return sum_j;
}

} // namespace

TEST_CASE("a cantilever swings at 1.8751^2 sqrt(E I/(rho A L^4))/(2 pi)") {
    const tissue::RodModel model = rods::straight({.radius_m = 2e-3, .edges = 30});
    const auto& section = model.section[0];
    const double frequency_hz =
        std::pow(1.875104, 2) / (2 * pi) * std::sqrt(section.bend_nm2 / section.mass_kgpm / 1e-4);
    tissue::RodState state = rest_state(model);
    tissue::RodSystem system = make_system(model);
    const std::size_t end = model.rest_m.size() - 1;
    rods::step(model, kStatics_s, load_at(model, end, {0, 1e-7, 0}), system, state);
    // implicit Euler: atan(w dt)/dt for w, at 1000 steps a turn 1.3e-5 lower
    const double dt_s = 1e-3 / frequency_hz;
    std::vector<double> crossing_s;
    double before_m = state.position_m[end].y;
    for (int i = 1; i <= 3000; ++i) {
        rods::step(model, dt_s, {}, system, state, 1e-7);
        const double now_m = state.position_m[end].y;
        if ((now_m > 0) != (before_m > 0))
            crossing_s.push_back(dt_s * (i - now_m / (now_m - before_m)));
        before_m = now_m;
    }
    REQUIRE(crossing_s.size() >= 5);
    // higher modes, which the release excites, are gone after the first turns
    const double turn_s = crossing_s[crossing_s.size() - 1] - crossing_s[crossing_s.size() - 3];
    CHECK(1.0 / turn_s == doctest::Approx(frequency_hz).scale(0.0).epsilon(0.01));
}

TEST_CASE("a loose rod keeps its momentum and, on the whole, its moment of momentum") {
    const tissue::RodModel model = loose(12);
    tissue::RodState state = rest_state(model);
    tissue::RodSystem system = make_system(model);
    shake(state, 5, 0.2);
    const auto sums = [&] {
        std::array<dvec3, 2> sum{dvec3{0.0}, dvec3{0.0}};
        for (std::size_t i = 0; i < model.mass_kg.size(); ++i) {
            const dvec3 p = model.mass_kg[i] * state.velocity_mps[i];
            sum[0] += p;
            sum[1] += glm::cross(state.position_m[i], p);
        }
        return sum;
    };
    const auto before = sums();
    for (int i = 0; i < 50; ++i)
        CHECK(rods::step(model, 0.02, {}, system, state, 1e-12).relative_residual < 1e-9);
    const auto after = sums();
    CHECK(glm::length(after[0] - before[0]) < 1e-8 * glm::length(before[0]));
    // implicit Euler loses moment of momentum, and never gains
    CHECK(glm::length(after[1]) < glm::length(before[1]));
}

TEST_CASE("no step of 20 ms gains energy, whatever the motion") {
    for (const unsigned seed : {1u, 2u, 3u}) {
        const tissue::RodModel model = rods::straight({.edges = 15, .both = true});
        tissue::RodState state = rest_state(model);
        tissue::RodSystem system = make_system(model);
        shake(state, seed, 1.0);
        for (std::size_t i = 0; i < state.velocity_mps.size(); ++i) {
            if (model.dof[i] < 0)
                state.velocity_mps[i] = dvec3{0.0};
        }
        double before_j = kinetic_j(model, state) + elastic_energy_j(model, state);
        for (int i = 0; i < 100; ++i) {
            rods::step(model, 0.02, {}, system, state, 1e-9);
            const double now_j = kinetic_j(model, state) + elastic_energy_j(model, state);
            CHECK(now_j <= before_j * (1 + 1e-9) + 1e-18);
            before_j = now_j;
        }
    }
}

TEST_CASE("a turned rod has the energy and the turned forces of the other") {
    const tissue::RodModel model = rods::straight({.edges = 10});
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), 1.1, glm::normalize(dvec3{1, 2, -3})));
    std::vector<dvec3> node_m;
    std::vector<std::uint8_t> held;
    for (std::size_t i = 0; i < model.rest_m.size(); ++i) {
        node_m.push_back(turn * model.rest_m[i]);
        held.push_back(model.dof[i] < 0 ? 1 : 0);
    }
    const tissue::RodModel other =
        make_rod(node_m, model.section, model.material, held, dvec3{0.0});
    tissue::RodState a = rest_state(model), b = rest_state(other);
    std::mt19937 random(11);
    std::normal_distribution<double> any(0.0, 2e-3);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns)), turned_du(du);
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        const dvec3 d{any(random), any(random), any(random)}, t = turn * d;
        for (int k = 0; k < 3; ++k) {
            du[static_cast<std::size_t>(model.dof[i] + k)] = d[k];
            turned_du[static_cast<std::size_t>(model.dof[i] + k)] = t[k];
        }
    }
    move(model, du, a);
    move(other, turned_du, b);
    CHECK(elastic_energy_j(other, b) ==
          doctest::Approx(elastic_energy_j(model, a)).scale(0.0).epsilon(1e-11));
    std::vector<double> fa(du.size()), fb(du.size());
    elastic_forces(model, a, fa);
    elastic_forces(other, b, fb);
    const auto at = [&](const std::vector<double>& f, std::size_t i) {
        const auto d = static_cast<std::size_t>(model.dof[i]);
        return dvec3{f[d], f[d + 1], f[d + 2]};
    };
    for (std::size_t i = 2; i < model.dof.size(); ++i)
        CHECK(glm::length(turn * at(fa, i) - at(fb, i)) < 1e-10);
}

TEST_CASE("the tangent of a bent and twisted rod is the derivative of its forces") {
    const tissue::RodModel model = rods::straight({.edges = 6});
    tissue::RodState state = rest_state(model);
    std::mt19937 random(2);
    std::normal_distribution<double> any(0.0, 1.0);
    const auto n = static_cast<std::size_t>(model.unknowns);
    std::vector<double> du(n), product(n);
    const auto draw = [&](double size) {
        for (double& d : du)
            d = size * any(random);
        for (const std::int32_t s : model.spin) {
            if (s >= 0)
                du[static_cast<std::size_t>(s)] *= 100.0; // radians, not metres
        }
    };
    draw(3e-3);
    move(model, du, state);
    tissue::BandMatrix tangent = make_system(model).tangent;
    elastic_tangent(model, state, true, tangent);
    draw(1e-5); // second differences of the energy along any way
    tissue::multiply(tangent, du, product);
    double curve_j = 0.0;
    for (std::size_t i = 0; i < n; ++i)
        curve_j += du[i] * product[i];
    tissue::RodState plus = state, minus = state;
    move(model, du, plus);
    for (double& d : du)
        d = -d;
    move(model, du, minus);
    const double second_j = elastic_energy_j(model, plus) - 2 * elastic_energy_j(model, state) +
                            elastic_energy_j(model, minus);
    CHECK(curve_j == doctest::Approx(second_j).scale(0.0).epsilon(1e-4));
}

TEST_CASE("a rod recovers from a fold and from edges without length") {
    const tissue::RodModel model = rods::straight({.edges = 10, .both = true});
    for (const bool fold : {true, false}) {
        tissue::RodState state = rest_state(model);
        tissue::RodSystem system = make_system(model);
        std::vector<double> du(static_cast<std::size_t>(model.unknowns), 0.0);
        // node 6 onto node 4: edges 4 and 5 opposite; or onto node 5 as well: no length at all
        du[static_cast<std::size_t>(model.dof[6])] = fold ? -0.02 : -0.01;
        move(model, du, state);
        for (int i = 0; i < 200; ++i)
            rods::step(model, 0.02, {}, system, state, 1e-6);
        for (std::size_t i = 0; i < state.position_m.size(); ++i)
            CHECK(glm::distance(state.position_m[i], model.rest_m[i]) < 1e-5);
    }
}

TEST_CASE("a motion or a load that is not finite leaves a rod where it is") {
    const tissue::RodModel model = rods::straight({});
    tissue::RodState state = rest_state(model);
    tissue::RodSystem system = make_system(model);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns), 0.0), load_n(du);
    linearize(model, state, 0.02, system);
    du[7] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(end_step(model, {}, {}, du, system, state).converged);
    load_n[3] = std::numeric_limits<double>::infinity();
    CHECK_FALSE(rods::step(model, 0.02, load_n, system, state).converged);
    for (std::size_t i = 0; i < state.position_m.size(); ++i)
        CHECK(state.position_m[i] == model.rest_m[i]);
    CHECK(rods::step(model, 0.02, load_at(model, 9, {0, 1e-5, 0}), system, state).converged);
}

TEST_CASE("a step allocates nothing, and the band it factors grows as the nodes do") {
    for (const int edges : {20, 40, 80}) {
        const tissue::RodModel model = rods::straight({.edges = edges});
        tissue::RodState state = rest_state(model);
        tissue::RodSystem system = make_system(model);
        CHECK(system.factor.value.size() == 11 * static_cast<std::size_t>(4 * edges));
        const auto load_n = load_at(model, 5, {0, 1e-4, 0});
        std::vector<double> du(static_cast<std::size_t>(model.unknowns));
        const std::size_t before = bodies::allocations();
        linearize(model, state, 0.02, system);
        free_motion(model, system, load_n, du);
        end_step(model, load_n, {}, du, system, state);
        CHECK(bodies::allocations() == before);
    }
}
