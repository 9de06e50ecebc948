// tissue/solver/quadratic.cpp
// One step of a quadratic body: where it would go, and Newton from there. Tissue loop.
#include "tissue/solver/quadratic.h"

#include "tissue/solver/polar_rotation.h"
#include "tissue/solver/quadratic_linear.h"
#include "tissue/solver/quadratic_points.h"
#include "tissue/solver/quadratic_recovery.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double norm2(const NodeVector<double>& v) noexcept {
    double s0 = 0.0, s1 = 0.0, s2 = 0.0;
    for (std::size_t i = 0; i < v.size(); i += 4) {
        s0 += v[i] * v[i];
        s1 += v[i + 1] * v[i + 1];
        s2 += v[i + 2] * v[i + 2];
    }
    return s0 + s1 + s2;
}

double product_of(const NodeVector<double>& a, const NodeVector<double>& b) noexcept {
    double s0 = 0.0, s1 = 0.0, s2 = 0.0;
    for (std::size_t i = 0; i < a.size(); i += 4) {
        s0 += a[i] * b[i];
        s1 += a[i + 1] * b[i + 1];
        s2 += a[i + 2] * b[i + 2];
    }
    return s0 + s1 + s2;
}

// B d in inertia_n, d = moved - start in way
void add_inertia(const QuadraticModel& model, QuadraticSystem& s) noexcept {
    for (std::size_t i = 0; i < s.way.size(); ++i)
        s.way[i] = s.moved_m[i] - s.start_m[i];
    const double mass = 1.0 / (s.dt_s * s.dt_s) + model.material.damping_mass_1ps / s.dt_s;
    mass_product(model, mass, s.way, s.inertia_n);
    s.last_way = s.way;
    s.last_inertia_n = s.inertia_n;
    if (!(model.material.damping_stiffness_s > 0.0))
        return;
    std::copy(s.way.begin(), s.way.end(), s.p.begin());
    std::fill(s.q.begin(), s.q.end(), 0.0f);
    const double stiffness = model.material.damping_stiffness_s / s.dt_s;
    if (!model.bed_npm.empty()) {
        scalar_product(model, model.bed_npm, stiffness, s.way, s.damped_n);
        for (std::size_t i = 0; i < s.damped_n.size(); ++i)
            s.inertia_n[i] += s.damped_n[i];
    }
    add_tangent_product(model, s.tangent_at_start, static_cast<float>(stiffness), s.p, s.q);
    for (std::size_t i = 0; i < s.q.size(); ++i)
        s.inertia_n[i] += s.q[i];
}

// Everything that depends on moved_m.
void evaluate(const QuadraticModel& model, QuadraticSystem& s) noexcept {
    const PointSums sums =
        stresses(model, s.moved_m, s.shear_pa, s.internal_n, s.tangent, s.stretch);
    s.tangent_true = true;
    s.min_det_f = sums.min_det_f;
    s.energy_j = sums.min_det_f > 0.0 ? sums.energy_j : kInfinity;
    const double bed_j = add_bed(model, s.moved_m, s.inertia_n, s.internal_n);
    s.energy_j += bed_j;
    s.shape_j = sums.shape_j + bed_j;
    add_inertia(model, s);
    for (std::size_t i = 0; i < s.residual_n.size(); ++i)
        s.residual_n[i] = s.momentum_n[i] - s.internal_n[i] - s.inertia_n[i];
    clear_fixed(model, s.residual_n);
    const double size = std::sqrt(norm2(s.momentum_n)) + std::sqrt(norm2(s.internal_n)) +
                        std::sqrt(norm2(s.inertia_n));
    s.residual = size > 0.0 ? std::sqrt(norm2(s.residual_n)) / size : 0.0;
    s.potential_j =
        s.energy_j + 0.5 * product_of(s.way, s.inertia_n) - product_of(s.way, s.momentum_n);
}

// Of each node, the mean deformation gradient of the tets around it, scaled to volume 1.
void warp_nodes(const QuadraticModel& model, QuadraticSystem& s) noexcept {
    constexpr std::int32_t kLanes = QuadraticGroup::kLanes;
    for (std::size_t i = 0; i < s.warp.size(); ++i) {
        std::array<float, 9> sum{};
        for (std::int32_t k = model.tet_start[i]; k < model.tet_start[i + 1]; ++k) {
            const std::int32_t tet = model.tet_of_node[k];
            for (int j = 0; j < 9; ++j)
                sum[j] += s.stretch[tet / kLanes].volume_f_m3[j][tet % kLanes];
        }
        dmat3 F;
        for (int j = 0; j < 9; ++j)
            F[j / 3][j % 3] = sum[j];
        // a mean of gradients may be flat even if none of them is
        const double det = glm::determinant(F),
                     size2 = glm::dot(F[0], F[0]) + glm::dot(F[1], F[1]) + glm::dot(F[2], F[2]);
        constexpr double kFlat = 1e-2;
        s.warp[i] = glm::mat3(det > kFlat * size2 * std::sqrt(size2) ? F / std::cbrt(det)
                                                                     : closest_rotation(F)) *
                    s.unwarp[i];
    }
}

// Displacements where the velocity and `share` of its last gain lead in dt.
void look_ahead(const QuadraticModel& model, const QuadraticState& state, double share,
                QuadraticSystem& s) noexcept {
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        const dvec3 step = s.dt_s * (state.velocity_mps[i] + share * state.gain_mps[i]);
        for (int c = 0; c < 3; ++c)
            s.moved_m[4 * i + c] = s.start_m[4 * i + c] + step[c];
    }
    evaluate(model, s);
}

void set_load(const QuadraticModel& model, std::span<const double> load_n,
              QuadraticSystem& s) noexcept {
    for (std::size_t k = 0; k < s.load_n.size(); ++k) {
        const double load = load_n.empty() ? 0.0 : load_n[k];
        s.momentum_n[model.place_of_unknown[k]] += load - s.load_n[k];
        s.load_n[k] = load;
    }
}

// Of places in metres: the same but for rounding.
bool same(const NodeVector<double>& a, const NodeVector<double>& b, double scale) noexcept {
    constexpr double kRounding_m = 1e-15;
    std::size_t near = 0; // what is not a number is not
    for (std::size_t i = 0; i < a.size(); ++i)
        near += std::abs(scale * a[i] - b[i]) <= kRounding_m;
    return near == a.size();
}

// f + M v/dt
void add_momentum(const QuadraticModel& model, const QuadraticState& state,
                  std::span<const double> load_n, QuadraticSystem& s) noexcept {
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        for (int c = 0; c < 3; ++c)
            s.way[4 * i + c] = state.velocity_mps[i][c];
    }
    // mostly the way of the step before, whose inertia is known
    if (same(s.way, s.last_way, s.dt_s)) {
        const double share = 1.0 / (1.0 + model.material.damping_mass_1ps * s.dt_s);
        for (std::size_t i = 0; i < s.momentum_n.size(); ++i)
            s.momentum_n[i] = share * s.last_inertia_n[i];
    } else {
        mass_product(model, 1.0 / s.dt_s, s.way, s.momentum_n);
    }
    for (std::size_t i = 0; i < s.momentum_n.size(); ++i)
        s.momentum_n[i] += model.weight_n[i];
    std::fill(s.load_n.begin(), s.load_n.end(), 0.0);
    set_load(model, load_n, s);
}

// The tangent at moved_m, but with the geometric stiffness of the start. A prediction violates the
// volume by a little, which the bulk modulus makes a pressure that is not there; Newton converges
// in far fewer iterations if the stress of the geometric stiffness is not taken from it (Magisano,
// Leonetti & Garcea 2017).
void keep_stress(QuadraticSystem& s) noexcept {
    s.tangent_true = false;
    for (std::size_t g = 0; g < s.tangent.elastic.size(); ++g) {
        for (std::size_t q = 0; q < 4; ++q) {
            s.tangent.elastic[g].point[q][QuadraticTangent::kBend] =
                s.tangent_at_start.elastic[g].point[q][QuadraticTangent::kBend];
        }
    }
}

// Armijo's rule from moved_m along x; false if no part of the way goes down.
bool go_down(const QuadraticModel& model, QuadraticSystem& s) noexcept {
    constexpr double kDescent = 1e-4, kSummed = 1e-12; // of the promise; rounding of a sum
    constexpr int kHalvings = 8;
    double slope_j = 0.0;
    for (std::size_t i = 0; i < s.x.size(); ++i)
        slope_j += s.residual_n[i] * s.x[i];
    const double before_j = s.potential_j;
    const double noise_j =
        kSummed * (s.energy_j + std::abs(before_j) + model.elasticity.mu_pa * model.volume_m3);
    s.trial_m = s.moved_m;
    double share = 1.0;
    for (int k = 0; k <= kHalvings; ++k, share *= 0.5) {
        for (std::size_t i = 0; i < s.x.size(); ++i)
            s.moved_m[i] = s.trial_m[i] + share * s.x[i];
        evaluate(model, s);
        if (s.potential_j - before_j <= noise_j - kDescent * share * slope_j)
            return true;
    }
    s.moved_m = s.trial_m;
    evaluate(model, s);
    return false;
}

// Iterations from moved_m, at least `least`, until the residual is small enough.
QuadraticReport newton(const QuadraticModel& model, const QuadraticOptions& options, int least,
                       QuadraticSystem& s) noexcept {
    QuadraticReport report;
    while (report.newton_iterations < options.max_newton &&
           (report.newton_iterations < least || s.residual > options.newton_tolerance)) {
        std::copy(s.residual_n.begin(), s.residual_n.end(), s.b.begin());
        QuadraticOptions inexact = options;
        inexact.linear_tolerance = newton_linear_tolerance(options, s);
        const LinearReport linear = solve_nodes(model, inexact, s);
        report.linear_iterations += linear.iterations;
        report.projected += linear.projected;
        ++report.newton_iterations;
        report.linear_residual = std::max(report.linear_residual, linear.relative_residual);
        report.linear_force_residual =
            std::max(report.linear_force_residual, linear.relative_residual * s.residual);
        if (!go_down(model, s))
            break;
    }
    report.relative_residual = s.residual;
    report.min_det_f = s.min_det_f;
    return report;
}

void read_motion(const QuadraticModel& model, const QuadraticSystem& s,
                 std::span<double> du) noexcept {
    for (std::size_t k = 0; k < du.size(); ++k) {
        const std::int32_t at = model.place_of_unknown[k];
        du[k] = s.moved_m[at] - s.start_m[at];
    }
}

struct Start {
    double min_det_f = 0.0, energy_j = 0.0, shape_j = 0.0;
};

// The tangent at start_m into tangent_at_start. Mostly that is where the step before ended, and its
// tangent is there; with a memory it is another by now.
Start start_of(const QuadraticModel& model, const QuadraticState& state,
               QuadraticSystem& s) noexcept {
    begin_memory(model, state, s);
    if (s.tangent_true && s.min_det_f > 0.0 && s.prony.terms == 0 &&
        same(s.moved_m, s.start_m, 1.0)) {
        std::swap(s.tangent, s.tangent_at_start);
        s.tangent_true = false;
        return {s.min_det_f, s.energy_j, s.shape_j};
    }
    const PointSums sums =
        stresses(model, s.start_m, s.shear_pa, s.internal_n, s.tangent_at_start, s.stretch);
    const double bed_j = add_bed(model, s.start_m, s.inertia_n, s.internal_n);
    return {sums.min_det_f, sums.energy_j + bed_j, sums.shape_j + bed_j};
}

} // namespace

void linearize(const QuadraticModel& model, const QuadraticState& state, QuadraticSystem& s,
               std::span<const double> load_n) noexcept {
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        for (int c = 0; c < 3; ++c)
            s.start_m[4 * i + c] = state.position_m[i][c] - model.mesh.rest_m[i][c];
    }
    add_momentum(model, state, load_n, s);
    const Start start = start_of(model, state, s);
    s.moved_m = s.start_m;
    s.min_det_f = start.min_det_f;
    s.energy_j = start.energy_j;
    s.recovering = !(start.min_det_f > 0.0);
    if (s.recovering) {
        s.tangent_true = false;
        linearize_recovering(model, s);
        return;
    }
    // From a place that is no better than where it stands, Newton has a long way. Changes of volume
    // are not counted, it undoes them at once, unless a point is pressed flat.
    constexpr double kFlat = 0.5;
    const auto better = [&] {
        return s.min_det_f >= kFlat * start.min_det_f &&
               s.potential_j - s.energy_j + s.shape_j <= start.shape_j;
    };
    look_ahead(model, state, state.gains_on ? 1.0 : 0.0, s);
    if (state.gains_on && !better())
        look_ahead(model, state, 0.0, s);
    if (!better()) {
        s.moved_m = s.start_m;
        evaluate(model, s);
    }
    keep_stress(s);
    warp_nodes(model, s);
}

double newton_linear_tolerance(const QuadraticOptions& options, const QuadraticSystem& s) noexcept {
    constexpr double kShare = 0.3;
    const double loosest = std::max(options.linear_tolerance, options.loosest_linear);
    if (!(s.residual > 0.0))
        return loosest;
    return std::clamp(kShare * options.newton_tolerance / s.residual, options.linear_tolerance,
                      loosest);
}

QuadraticReport finish(const QuadraticModel& model, const QuadraticOptions& options,
                       std::span<const double> load_n, QuadraticSystem& s,
                       std::span<double> du) noexcept {
    QuadraticReport report{.min_det_f = s.min_det_f, .recovering = s.recovering};
    if (s.recovering) {
        report.relative_residual = 1.0;
        return report;
    }
    s.trial_m = s.moved_m;
    for (std::size_t k = 0; k < du.size(); ++k) {
        const std::int32_t at = model.place_of_unknown[k];
        s.moved_m[at] = s.start_m[at] + du[k];
    }
    set_load(model, load_n, s);
    evaluate(model, s);
    if (!(s.min_det_f > 0.0)) { // the step leads out of the law: shorten it from where it was seen
        s.moved_m = s.trial_m;
        evaluate(model, s);
    }
    report = newton(model, options, 0, s);
    read_motion(model, s, du);
    return report;
}

void way_and_residual(const QuadraticModel& model, const QuadraticSystem& system,
                      std::span<double> way_m, std::span<double> residual_n) noexcept {
    for (std::size_t k = 0; k < way_m.size(); ++k) {
        const std::int32_t at = model.place_of_unknown[k];
        way_m[k] = system.way[at];
        residual_n[k] = system.residual_n[at];
    }
}

QuadraticReport free_motion(const QuadraticModel& model, const QuadraticOptions& options,
                            QuadraticSystem& s, std::span<double> du) noexcept {
    QuadraticReport report{.min_det_f = s.min_det_f, .recovering = s.recovering};
    if (s.recovering) {
        for (std::size_t k = 0; k < du.size(); ++k)
            du[k] = s.residual_n[model.place_of_unknown[k]];
        solve_recovering(s, du);
        report.relative_residual = 1.0;
        return report;
    }
    report = newton(model, options, 1, s);
    read_motion(model, s, du);
    return report;
}

void advance(const QuadraticModel& model, const QuadraticSystem& system, std::span<const double> du,
             QuadraticState& state) noexcept {
    double went_on = 0.0;
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        const std::int32_t d = model.dof[i];
        if (d < 0) {
            state.velocity_mps[i] = dvec3{0.0};
            continue;
        }
        const dvec3 step{du[d], du[d + 1], du[d + 2]};
        state.position_m[i] += step;
        const dvec3 gain = step / system.dt_s - state.velocity_mps[i];
        went_on += glm::dot(gain, state.gain_mps[i]);
        state.gain_mps[i] = gain;
        state.velocity_mps[i] = step / system.dt_s;
    }
    state.gains_on = went_on >= 0.0;
    end_memory(model, system, state);
}

} // namespace tissue
