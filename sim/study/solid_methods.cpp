#include "sim/study/solid_methods.h"

#include <algorithm>

namespace sim {
namespace {

using glm::dvec3;

constexpr double kNoTime_s = std::numeric_limits<double>::infinity(); // statics

// Of nodal forces on the punch, against its way.
double push_of(const SolidBody& body, std::span<const dvec3> force_n) {
    double sum = 0.0;
    for (std::size_t i = 0; i < force_n.size(); ++i)
        if (body.punched[i] != 0)
            sum += glm::dot(force_n[i], body.load_direction);
    return sum;
}

} // namespace

std::vector<std::uint8_t> anchors_of(const SolidBody& body) {
    std::vector<std::uint8_t> out = body.clamped;
    for (std::size_t i = 0; i < body.punched.size(); ++i)
        out[i] = out[i] != 0 || body.punched[i] != 0 ? 1 : 0;
    return out;
}

dvec3 gravity_of(const SolidCase& work) {
    return {0.0, -work.gravity_mps2, 0.0};
}

CorotatedMethod::CorotatedMethod(const SolidCase& work, const SolidBody& b)
    : body(b), dt_s(work.dt_s),
      model(tissue::make_corotated(b.corners, work.material, anchors_of(b), gravity_of(work))),
      state(rest_state(model)), system(make_system(model)), chord(make_chord(model)),
      load_n(static_cast<std::size_t>(model.unknowns), 0.0), du(load_n) {}

void CorotatedMethod::set_load_n(double force_n) {
    for (std::size_t i = 0; i < model.dof.size(); ++i)
        for (int k = 0; model.dof[i] >= 0 && k < 3; ++k)
            load_n[model.dof[i] + k] = force_n * body.load_share[i] * body.load_direction[k];
}

SolidEffort CorotatedMethod::step() {
    const bool punched = !body.punched.empty();
    if (!linearised || punched)
        linearize(model, state, dt_s, system);
    const tissue::StepReport report = free_motion(model, state, system, du, load_n);
    int iterations = 1;
    if (!punched) {
        const tissue::FreshEnd end = end_or_begin_again(model, load_n, du, system, chord, state);
        iterations += end.new_tangent ? 3 : 1;
        linearised = end.end.made;
    }
    if (!linearised)
        advance(model, du, dt_s, state);
    return {.newton = iterations,
            .linear = iterations,
            .linear_residual = report.relative_residual,
            .converged = system.factored};
}

// As QuadraticReport::relative_residual: M (v' - v)/dt + alpha M v' + f_int(x') - f.
double CorotatedMethod::audit(std::span<const dvec3> before_mps) const {
    if (model.material.damping_stiffness_s > 0.0)
        return kUnknown; // its tangent is that of the beginning
    std::vector<dvec3> elastic(model.dof.size());
    elastic_forces(model, state, elastic);
    double left = 0.0, momentum = 0.0, inertia = 0.0, internal = 0.0;
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        internal += glm::dot(elastic[i], elastic[i]);
        const std::int32_t d = model.dof[i];
        const dvec3 load = d < 0 ? dvec3{0.0} : dvec3{load_n[d], load_n[d + 1], load_n[d + 2]};
        const double mass = model.mass_kg[i];
        const dvec3 given = load + mass * (model.gravity_mps2 + before_mps[i] / dt_s);
        const dvec3 taken =
            mass * (1.0 / dt_s + model.material.damping_mass_1ps) * state.velocity_mps[i];
        momentum += glm::dot(given, given);
        inertia += glm::dot(taken, taken);
        const dvec3 r = taken + elastic[i] - given;
        left += d < 0 ? 0.0 : glm::dot(r, r);
    }
    return std::sqrt(left) / (std::sqrt(momentum) + std::sqrt(internal) + std::sqrt(inertia));
}

SolidEffort CorotatedMethod::settle() {
    constexpr double kEnough = 1e-6; // near nu = 1/2 rounding keeps it from 1e-9
    linearised = false;
    const auto report = solve_static(model, load_n, 1e-9, 100, state);
    return {.newton = report.iterations,
            .linear = report.iterations,
            .linear_residual = kUnknown,
            .residual = report.relative_residual,
            .converged = report.relative_residual <= kEnough};
}

double CorotatedMethod::push_n() const {
    std::vector<dvec3> force(model.dof.size());
    elastic_forces(model, state, force);
    return push_of(body, force);
}

LinearMethod::LinearMethod(const SolidCase& work, const SolidBody& b)
    : corotated(work, b), dt_s(work.statics ? kNoTime_s : work.dt_s) {
    linearize(corotated.model, corotated.state, dt_s, corotated.system);
    loaded_n.assign(corotated.load_n.size(), 0.0);
}

void LinearMethod::set_load_n(double force_n) {
    corotated.set_load_n(force_n);
    for (std::size_t k = 0; k < loaded_n.size(); ++k)
        corotated.system.internal_n[k] -= corotated.load_n[k] - loaded_n[k];
    loaded_n = corotated.load_n;
}

SolidEffort LinearMethod::step() {
    auto& c = corotated;
    const tissue::StepReport report = free_motion(c.model, c.state, c.system, c.du);
    follow_tangent(c.model, c.du, c.system);
    advance(c.model, c.du, dt_s, c.state);
    return {.newton = 1,
            .linear = 1,
            .linear_residual = report.relative_residual,
            .residual = report.relative_residual,
            .converged = c.system.factored};
}

ReferenceMethod::ReferenceMethod(const SolidCase& work, const SolidBody& b)
    : body(b), dt_s(work.dt_s), model([&] {
          std::vector<std::uint8_t> held = anchors_of(b);
          for (std::uint8_t& h : held)
              h = h != 0 ? tissue::kHeld : 0;
          const auto law =
              work.model == "linear" ? tissue::Law::small_strain : tissue::Law::neo_hooke;
          return tissue::make_reference(b.quadratic, work.material, law, held, gravity_of(work));
      }()),
      state(rest_state(model)), system(make_system(model)), load_n(b.rest_m.size(), dvec3{0.0}),
      wanted_m(state.position_m) {}

void ReferenceMethod::set_load_n(double force_n) {
    for (std::size_t i = 0; i < load_n.size(); ++i)
        load_n[i] = force_n * body.load_share[i] * body.load_direction;
}

SolidEffort ReferenceMethod::take(const tissue::NewtonReport& report) {
    wanted_m = state.position_m;
    last_residual = report.relative_residual;
    return {.newton = report.iterations,
            .linear = report.iterations,
            .residual = report.relative_residual,
            .converged = report.reached == 1.0 && report.relative_residual < 1e-6};
}

SolidEffort ReferenceMethod::step() {
    return take(tissue::step(model, {load_n, wanted_m}, dt_s, tissue::TimeRule::implicit_euler,
                             {.tolerance = 1e-8}, system, state));
}

SolidEffort ReferenceMethod::settle() {
    return take(solve_static(model, {load_n, wanted_m}, {}, system, state));
}

double ReferenceMethod::push_n() const {
    std::vector<dvec3> force(body.rest_m.size());
    elastic_forces(model, state.position_m, force);
    return push_of(body, force);
}

QuadraticMethod::QuadraticMethod(const SolidCase& work, const SolidBody& b)
    : body(b),
      model(tissue::make_quadratic(b.quadratic, work.material, anchors_of(b), gravity_of(work))),
      state(rest_state(model)), system(make_system(model, work.dt_s)), weight_n(model.weight_n),
      du(static_cast<std::size_t>(model.unknowns)), length_m(work.length_m) {}

void QuadraticMethod::set_load_n(double force_n) {
    model.weight_n = weight_n;
    for (std::size_t i = 0; i < body.rest_m.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            model.weight_n[4 * i + k] +=
                force_n * body.load_share[i] * body.load_direction[static_cast<int>(k)];
}

SolidEffort QuadraticMethod::step(tissue::QuadraticSystem& at,
                                  const tissue::QuadraticOptions& options) {
    linearize(model, state, at);
    const tissue::QuadraticReport report = free_motion(model, options, at, du);
    advance(model, at, du, state);
    last_residual = report.relative_residual;
    return {.newton = report.newton_iterations,
            .linear = report.linear_iterations,
            .linear_residual = report.linear_residual,
            .residual = report.relative_residual,
            .converged = !report.recovering};
}

SolidEffort QuadraticMethod::step() {
    return step(system, {});
}

// There are only steps: begun at rest each, twice as long as the last, so that inertia vanishes.
SolidEffort QuadraticMethod::settle() {
    constexpr int kSteps = 18;          // the last 1e5 times as long as the first
    constexpr double kTolerance = 1e-7; // of the residual, whose products are in single precision
    const tissue::QuadraticOptions options{.linear_tolerance = 1e-4,
                                           .max_linear = 1000,
                                           .newton_tolerance = kTolerance,
                                           .max_newton = 30};
    const double wave_s = length_m * std::sqrt(model.material.density_kgpm3 /
                                               model.material.young_pa); // from end to end
    SolidEffort sum{.linear_residual = 0.0};
    double dt_s = wave_s;
    for (int i = 0; i < kSteps; ++i, dt_s *= 2.0) {
        auto at = make_system(model, dt_s);
        for (auto* v : {&state.velocity_mps, &state.gain_mps})
            std::fill(v->begin(), v->end(), dvec3{0.0});
        const SolidEffort effort = step(at, options);
        system.internal_n = at.internal_n;
        sum.newton += effort.newton;
        sum.linear += effort.linear;
        sum.linear_residual = std::max(sum.linear_residual, effort.linear_residual);
        sum.residual = effort.residual;
    }
    for (auto* v : {&state.velocity_mps, &state.gain_mps})
        std::fill(v->begin(), v->end(), dvec3{0.0});
    sum.converged = sum.residual < 1e-5;
    return sum;
}

double QuadraticMethod::push_n() const {
    std::vector<dvec3> force;
    for (std::size_t i = 0; i < body.rest_m.size(); ++i)
        force.emplace_back(system.internal_n[4 * i], system.internal_n[4 * i + 1],
                           system.internal_n[4 * i + 2]);
    return push_of(body, force);
}

} // namespace sim
