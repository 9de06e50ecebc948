#include "tissue/solver/descent.h"

#include "tissue/solver/corotated_assembly.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using glm::dvec3;

dvec3 at_node(std::span<const double> x, std::int32_t dof) noexcept {
    return {x[dof], x[dof + 1], x[dof + 2]};
}

double product_of(std::span<const double> a, std::span<const double> b) noexcept {
    double sum = 0.0; // of as many as the shorter has: no load is no work
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        sum += a[i] * b[i];
    return sum;
}

double kinetic_j(const CorotatedModel& model, const CorotatedState& state) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < model.dof.size(); ++i)
        if (model.dof[i] >= 0)
            sum += 0.5 * model.mass_kg[i] * glm::dot(state.velocity_mps[i], state.velocity_mps[i]);
    return sum;
}

// Of the weight, from rest.
double potential_j(const CorotatedModel& model, const CorotatedState& state) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < model.dof.size(); ++i)
        if (model.dof[i] >= 0)
            sum -= model.mass_kg[i] *
                   glm::dot(model.gravity_mps2, state.position_m[i] - model.mesh.rest_m[i]);
    return sum;
}

double energy_j(const CorotatedModel& model, const CorotatedState& state) noexcept {
    return elastic_energy_j(model, state) + potential_j(model, state) + kinetic_j(model, state);
}

dvec3 momentum_ns(const CorotatedModel& model, const CorotatedState& state) noexcept {
    dvec3 sum{0.0};
    for (std::size_t i = 0; i < model.mass_kg.size(); ++i)
        sum += model.mass_kg[i] * state.velocity_mps[i];
    return sum;
}

// One descent: the step from descent.before under a held load.
struct Problem {
    const CorotatedModel& model;
    std::span<const double> load_n;
    double dt_s;
    CorotatedSystem& system;
    Descent& scratch;
};

// The body at motion + share way.
void place_trial(const Problem& p, double share) noexcept {
    Descent& s = p.scratch;
    for (std::size_t k = 0; k < s.trial_m.size(); ++k)
        s.trial_m[k] = s.motion_m[k] + share * s.way_m[k];
    for (std::size_t i = 0; i < p.model.dof.size(); ++i)
        if (p.model.dof[i] >= 0)
            s.trial.position_m[i] = s.before.position_m[i] + at_node(s.trial_m, p.model.dof[i]);
}

// E there.
double incremental_j(const Problem& p, double share) noexcept {
    Descent& s = p.scratch;
    place_trial(p, share);
    multiply(p.model.pattern, s.damping_nspm, s.trial_m, s.damped);
    double sum = elastic_energy_j(p.model, s.trial) + potential_j(p.model, s.trial) -
                 product_of(p.load_n, s.trial_m) + product_of(s.trial_m, s.damped) / (2.0 * p.dt_s);
    const double alpha_dt = p.model.material.damping_mass_1ps * p.dt_s;
    for (std::size_t i = 0; i < p.model.dof.size(); ++i) {
        if (p.model.dof[i] < 0)
            continue;
        const dvec3 rate = at_node(s.trial_m, p.model.dof[i]) / p.dt_s;
        const dvec3 change = rate - s.before.velocity_mps[i];
        sum +=
            0.5 * p.model.mass_kg[i] * (glm::dot(change, change) + alpha_dt * glm::dot(rate, rate));
    }
    return sum;
}

// grad E at the motion so far, where `system` is assembled. Returns its length.
double find_gradient(const Problem& p) noexcept {
    Descent& s = p.scratch;
    multiply(p.model.pattern, s.damping_nspm, s.motion_m, s.damped);
    const double alpha = p.model.material.damping_mass_1ps;
    for (std::size_t i = 0; i < p.model.dof.size(); ++i) {
        const std::int32_t dof = p.model.dof[i];
        if (dof < 0)
            continue;
        const dvec3 rate = at_node(s.motion_m, dof) / p.dt_s;
        const dvec3 inertia_n =
            p.model.mass_kg[i] * ((rate - s.before.velocity_mps[i]) / p.dt_s + alpha * rate);
        for (int k = 0; k < 3; ++k)
            s.gradient_n[dof + k] =
                inertia_n[k] + s.damped[dof + k] / p.dt_s + p.system.internal_n[dof + k];
    }
    for (std::size_t k = 0; k < p.load_n.size(); ++k)
        s.gradient_n[k] -= p.load_n[k];
    return std::sqrt(product_of(s.gradient_n, s.gradient_n));
}

// way = -A^-1 grad E, A = M/dt^2 + (alpha M + C)/dt + K. False if A is not positive definite.
bool find_way(const Problem& p) noexcept {
    Descent& s = p.scratch;
    const double rate = 1.0 / p.dt_s;
    for (std::size_t k = 0; k < p.system.matrix.size(); ++k)
        p.system.matrix[k] = p.system.stiffness[k] + rate * s.damping_nspm[k];
    add_mass(p.model, rate * (rate + p.model.material.damping_mass_1ps), p.system.matrix);
    if (!p.system.factor.factor(p.system.matrix))
        return false;
    for (std::size_t k = 0; k < s.way_m.size(); ++k)
        s.way_m[k] = -s.gradient_n[k];
    return p.system.factor.solve(s.way_m, 1);
}

void take(const Problem& p, double share) noexcept {
    Descent& s = p.scratch;
    for (std::size_t k = 0; k < s.motion_m.size(); ++k)
        s.motion_m[k] += share * s.way_m[k];
    std::fill(s.way_m.begin(), s.way_m.end(), 0.0);
}

// The uniform motion that minimises E of a body that nothing holds: with it the gradient sums to
// zero over the nodes, and keeps doing so whatever share of a Newton step is taken. E is not above
// E(0) there, because W has not changed.
void start_with_momentum(const Problem& p) noexcept {
    Descent& s = p.scratch;
    if (!s.free)
        return;
    dvec3 force_n = s.mass_kg * p.model.gravity_mps2;
    for (std::size_t k = 0; k < p.load_n.size(); ++k)
        force_n[static_cast<int>(k % 3)] += p.load_n[k];
    const dvec3 speed_mps = (momentum_ns(p.model, s.before) + p.dt_s * force_n) /
                            (s.mass_kg * (1.0 + p.model.material.damping_mass_1ps * p.dt_s));
    for (std::size_t k = 0; k < s.motion_m.size(); ++k)
        s.motion_m[k] = p.dt_s * speed_mps[static_cast<int>(k % 3)];
}

// To where whole tangles turn. What one round turns back may free another: hence two.
int untangle(const Problem& p, double& lowest_j) noexcept {
    constexpr int kRounds = 2;
    Descent& s = p.scratch;
    s.start_m = s.motion_m;
    int rounds = 0;
    for (; rounds < kRounds; ++rounds) {
        place_trial(p, 0.0);
        find_tangles(p.model, s.trial.position_m, s.tangles);
        if (s.tangles.inverted == 0)
            break;
        assemble(p.model, s.trial, false, p.system, &s.tangles);
        find_gradient(p);
        if (!find_way(p))
            break;
        take(p, 1.0);
    }
    const double untangled_j = rounds > 0 ? incremental_j(p, 0.0) : lowest_j;
    if (untangled_j <= lowest_j) {
        lowest_j = untangled_j;
    } else {
        s.motion_m = s.start_m;
    }
    return rounds;
}

// Newton's method with Armijo's line search. The exact tangent if it makes a descent direction,
// else the warped one, which always does. Returns the solves.
int descend(const Problem& p, double lowest_j, double before_j, int most) noexcept {
    constexpr double kDescent = 1e-4; // Armijo's share of the promised decrease
    constexpr double kEnough = 1e-6;  // promised decrease, of the energy before: 1e-3 of the way
    constexpr int kHalvings = 30;
    Descent& s = p.scratch;
    for (int solves = 0; solves < most; ++solves) {
        place_trial(p, 0.0);
        assemble(p.model, s.trial, true, p.system);
        find_gradient(p);
        if (!find_way(p)) {
            assemble(p.model, s.trial, false, p.system);
            if (!find_way(p))
                return solves;
        }
        const double slope = product_of(s.gradient_n, s.way_m);
        double share = 1.0;
        int halvings = 0;
        for (; halvings < kHalvings; ++halvings, share *= 0.5) {
            const double trial_j = incremental_j(p, share);
            if (trial_j <= lowest_j + kDescent * share * slope + s.roundoff_j) {
                lowest_j = trial_j;
                break;
            }
        }
        take(p, halvings < kHalvings ? share : 0.0);
        if (halvings == kHalvings || -slope <= kEnough * std::abs(before_j) + s.roundoff_j)
            return solves + 1;
    }
    return most;
}

// The descent from `before` into `motion`. The residual that it returns is still |grad E(0)|.
StepEnd make_again(const Problem& p, double before_j) noexcept {
    Descent& s = p.scratch;
    s.trial = s.before;
    find_tangles(p.model, s.before.position_m, s.tangles);
    assemble_damping(p.model, s.before, s.tangles, s.damping_nspm);
    std::fill(s.motion_m.begin(), s.motion_m.end(), 0.0);
    std::fill(s.way_m.begin(), s.way_m.end(), 0.0);
    assemble(p.model, s.before, false, p.system);
    StepEnd end{.relative_residual = find_gradient(p)};
    start_with_momentum(p);
    double lowest_j = incremental_j(p, 0.0);
    end.iterations = untangle(p, lowest_j);
    end.iterations += descend(p, lowest_j, before_j, kMaxDescent - end.iterations);
    return end;
}

// Shortens v' until kinetic energy is within what the balance leaves for it, see (2).
double shorten(const Problem& p, double excess_j, CorotatedState& state) noexcept {
    const Descent& s = p.scratch;
    const dvec3 common_mps = s.free ? momentum_ns(p.model, state) / s.mass_kg : dvec3{0.0};
    double moving_j = kinetic_j(p.model, state);
    if (s.free)
        moving_j -= 0.5 * s.mass_kg * glm::dot(common_mps, common_mps);
    const double share = moving_j > 0.0 ? std::sqrt(std::max(0.0, 1.0 - excess_j / moving_j)) : 1.0;
    for (std::size_t i = 0; i < p.model.dof.size(); ++i)
        if (p.model.dof[i] >= 0)
            state.velocity_mps[i] = common_mps + share * (state.velocity_mps[i] - common_mps);
    return share;
}

} // namespace

Descent make_descent(const CorotatedModel& model) {
    const auto n = static_cast<std::size_t>(model.unknowns);
    Descent s;
    double volume_m3 = 0.0;
    for (const double v : model.volume_m3)
        volume_m3 += v;
    // Energy of the body at a strain of one, times a hundred roundings of a double: positions
    // are rounded as far as the body is from the origin, strains by their size over an edge.
    s.roundoff_j = 100.0 * std::numeric_limits<double>::epsilon() * volume_m3 *
                   (model.lambda_pa + 2.0 * model.mu_pa);
    s.free = model.held.empty() && n == 3 * model.dof.size();
    for (const double m : model.mass_kg)
        s.mass_kg += m;
    s.tangles = make_tangles(model);
    s.before = s.trial = rest_state(model);
    for (std::vector<double>* v :
         {&s.motion_m, &s.start_m, &s.way_m, &s.gradient_n, &s.trial_m, &s.damped})
        v->assign(n, 0.0);
    s.damping_nspm.assign(model.pattern.row.size(), 0.0);
    return s;
}

StepEnd finish_step(const CorotatedModel& model, std::span<const double> load_n,
                    std::span<double> du, CorotatedSystem& system, Descent& descent,
                    CorotatedState& state) noexcept {
    // Other steps of a lifted flap gain 0.6 % at most and mostly lose; one on the edge of buckling
    // gained a thousand times what was there.
    constexpr double kThrown = 0.1;
    const double dt_s = system.dt_s;
    const bool inverted = system.inverted > 0;
    descent.before = state;
    advance(model, du, dt_s, state);
    linearize(model, state, dt_s, system);
    state.recovering |= inverted || system.inverted > 0;
    StepEnd end{.inverted = system.inverted};
    const double elastic_j = elastic_energy_j(model, descent.before);
    const double kinetic_before_j = kinetic_j(model, descent.before);
    const double before_j = elastic_j + kinetic_before_j + potential_j(model, descent.before);
    const double work_j = product_of(load_n, du);
    const double slack_j =
        state.recovering ? 0.0 : kThrown * (elastic_j + kinetic_before_j + std::abs(work_j));
    const double most_j = before_j + work_j + slack_j + descent.roundoff_j;
    const bool holds = system.factored && !inverted && system.inverted == 0;
    if (!std::isfinite(before_j) || (holds && energy_j(model, state) <= most_j))
        return end;

    const Problem p{model, load_n, dt_s, system, descent};
    const bool recovers = state.recovering || !system.factored;
    end = make_again(p, before_j);
    std::copy(descent.motion_m.begin(), descent.motion_m.end(), du.begin());
    state = descent.before;
    state.recovering = recovers;
    advance(model, du, dt_s, state);
    linearize(model, state, dt_s, system);
    end.inverted = system.inverted;
    state.recovering |= system.inverted > 0;
    const double left_n = find_gradient(p), first_n = end.relative_residual;
    end.relative_residual = first_n > 0.0 ? left_n / first_n : 0.0;
    const double excess_j = energy_j(model, state) - (before_j + product_of(load_n, du));
    if (excess_j > descent.roundoff_j)
        end.speed_share = shorten(p, excess_j, state);
    return end;
}

} // namespace tissue
