// See the header.
#include "tissue/solver/chord.h"

#include "tissue/solver/corotated_assembly.h"
#include "tissue/solver/plain_vectors.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using glm::dvec3;

// load - [M (du/dt - v)/dt + (alpha M + beta K) du/dt + f_int], K the old one. Returns the size of
// the forces that it is the sum of.
double find_residual(const CorotatedModel& model, std::span<const double> load_n,
                     std::span<const double> du, const CorotatedState& state,
                     CorotatedSystem& system, Chord& chord) noexcept {
    const double rate = 1.0 / system.dt_s, alpha = model.material.damping_mass_1ps;
    const std::span<double> damped = std::span(system.work).first(du.size());
    multiply(model.pattern, system.stiffness, du, damped);
    double inertia2 = 0.0;
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        const std::int32_t d = model.dof[i];
        if (d < 0)
            continue;
        const dvec3 speed = rate * dvec3{du[d], du[d + 1], du[d + 2]};
        const dvec3 inertia_n =
            model.mass_kg[i] * (rate * (speed - state.velocity_mps[i]) + alpha * speed);
        inertia2 += glm::dot(inertia_n, inertia_n);
        for (int k = 0; k < 3; ++k)
            chord.residual_n[d + k] = -inertia_n[k] - chord.force_n[d + k] -
                                      model.material.damping_stiffness_s * rate * damped[d + k];
    }
    for (std::size_t k = 0; k < load_n.size(); ++k)
        chord.residual_n[k] += load_n[k];
    return std::sqrt(inertia2) + norm_of(chord.force_n) + norm_of(load_n);
}

} // namespace

Chord make_chord(const CorotatedModel& model) {
    const auto n = static_cast<std::size_t>(model.unknowns);
    return {rest_state(model), std::vector<double>(n), std::vector<double>(n)};
}

ChordEnd end_on_chord(const CorotatedModel& model, std::span<const double> load_n,
                      std::span<double> du, CorotatedSystem& system, Chord& chord,
                      CorotatedState& state) noexcept {
    // a twentieth leaves its square, 0.3 %, after the correction; a micrometre does not matter
    constexpr double kMost = 0.05, kNothing_m = 1e-6;
    ChordEnd end;
    if (!system.factored || system.inverted > 0 || state.recovering)
        return end;
    chord.trial = state;
    advance(model, du, system.dt_s, chord.trial);
    const ForceSums sums = assemble_forces(model, chord.trial, chord.force_n);
    const double size_n = find_residual(model, load_n, du, state, system, chord);
    end.residual = size_n > 0.0 ? norm_of(chord.residual_n) / size_n : 0.0;
    system.factor.solve(chord.residual_n, 1);
    const std::span<const double> correction = chord.residual_n;
    const double moved_m = norm_of(du), off_m = norm_of(correction);
    if (!std::isfinite(off_m))
        return end;
    end.share = moved_m > 0.0 ? off_m / moved_m : 0.0;
    for (std::size_t k = 0; k < du.size(); ++k)
        du[k] += correction[k];
    const double nothing_m = kNothing_m * std::sqrt(static_cast<double>(du.size()) / 3.0);
    end.made = sums.inverted == 0 && off_m <= std::max(kMost * moved_m, nothing_m);
    if (!end.made)
        return end;
    advance(model, du, system.dt_s, state);
    std::copy(chord.force_n.begin(), chord.force_n.end(), system.internal_n.begin());
    follow_tangent(model, correction, system);
    system.peak_von_mises_pa = sums.peak_von_mises_pa;
    return end;
}

} // namespace tissue
