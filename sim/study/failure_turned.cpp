// F14, linear elasticity turned: a cube turned as a whole by theta has the ghost strain
// cos(theta) - 1 across the axis, and pulls itself together with (lambda + mu) 2 (cos(theta) - 1),
// although nothing strains it. The "rotation" that it takes for one, I + tan(theta) skew, swells by
// 1/cos^2(theta). Everyone else must not feel to be turned, whatever the axis.
#include "sim/study/failure_bench.h"

#include "tissue/baseline/mass_spring.h"
#include "tissue/baseline/projective.h"
#include "tissue/baseline/tled.h"
#include "tissue/baseline/xpbd.h"
#include "tissue/solver/quadratic.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

namespace sim::failure {
namespace {

constexpr double kEdge_m = 0.03, kYoung_pa = 10e3, kPoisson = 0.45;
constexpr double kUnit_n = kYoung_pa * kEdge_m * kEdge_m; // of a strain of 1
constexpr double kNothing = 1e-9;

const tissue::Material kMaterial{.young_pa = kYoung_pa,
                                 .poisson = kPoisson,
                                 .damping_mass_1ps = 0.0,
                                 .damping_stiffness_s = 0.0,
                                 .source = "design value"};

std::vector<dvec3> moved(const std::vector<dvec3>& rest_m, const glm::dmat3& by) {
    std::vector<dvec3> out;
    for (const dvec3& x : rest_m)
        out.push_back(by * x);
    return out;
}

double greatest(const std::vector<dvec3>& force_n) {
    double most = 0.0;
    for (const dvec3& f : force_n)
        most = std::max(most, glm::length(f));
    return most / kUnit_n;
}

/// Nodal forces K u of the stiffness at rest.
struct Linear {
    tissue::CorotatedModel model;
    tissue::CorotatedSystem system;

    explicit Linear(const tissue::TetMesh& mesh)
        : model(tissue::make_corotated(mesh, kMaterial, {})), system(tissue::make_system(model)) {
        tissue::linearize(model, tissue::rest_state(model), 1.0, system);
    }
    std::vector<dvec3> forces(const std::vector<dvec3>& at_m) const {
        std::vector<double> u_m(static_cast<std::size_t>(model.unknowns)), f_n(u_m);
        for (std::size_t i = 0; i < at_m.size(); ++i)
            for (int k = 0; k < 3; ++k)
                u_m[3 * i + static_cast<std::size_t>(k)] = at_m[i][k] - model.mesh.rest_m[i][k];
        tissue::multiply(model.pattern, system.stiffness, u_m, f_n);
        std::vector<dvec3> out;
        for (std::size_t i = 0; i < at_m.size(); ++i)
            out.push_back({f_n[3 * i], f_n[3 * i + 1], f_n[3 * i + 2]});
        return out;
    }
};

void linear_turned(const tissue::TetMesh& mesh, Rows& rows) {
    const Linear linear(mesh);
    const double lambda = linear.model.lambda_pa, mu = linear.model.mu_pa;
    for (const double degrees : {10.0, 30.0, 90.0}) {
        const double c = std::cos(degrees * kPi / 180.0), s = std::sin(degrees * kPi / 180.0);
        const std::vector<dvec3> f =
            linear.forces(moved(mesh.rest_m, glm::dmat3{c, s, 0, -s, c, 0, 0, 0, 1}));
        double pull_n = 0.0; // of what is inside on the face x = edge, along x
        for (std::size_t i = 0; i < f.size(); ++i)
            pull_n += mesh.rest_m[i].x > kEdge_m - 1e-9 ? f[i].x : 0.0;
        const std::string at = fmt::format("turned by {:.0f} deg: ", degrees);
        rows.near("F14", "linear", at + "pull on a face, kPa", 1e-3 * pull_n / (kEdge_m * kEdge_m),
                  2e-3 * (lambda + mu) * (c - 1.0), 1e-9, true);
        rows.at_most("F14", "linear", at + "greatest nodal force, of E h^2", greatest(f), kNothing,
                     true);
    }
    for (const double degrees : {10.0, 30.0, 45.0}) {
        const double t = std::tan(degrees * kPi / 180.0);
        const auto at_m = moved(mesh.rest_m, glm::dmat3{1, t, 0, -t, 1, 0, 0, 0, 1});
        const std::string at = fmt::format("free of force by {:.0f} deg: ", degrees);
        rows.near("F14", "linear", at + "volume, of rest",
                  tissue::volume_m3(mesh, at_m) / tissue::volume_m3(mesh, mesh.rest_m), 1.0 + t * t,
                  1e-9, true);
        rows.at_most("F14", "linear", at + "greatest nodal force, of E h^2",
                     greatest(linear.forces(at_m)), kNothing, false);
    }
}

/// Of elastic_forces().
template <typename Model, typename State>
double force_of(const Model& model, State state, const glm::dmat3& turn) {
    state.position_m = moved(state.position_m, turn);
    std::vector<dvec3> force_n(state.position_m.size());
    tissue::elastic_forces(model, state, force_n);
    return greatest(force_n);
}

double quadratic_force(const tissue::QuadraticModel& model, const glm::dmat3& turn) {
    tissue::QuadraticState state = tissue::rest_state(model);
    state.position_m = moved(state.position_m, turn);
    tissue::QuadraticSystem system = tissue::make_system(model, 1.0);
    tissue::linearize(model, state, system);
    std::vector<double> way_m(static_cast<std::size_t>(model.unknowns)), residual_n(way_m);
    tissue::way_and_residual(model, system, way_m, residual_n);
    std::vector<dvec3> force_n;
    for (std::size_t i = 0; i < residual_n.size(); i += 3)
        force_n.push_back({residual_n[i], residual_n[i + 1], residual_n[i + 2]});
    return greatest(force_n);
}

} // namespace

void rigid_turns(std::uint64_t seed, Rows& rows) {
    const tissue::TetMesh mesh = tissue::box_mesh(dvec3(kEdge_m), {4, 4, 4}, 0.1, seed);
    linear_turned(mesh, rows);

    const auto corotated = tissue::make_corotated(mesh, kMaterial, {});
    const auto quadratic = tissue::make_quadratic(tissue::quadratic_mesh(mesh), kMaterial, {});
    const auto springs = tissue::make_mass_spring(mesh, kMaterial, {});
    const auto tled = tissue::make_tled(mesh, kMaterial, {});
    const auto projective = tissue::make_projective(mesh, kMaterial, {});
    const auto xpbd = tissue::make_xpbd(mesh, kMaterial, {});
    const tissue::BaselineState rest = tissue::rest_state(corotated);
    Random random{std::mt19937_64(seed)};
    double worst[6]{};
    for (const double degrees : {10.0, 30.0, 90.0, 179.0}) {
        const dvec3 axis{random.normal(), random.normal(), random.normal()};
        const glm::dmat3 turn =
            glm::mat3_cast(glm::angleAxis(degrees * kPi / 180.0, glm::normalize(axis)));
        tissue::BaselineState turned = rest;
        turned.position_m = moved(rest.position_m, turn);
        const double now[]{force_of(corotated, rest, turn),
                           quadratic_force(quadratic, turn),
                           force_of(springs, rest, turn),
                           force_of(tled, rest, turn),
                           force_of(projective, rest, turn),
                           std::abs(tissue::elastic_energy_j(xpbd, turned)) / (kUnit_n * kEdge_m)};
        for (std::size_t i = 0; i < 6; ++i)
            worst[i] = std::fmax(worst[i], now[i]);
    }
    const char* const names[]{"corotated", "quadratic", "mass-spring", "TLED", "projective"};
    for (std::size_t i = 0; i < 5; ++i)
        rows.at_most("F14", names[i], "turned by up to 179 deg: greatest nodal force, of E h^2",
                     worst[i], kNothing, false);
    rows.at_most("F14", "XPBD", "turned by up to 179 deg: energy, of E h^3", worst[5], kNothing,
                 false);
}

} // namespace sim::failure
