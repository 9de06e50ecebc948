// tissue/solver/measures.cpp
// Measures of corotated tissue, and what both tiers make of their samples. Tissue loop.
#include "tissue/solver/measures.h"

#include "tissue/solver/corotated_element.h"
#include "tissue/solver/measures_log.h"
#include "tissue/solver/stress.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;
using Sample = TissueLog::Sample;

constexpr std::uint8_t kNow = 1, kBefore = 2;

// The least stress that `share` of the volume does not exceed. Halves the samples until one is
// left: linear time.
double percentile_pa(std::span<Sample> samples, double share) noexcept {
    double wanted = 0.0;
    for (const Sample& s : samples)
        wanted += s.rest_volume_m3;
    wanted *= share;
    const auto less = [](const Sample& a, const Sample& b) {
        return a.von_mises_pa < b.von_mises_pa;
    };
    while (samples.size() > 1) {
        const std::size_t half = samples.size() / 2;
        std::nth_element(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(half),
                         samples.end(), less);
        double below = 0.0;
        for (const Sample& s : samples.first(half))
            below += s.rest_volume_m3;
        if (below >= wanted) {
            samples = samples.first(half);
        } else {
            samples = samples.subspan(half);
            wanted -= below;
        }
    }
    return samples.empty() ? 0.0 : samples[0].von_mises_pa;
}

TissueLog make_log(std::size_t samples) {
    return {std::vector<float>(samples, 0.0f), std::vector<std::uint8_t>(samples, 0),
            std::vector<Sample>(samples, Sample{0.0f, 0.0f})};
}

// Is a principal stretch of F outside exp(-limit) to exp(limit)? All roots of p(x) = det(x I - F^T
// F) are below c = exp(2 limit) if p, p' and p'' are positive there, and above b = 1/c if p and p''
// are negative there and p' is positive (Budan and Fourier).
bool strained(const dmat3& F, double c) noexcept {
    const dmat3 C{glm::cross(F[1], F[2]), glm::cross(F[2], F[0]), glm::cross(F[0], F[1])};
    const double J = glm::dot(F[0], C[0]), b = 1.0 / c;
    const double I1 = glm::dot(F[0], F[0]) + glm::dot(F[1], F[1]) + glm::dot(F[2], F[2]);
    const double I2 = glm::dot(C[0], C[0]) + glm::dot(C[1], C[1]) + glm::dot(C[2], C[2]);
    const auto p = [&](double x) { return ((x - I1) * x + I2) * x - J * J; };
    const auto slope = [&](double x) { return (3.0 * x - 2.0 * I1) * x + I2; };
    return !(p(c) > 0.0 && slope(c) > 0.0 && 3.0 * c > I1 && p(b) < 0.0 && slope(b) > 0.0 &&
             3.0 * b < I1);
}

} // namespace

TissueLog make_tissue_log(const CorotatedModel& model) {
    return make_log(model.mesh.tets.size());
}

TissueLog make_tissue_log(const QuadraticModel& model) {
    return make_log(model.groups.size() * 4 * QuadraticGroup::kLanes);
}

void summarise(const DamageLimits& limits, double dt_s, TissueLog& log,
               TissueMeasures& measures) noexcept {
    double rest_m3 = 0.0, over_m3 = 0.0, hurt_m3 = 0.0;
    for (std::size_t i = 0; i < log.sample.size(); ++i) {
        const Sample& s = log.sample[i];
        rest_m3 += s.rest_volume_m3;
        measures.peak_von_mises_pa =
            std::max(measures.peak_von_mises_pa, static_cast<double>(s.von_mises_pa));
        log.impulse_pas[i] += static_cast<float>(dt_s) * s.von_mises_pa;
        if ((log.over[i] & kNow) != 0) {
            over_m3 += s.rest_volume_m3;
            log.over[i] |= kBefore;
        }
        if (log.impulse_pas[i] > limits.impulse_pas)
            log.over[i] |= kBefore;
        if ((log.over[i] & kBefore) != 0)
            hurt_m3 += s.rest_volume_m3;
    }
    measures.volume_change = (measures.volume_m3 - rest_m3) / rest_m3;
    measures.over_share = over_m3 / rest_m3;
    measures.hurt_share = hurt_m3 / rest_m3;
    measures.high_von_mises_pa = percentile_pa(log.sample, 0.99);
}

TissueMeasures measure(const CorotatedModel& model, const CorotatedState& state,
                       const DamageLimits& limits, double dt_s, TissueLog& log) noexcept {
    TissueMeasures m;
    const double c = std::exp(2.0 * limits.true_strain);
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        const ElementShape shape = element_shape(model, e, state.position_m);
        const double volume = model.volume_m3[e];
        const bool inside_out = !(shape.det > 0.0);
        const double stress_pa =
            inside_out ? 0.0
                       : std::sqrt(von_mises_squared(element_stress_nm(model, e, shape))) / volume;
        m.stored_j += element_energy_j(model, e, shape);
        m.volume_m3 += volume * shape.det;
        m.inverted += inside_out;
        const bool over = inside_out || stress_pa > limits.von_mises_pa ||
                          strained(deformation_gradient(model, e, state.position_m), c);
        log.sample[e] = {static_cast<float>(stress_pa), static_cast<float>(volume)};
        log.over[e] = static_cast<std::uint8_t>((log.over[e] & kBefore) | (over ? kNow : 0));
    }
    summarise(limits, dt_s, log, m);
    return m;
}

TissueMeasures measure(const QuadraticModel& model, const QuadraticState& state,
                       const DamageLimits& limits, double dt_s, TissueLog& log) noexcept {
    TissueMeasures m = sample_points(model, state, limits, log);
    summarise(limits, dt_s, log, m);
    return m;
}

} // namespace tissue
