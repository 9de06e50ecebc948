// Implicit Euler of a rod: one linear motion, or the minimum of the step's potential
//   E(x) - (f + w).d + |d - dt v|_M^2/(2 dt^2) + d.(alpha M + beta K0) d/(2 dt),  d: the motion.
// See rod.h.
#include "tissue/rod/rod.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tissue {
namespace {

using glm::dvec3;
using std::size_t;

double product(std::span<const double> a, std::span<const double> b) noexcept {
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

double size_of(std::span<const double> a) noexcept {
    return std::sqrt(product(a, a));
}

double load_at(std::span<const double> load_n, size_t i) noexcept {
    return load_n.empty() ? 0.0 : load_n[i];
}

// Sets K, exact if A is positive definite with it, and the factor of A.
void make_factor(const RodModel& model, const RodState& state, RodSystem& s) noexcept {
    const double rate_1ps = 1.0 / s.dt_s, beta_s = model.material.damping_stiffness_s;
    const double inertial_1ps2 = rate_1ps * (rate_1ps + model.material.damping_mass_1ps);
    for (const bool exact : {true, false}) {
        elastic_tangent(model, state, exact, s.tangent);
        s.projected = !exact;
        for (size_t k = 0; k < s.tangent.value.size(); ++k)
            s.factor.value[k] = s.tangent.value[k] + beta_s * rate_1ps * s.damping.value[k];
        for (int i = 0; i < model.unknowns; ++i)
            s.factor.value[s.factor.at(i, i)] += inertial_1ps2 * model.mass[static_cast<size_t>(i)];
        if (factor(s.factor))
            return;
    }
    // nothing to lean on, as a loose rod in statics: a diagonal, so that steps stay finite
    std::fill(s.factor.value.begin(), s.factor.value.end(), 0.0);
    for (int i = 0; i < model.unknowns; ++i) {
        const double k = s.tangent.value[s.tangent.at(i, i)];
        s.factor.value[s.factor.at(i, i)] =
            k > 0.0 && std::isfinite(k) ? k : model.section[0].stretch_n / model.length_m[0];
    }
}

// The motion so far against inertia and damping: `right` = M (d/dt - v)/dt + C d/dt.
void resist(const RodModel& model, RodSystem& s) noexcept {
    const double rate_1ps = 1.0 / s.dt_s;
    multiply(s.damping, s.moved, s.scratch);
    for (size_t i = 0; i < s.moved.size(); ++i) {
        s.right[i] =
            model.mass[i] * rate_1ps *
                (s.moved[i] * (rate_1ps + model.material.damping_mass_1ps) - s.velocity[i]) +
            model.material.damping_stiffness_s * rate_1ps * s.scratch[i];
    }
}

double potential_j(const RodModel& model, std::span<const double> load_n, const RodState& at,
                   RodSystem& s) noexcept {
    double sum_j = elastic_energy_j(model, at);
    resist(model, s);
    const double rate_1ps = 1.0 / s.dt_s;
    for (size_t i = 0; i < s.moved.size(); ++i) // half of what is quadratic in d
        sum_j += s.moved[i] * (0.5 * s.right[i] - 0.5 * model.mass[i] * rate_1ps * s.velocity[i] -
                               model.weight_n[i] - load_at(load_n, i));
    return sum_j;
}

// Goes along `way` as far as the potential falls enough (Armijo). `slope_j`: along the whole way.
// False: it did not.
bool search(const RodModel& model, std::span<const double> load_n, std::span<const double> way,
            double slope_j, RodState& state, RodSystem& s) noexcept {
    const double before_j = potential_j(model, load_n, state, s);
    const double rounding_j = 1e-13 * (std::abs(before_j) + s.energy_j);
    double done = 0.0;
    for (double share = 1.0; share > 1e-5; share *= 0.5) {
        s.trial.position_m = state.position_m;
        s.trial.frame = state.frame;
        s.trial.turn_rad = state.turn_rad;
        for (size_t i = 0; i < way.size(); ++i) {
            s.moved[i] += (share - done) * way[i];
            s.scratch[i] = share * way[i];
        }
        done = share;
        move(model, s.scratch, s.trial);
        const double now_j = potential_j(model, load_n, s.trial, s);
        if (now_j <= before_j + 1e-4 * share * slope_j + rounding_j) {
            std::swap(state.position_m, s.trial.position_m);
            std::swap(state.frame, s.trial.frame);
            std::swap(state.turn_rad, s.trial.turn_rad);
            return true;
        }
    }
    for (size_t i = 0; i < way.size(); ++i)
        s.moved[i] -= done * way[i];
    return false;
}

// Residual of the step where `state` is, into `right`; relative to the sizes of its parts.
double residual(const RodModel& model, std::span<const double> load_n, const RodState& state,
                RodSystem& s) noexcept {
    elastic_forces(model, state, s.internal_n);
    resist(model, s);
    double load2 = 0.0;
    double size_n = size_of(s.internal_n) + size_of(s.right);
    for (size_t i = 0; i < s.right.size(); ++i) {
        const double f_n = model.weight_n[i] + load_at(load_n, i);
        load2 += f_n * f_n;
        s.right[i] = f_n - s.internal_n[i] - s.right[i];
    }
    size_n += std::sqrt(load2);
    return size_n > 0.0 ? size_of(s.right) / size_n : 0.0;
}

void read_velocity(const RodModel& model, const RodState& state, RodSystem& s) noexcept {
    for (size_t i = 0; i < model.dof.size(); ++i) {
        for (int k = 0; k < 3 && model.dof[i] >= 0; ++k)
            s.velocity[static_cast<size_t>(model.dof[i] + k)] = state.velocity_mps[i][k];
    }
    for (size_t e = 0; e < model.spin.size(); ++e) {
        if (model.spin[e] >= 0)
            s.velocity[static_cast<size_t>(model.spin[e])] = state.spin_radps[e];
    }
}

void write_velocity(const RodModel& model, const RodSystem& s, RodState& state) noexcept {
    for (size_t i = 0; i < model.dof.size(); ++i) {
        for (int k = 0; k < 3 && model.dof[i] >= 0; ++k)
            state.velocity_mps[i][k] = s.moved[static_cast<size_t>(model.dof[i] + k)] / s.dt_s;
    }
    for (size_t e = 0; e < model.spin.size(); ++e) {
        if (model.spin[e] >= 0)
            state.spin_radps[e] = s.moved[static_cast<size_t>(model.spin[e])] / s.dt_s;
    }
}

bool finite(std::span<const double> values) noexcept {
    return std::isfinite(product(values, values));
}

} // namespace

RodSystem make_system(const RodModel& model) {
    constexpr int kBand = 10; // of x_{i-1} to z_{i+1}
    const auto n = static_cast<size_t>(model.unknowns);
    RodSystem s;
    for (std::vector<double>* v :
         {&s.internal_n, &s.moved, &s.velocity, &s.right, &s.way, &s.scratch})
        v->assign(n, 0.0);
    s.tangent = s.damping = s.factor = make_band(model.unknowns, std::min(kBand, model.unknowns));
    s.trial = rest_state(model);
    return s;
}

void move(const RodModel& model, std::span<const double> du, RodState& state) noexcept {
    for (size_t i = 0; i < model.dof.size(); ++i) {
        for (int k = 0; k < 3 && model.dof[i] >= 0; ++k)
            state.position_m[i][k] += du[static_cast<size_t>(model.dof[i] + k)];
    }
    for (size_t e = 0; e < model.spin.size(); ++e) {
        const dvec3 along = state.position_m[e + 1] - state.position_m[e];
        const double length_m = glm::length(along);
        const dvec3 t =
            length_m > 1e-9 * model.length_m[e] ? along / length_m : state.frame[e].tangent;
        const double turn_rad = model.spin[e] < 0 ? 0.0 : du[static_cast<size_t>(model.spin[e])];
        state.frame[e] = moved(state.frame[e], t, turn_rad);
        state.turn_rad[e] += turn_rad;
    }
}

void linearize(const RodModel& model, const RodState& state, double dt_s,
               RodSystem& system) noexcept {
    system.dt_s = dt_s;
    elastic_tangent(model, state, false, system.damping);
    make_factor(model, state, system);
    elastic_forces(model, state, system.internal_n);
    system.energy_j = elastic_energy_j(model, state);
    read_velocity(model, state, system);
}

void free_motion(const RodModel& model, const RodSystem& system, std::span<const double> load_n,
                 std::span<double> du) noexcept {
    for (size_t i = 0; i < du.size(); ++i)
        du[i] = load_at(load_n, i) + model.weight_n[i] - system.internal_n[i] +
                model.mass[i] * system.velocity[i] / system.dt_s;
    solve(system.factor, du);
}

void solve(const RodSystem& system, std::span<double> block, int columns) noexcept {
    const auto n = static_cast<size_t>(system.factor.size);
    for (int c = 0; c < columns; ++c)
        solve(system.factor, block.subspan(static_cast<size_t>(c) * n, n));
}

RodReport end_step(const RodModel& model, std::span<const double> load_n, const RodOptions& options,
                   std::span<double> du, RodSystem& system, RodState& state) noexcept {
    RodReport report;
    RodSystem& s = system;
    std::fill(s.moved.begin(), s.moved.end(), 0.0);
    if (!finite(du) || !finite(load_n)) {
        std::fill(du.begin(), du.end(), 0.0);
        write_velocity(model, s, state);
        linearize(model, state, s.dt_s, s);
        return report;
    }
    std::copy(du.begin(), du.end(), s.way.begin());
    report.relative_residual = residual(model, load_n, state, s);
    while (report.relative_residual > options.tolerance) {
        report.projected = report.projected || s.projected;
        const double slope_j = -product(s.way, s.right);
        if (!search(model, load_n, s.way, slope_j, state, s))
            break;
        report.relative_residual = residual(model, load_n, state, s);
        if (!(report.relative_residual > options.tolerance) ||
            report.iterations >= options.max_iterations)
            break;
        make_factor(model, state, s);
        std::copy(s.right.begin(), s.right.end(), s.way.begin());
        solve(s.factor, s.way);
        ++report.iterations;
    }
    report.converged = report.relative_residual <= options.tolerance;
    std::copy(s.moved.begin(), s.moved.end(), du.begin());
    write_velocity(model, s, state);
    linearize(model, state, s.dt_s, s);
    return report;
}

} // namespace tissue
