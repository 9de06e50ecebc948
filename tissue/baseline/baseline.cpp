// tissue/baseline/baseline.cpp
// What the baselines share: the critical step of an explicit method, and the report of a step.
#include "tissue/baseline/baseline.h"

#include "tissue/solver/corotated_element.h"
#include "tissue/solver/plain_vectors.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace tissue {

using glm::dvec3;

// Of the symmetric M^-1/2 K M^-1/2, whose Rayleigh quotient errs by the square of the vector's
// error (Golub & Van Loan 2013, 8.2.1): it rises to the eigenvalue.
double greatest_frequency_radps(const CorotatedModel& body, const StiffnessProduct& product) {
    constexpr int kMaxIterations = 20000;
    // Of the quotient. Where many eigenvalues are close together it rises as C - D/k: what is
    // missing after k iterations is k times the last change, and less if the greatest stands apart.
    constexpr double kMissing = 1e-4;
    const auto n = static_cast<std::size_t>(body.unknowns);
    std::vector<double> v(n), scaled(n), force(n), inverse_root_mass(n);
    std::mt19937_64 random(1); // any start that is not orthogonal to the greatest mode
    for (std::size_t i = 0; i < body.dof.size(); ++i) {
        for (int c = 0; c < 3 && body.dof[i] >= 0; ++c) {
            inverse_root_mass[body.dof[i] + c] = 1.0 / std::sqrt(body.mass_kg[i]);
            v[body.dof[i] + c] = static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
        }
    }
    double last = 0.0;
    for (int k = 1; k <= kMaxIterations; ++k) {
        const double size = norm_of(v);
        for (std::size_t i = 0; i < n; ++i) {
            v[i] /= size;
            scaled[i] = inverse_root_mass[i] * v[i];
        }
        product(scaled, force);
        double quotient = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            force[i] *= inverse_root_mass[i];
            quotient += v[i] * force[i];
        }
        if (k * std::abs(quotient - last) <= kMissing * quotient)
            return std::sqrt(quotient);
        last = quotient;
        v.swap(force);
    }
    throw std::runtime_error("the greatest eigenvalue did not settle in " +
                             std::to_string(kMaxIterations) + " iterations, last " +
                             std::to_string(last) + " 1/s^2");
}

int substep_count(double dt_s, double longest_s) noexcept {
    constexpr double kRoundoff = 1e-12; // a step of n longest ones has n parts, not n + 1
    return std::max(1, static_cast<int>(std::ceil(dt_s / longest_s * (1.0 - kRoundoff))));
}

BaselineReport look_at(const CorotatedModel& body, const BaselineState& state,
                       int substeps) noexcept {
    BaselineReport report{.substeps = substeps};
    dvec3 sum{0.0};
    for (std::size_t i = 0; i < state.position_m.size(); ++i)
        sum += state.position_m[i] + state.velocity_mps[i];
    report.finite = std::isfinite(sum.x + sum.y + sum.z);
    for (std::size_t e = 0; e < body.mesh.tets.size(); ++e) {
        if (!(determinant(deformation_gradient(body, e, state.position_m)) > 0.0))
            ++report.inverted;
    }
    return report;
}

} // namespace tissue
