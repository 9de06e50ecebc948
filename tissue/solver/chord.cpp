// See the header.
#include "tissue/solver/chord.h"

#include "tissue/solver/corotated_assembly.h"
#include "tissue/solver/plain_vectors.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using glm::dvec3;

// Of |du|: a twentieth leaves its square, 0.3 %, after the correction; a micrometre does not
// matter; a half may as well lead away: such a correction is not made.
constexpr double kMost = 0.05, kNothing_m = 1e-6, kLeadsAway = 0.5;

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

// Corrects, and ends the step if that was no more than a share `most`.
ChordEnd correct(const CorotatedModel& model, std::span<const double> load_n, double most,
                 std::span<double> du, CorotatedSystem& system, Chord& chord,
                 CorotatedState& state) noexcept {
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
    const double nothing_m = kNothing_m * std::sqrt(static_cast<double>(du.size()) / 3.0);
    if (off_m > std::max(kLeadsAway * moved_m, nothing_m))
        return end;
    for (std::size_t k = 0; k < du.size(); ++k)
        du[k] += correction[k];
    end.made = sums.inverted == 0 && off_m <= std::max(most * moved_m, nothing_m);
    if (!end.made)
        return end;
    advance(model, du, system.dt_s, state);
    std::copy(chord.force_n.begin(), chord.force_n.end(), system.internal_n.begin());
    follow_tangent(model, correction, system);
    system.peak_von_mises_pa = sums.peak_von_mises_pa;
    return end;
}

} // namespace

Chord make_chord(const CorotatedModel& model) {
    const auto n = static_cast<std::size_t>(model.unknowns);
    return {rest_state(model), std::vector<double>(n), std::vector<double>(n)};
}

ChordEnd end_on_chord(const CorotatedModel& model, std::span<const double> load_n,
                      std::span<double> du, CorotatedSystem& system, Chord& chord,
                      CorotatedState& state) noexcept {
    return correct(model, load_n, kMost, du, system, chord, state);
}

FreshEnd end_or_begin_again(const CorotatedModel& model, std::span<const double> load_n,
                            std::span<double> du, CorotatedSystem& system, Chord& chord,
                            CorotatedState& state) noexcept {
    FreshEnd out{.end = end_on_chord(model, load_n, du, system, chord, state)};
    if (out.end.made || system.inverted > 0 || state.recovering)
        return out;
    linearize(model, state, system.dt_s, system);
    out.new_tangent = true;
    free_motion(model, state, system, du, load_n);
    constexpr int kCorrections = 3; // a body that whips around wants more than one
    for (int i = 1; i <= kCorrections && !out.end.made; ++i)
        out.end =
            correct(model, load_n, i < kCorrections ? kMost : kLeadsAway, du, system, chord, state);
    if (out.end.made) // K times so much is not the change of forces
        system.peak_von_mises_pa =
            assemble_forces(model, state, system.internal_n).peak_von_mises_pa;
    return out;
}

} // namespace tissue
