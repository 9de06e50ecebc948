// tissue/reference/reference_newton.cpp
// Newton with a line search on the potential, and the load in parts where that fails. Called by
// statics and by steps.
#include "tissue/reference/reference_newton.h"

#include "tissue/reference/reference_element.h"
#include "tissue/reference/reference_tangent.h"
#include "tissue/solver/plain_vectors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue {
namespace {

using glm::dvec3;

// Displacements from rest: `now` where Newton is, `trial` where it looks. The rest per component.
struct Search {
    const ReferenceModel& model;
    ReferenceSystem& system;
    const NewtonOptions& options;
    std::span<const double> inertia_npm;
    const TipContact* contact;
    std::vector<dvec3> start_m, now_m, trial_m;
    double volume_m3 = 0.0;
    std::vector<double> force_n, way_m, inertia_n, contact_n, residual_n, step_m, product_n;
    std::vector<double> unknown, unknown_step; // per unknown
    bool factor_helps = true;                  // the last old factor was near enough
    NewtonReport report;

    Search(const ReferenceModel& m, ReferenceSystem& s, const NewtonOptions& o,
           const Potential& potential, const std::vector<dvec3>& x)
        : model(m), system(s), options(o), inertia_npm(potential.inertia_npm),
          contact(potential.contact), start_m(x), now_m(x), trial_m(x) {
        for (const auto& tet : m.points) {
            for (const ReferencePoint& p : tet)
                volume_m3 += p.volume_m3;
        }
        for (auto* v : {&force_n, &way_m, &inertia_n, &contact_n, &residual_n, &step_m, &product_n})
            v->assign(m.unknown.size(), 0.0);
        unknown.assign(static_cast<std::size_t>(m.unknowns), 0.0);
        unknown_step = unknown;
    }
};

// K and all forces at `now`.
void linearize_now(Search& s, bool projected) {
    linearize_at(s.model, s.now_m, s.system, projected);
    if (s.contact != nullptr) {
        linearize_contact(s.model, *s.contact, s.now_m, projected, s.contact_n, s.system.stiffness);
    }
}

// d and B d at `x`.
void measure(Search& s, std::span<const dvec3> x) noexcept {
    for (std::size_t i = 0; i < s.way_m.size(); ++i) {
        const int k = static_cast<int>(i % 3);
        s.way_m[i] = x[i / 3][k] - s.start_m[i / 3][k];
    }
    if (!s.inertia_npm.empty())
        multiply(s.model.all, s.inertia_npm, s.way_m, s.inertia_n);
}

struct Value {
    double elastic_j, rest_j, noise_j;
    double sum() const noexcept { return elastic_j + rest_j; }
};

// Pi at `x`, and how much of it is rounding.
Value potential_at(Search& s, std::span<const dvec3> x) {
    constexpr double kSummed = 1e-13; // of each part
    constexpr double kPoint = 1e-15;  // of mu: neo-Hooke's energy is a difference of such numbers
    const double elastic_j = energy_at_j(s.model, s.system.shear_pa, x);
    measure(s, x);
    const double kinetic_j = 0.5 * product_of(s.way_m, s.inertia_n);
    const double work_j = product_of(s.force_n, s.way_m);
    const double contact_j = s.contact ? contact_energy_j(s.model, *s.contact, x) : 0.0;
    return {elastic_j, kinetic_j - work_j + contact_j,
            kSummed * (elastic_j + kinetic_j + std::abs(work_j) + std::abs(contact_j)) +
                kPoint * s.model.elasticity.mu_pa * s.volume_m3};
}

// Residual at `now`; relative to all forces that take part.
double relative_residual(Search& s) noexcept {
    measure(s, s.now_m);
    double sum = 0.0;
    for (std::size_t i = 0; i < s.residual_n.size(); ++i) {
        s.residual_n[i] = s.force_n[i] - s.system.internal_n[i] - s.contact_n[i] - s.inertia_n[i];
        if (s.model.unknown[i] >= 0)
            sum += s.residual_n[i] * s.residual_n[i];
    }
    const double size = norm_of(s.force_n) + norm_of(s.system.internal_n) + norm_of(s.contact_n) +
                        norm_of(s.inertia_n);
    return size == 0.0 ? 0.0 : std::sqrt(sum) / size; // not a number stays so
}

// K + B of the unknowns.
void gather_tangent(Search& s) noexcept {
    for (std::size_t k = 0; k < s.system.matrix.size(); ++k) {
        const std::int32_t from = s.model.free_source[k];
        s.system.matrix[k] =
            s.system.stiffness[from] + (s.inertia_npm.empty() ? 0.0 : s.inertia_npm[from]);
    }
}

// Newly, and with projected tangents if it is not positive definite otherwise.
bool factor_tangent(Search& s) {
    ++s.report.factors;
    gather_tangent(s);
    if (s.system.factor.factor(s.system.matrix))
        return true;
    ++s.report.projected;
    linearize_now(s, true);
    gather_tangent(s);
    return s.system.factor.factor(s.system.matrix);
}

void apply_factor(Search& s) noexcept {
    s.factor_helps = true;
    s.unknown_step = s.unknown;
    s.system.factor.solve(s.unknown_step, 1);
}

// Exactly or, where the options allow it and it pays, by the last factor.
bool solve_tangent(Search& s) {
    constexpr double kTolerance = 1e-3; // Newton gains three digits with each
    const int most = s.options.products;
    if (most > 0 && s.factor_helps) {
        gather_tangent(s);
        const int products =
            solve_with_old_factor(s.model, s.system, most, kTolerance, s.unknown, s.unknown_step);
        s.factor_helps = products > 0 && 2 * products <= most;
        if (products > 0)
            return true;
    }
    if (!factor_tangent(s))
        return false;
    apply_factor(s);
    return true;
}

void take_right(Search& s) noexcept {
    ++s.report.iterations;
    for (std::size_t i = 0; i < s.residual_n.size(); ++i) {
        if (s.model.unknown[i] >= 0)
            s.unknown[s.model.unknown[i]] = s.residual_n[i];
    }
}

void give_step(Search& s) noexcept {
    for (std::size_t i = 0; i < s.step_m.size(); ++i)
        s.step_m[i] = s.model.unknown[i] >= 0 ? s.unknown_step[s.model.unknown[i]] : 0.0;
}

// step_m on the unknowns = (K + B)^-1 of residual_n there; 0 on the held components. False if
// K + B is not positive definite even with projected tangents.
bool solve_step(Search& s) {
    take_right(s);
    if (!solve_tangent(s))
        return false;
    give_step(s);
    return true;
}

void look_at(Search& s, double share) noexcept {
    for (std::size_t i = 0; i < s.step_m.size(); ++i) {
        const int k = static_cast<int>(i % 3);
        s.trial_m[i / 3][k] = s.now_m[i / 3][k] + share * s.step_m[i];
    }
}

enum class Descent { real, within_rounding, none };

// Armijo's rule along step_m.
Descent go_down(Search& s) {
    constexpr double kDescent = 1e-4; // of the promised decrease
    constexpr int kHalvings = 30;
    const double slope_j = product_of(s.residual_n, s.step_m); // > 0: positive definite
    const Value before = potential_at(s, s.now_m);
    double share = 1.0;
    for (int k = 0; k < kHalvings; ++k) {
        look_at(s, share);
        const double allowed_j = before.noise_j - kDescent * share * slope_j;
        if (potential_at(s, s.trial_m).sum() - before.sum() <= allowed_j) {
            std::swap(s.now_m, s.trial_m);
            return slope_j > before.noise_j ? Descent::real : Descent::within_rounding;
        }
        share *= 0.5;
    }
    return Descent::none;
}

// Held components go to `held_m`, the unknowns follow as the tangent says. False if that turns a
// tetrahedron inside out.
bool carry_held(Search& s, std::span<const dvec3> held_m) {
    std::vector<double> way_m(s.way_m.size());
    for (std::size_t i = 0; i < way_m.size(); ++i) {
        const int k = static_cast<int>(i % 3);
        way_m[i] = s.model.unknown[i] < 0 ? held_m[i / 3][k] - s.now_m[i / 3][k] : 0.0;
    }
    if (std::all_of(way_m.begin(), way_m.end(), [](double w) { return w == 0.0; }))
        return true;
    linearize_now(s, false);
    if (!factor_tangent(s))
        return false;
    multiply(s.model.all, s.system.stiffness, way_m, s.residual_n);
    if (!s.inertia_npm.empty()) {
        multiply(s.model.all, s.inertia_npm, way_m, s.product_n);
        for (std::size_t i = 0; i < s.residual_n.size(); ++i)
            s.residual_n[i] += s.product_n[i];
    }
    for (double& r : s.residual_n)
        r = -r;
    take_right(s);
    apply_factor(s);
    give_step(s);
    for (std::size_t i = 0; i < way_m.size(); ++i)
        s.step_m[i] += way_m[i];
    look_at(s, 1.0);
    std::swap(s.now_m, s.trial_m);
    return std::isfinite(energy_at_j(s.model, s.system.shear_pa, s.now_m));
}

// True at an equilibrium: to the tolerance, or to rounding where the tolerance lies below it.
bool converge(Search& s) {
    constexpr double kProgress = 0.5; // a Newton step that is not rounding does far better
    double last = std::numeric_limits<double>::infinity();
    Descent descent = Descent::real;
    for (int i = 0;; ++i) {
        linearize_now(s, false);
        const double residual = relative_residual(s);
        s.report.relative_residual = residual;
        s.report.energy_j = s.system.energy_j;
        s.report.min_det_f = s.system.min_det_f;
        if (residual <= s.options.tolerance ||
            (descent == Descent::within_rounding && residual > kProgress * last)) {
            return true;
        }
        if (i >= s.options.max_iterations || !solve_step(s))
            return false;
        descent = go_down(s);
        if (descent == Descent::none)
            return false;
        last = residual;
    }
}

} // namespace

NewtonReport find_least(const ReferenceModel& model, const Potential& potential,
                        std::span<const dvec3> target_m, const NewtonOptions& options,
                        ReferenceSystem& system, std::vector<dvec3>& moved_m) {
    Search s(model, system, options, potential, moved_m);
    // d = 0 at the start, so that f_int alone is what balances there
    linearize_now(s, false);
    std::vector<double> force_at_start = system.internal_n;
    for (std::size_t i = 0; i < force_at_start.size(); ++i)
        force_at_start[i] += s.contact_n[i];
    std::vector<dvec3> held_m = moved_m;

    const double least_part = std::ldexp(1.0, -options.max_halvings);
    double part = 1.0;
    while (s.report.reached < 1.0 && part >= least_part) {
        const double share = std::min(1.0, s.report.reached + part);
        for (std::size_t i = 0; i < s.force_n.size(); ++i)
            s.force_n[i] = (1.0 - share) * force_at_start[i] + share * potential.force_n[i];
        for (std::size_t i = 0; i < target_m.size(); ++i)
            held_m[i] = (1.0 - share) * s.start_m[i] + share * target_m[i];
        s.now_m = moved_m;
        if ((target_m.empty() || carry_held(s, held_m)) && converge(s)) {
            moved_m = s.now_m;
            s.report.reached = share;
            part *= 2.0;
            ++s.report.parts;
        } else {
            part *= 0.5;
        }
    }
    s.report.converged = s.report.reached == 1.0 && s.report.relative_residual <= options.tolerance;
    return s.report;
}

} // namespace tissue
