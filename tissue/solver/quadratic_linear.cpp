// tissue/solver/quadratic_linear.cpp
// A x = b at a linearisation by conjugate gradients in single precision. The preconditioner is the
// factor at rest, turned with every node (Mueller & Gross 2004 warp a stiffness so; here it only
// has to be near). Tissue loop.
#include "tissue/solver/quadratic_linear.h"

#include "tissue/solver/quadratic_columns.h"
#include "tissue/solver/quadratic_points.h"
#include "tissue/solver/quadratic_recovery.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

// Sixteen sums that do not wait for each other; node vectors are as long.
double product_of(const NodeVector<float>& a, const NodeVector<float>& b) noexcept {
    std::array<float, 16> sum{};
    for (std::size_t i = 0; i < a.size(); i += sum.size()) {
        for (std::size_t k = 0; k < sum.size(); ++k)
            sum[k] += a[i + k] * b[i + k];
    }
    double all = 0.0;
    for (const float part : sum)
        all += part;
    return all;
}

// z = W A0^-1 W^T r
void precondition(const QuadraticModel& model, QuadraticSystem& s) noexcept {
    for (std::size_t i = 0; i < s.warp.size(); ++i) {
        const glm::mat3& W = s.warp[i];
        const float *r = &s.r[4 * i], x = r[0], y = r[1], z = r[2];
        for (int c = 0; c < 3; ++c)
            s.z[4 * i + c] = W[c][0] * x + W[c][1] * y + W[c][2] * z;
    }
    const int n = model.unknowns;
    for (int k = 0; k < n; ++k)
        s.ordered[k] = s.z[s.place_in_order[k]];
    solve(s.single, s.ordered, s.lines);
    for (int k = 0; k < n; ++k)
        s.z[s.place_in_order[k]] = s.ordered[k];
    for (std::size_t i = 0; i < s.warp.size(); ++i) {
        const glm::mat3& W = s.warp[i];
        float* v = &s.z[4 * i];
        const float x = v[0], y = v[1], z = v[2];
        for (int c = 0; c < 3; ++c)
            v[c] = W[0][c] * x + W[1][c] * y + W[2][c] * z;
    }
}

// q = A p
void multiply(const QuadraticModel& model, QuadraticSystem& s) noexcept {
    const double stiffness = 1.0 + model.material.damping_stiffness_s / s.dt_s;
    scalar_product(model, s.scalar_npm, s.p, s.q);
    add_tangent_product(model, s.tangent, static_cast<float>(stiffness), s.p, s.q);
    clear_fixed(model, s.q);
}

} // namespace

// Nothing of it left, A is positive: shear |dF|^2 + 2 mixed (F:dF)(C:dF) + square (C:dF)^2, where
// mixed^2 = 4/9 shear^2/J^2 <= shear square/|F|^2, since square >= 5/9 shear |F|^2/J^2. With a
// memory the same in the metric of M, which is positive.
void scale_geometric_stiffness(float share, QuadraticSystem& s) noexcept {
    s.tangent_true = false;
    for (QuadraticTangent& tangent : s.tangent.elastic) {
        for (auto& point : tangent.point) {
            for (float& bend : point[QuadraticTangent::kBend])
                bend *= share;
        }
    }
}

namespace {

// x = V diag(inverse) V^T b, and r = b - A x; see block_modes.h.
void start_from_known(const QuadraticModel& model, QuadraticSystem& s) noexcept {
    constexpr int kTile = KnownModes::kTile;
    const KnownModes& known = s.block.known;
    for (int m = 0; m < known.modes; m += kTile) {
        const float* const tile = &known.value[static_cast<std::size_t>(m) * known.lines];
        std::array<float, kTile> share{};
        const float* value = tile;
        for (std::size_t i = 0; i < s.warp.size(); ++i) {
            for (std::size_t c = 0; c < 3; ++c, value += kTile) {
                for (int k = 0; k < kTile; ++k)
                    share[k] += value[k] * s.r[4 * i + c];
            }
        }
        for (int k = 0; k < kTile; ++k)
            share[k] *= known.inverse[m + k];
        value = tile;
        for (std::size_t i = 0; i < s.warp.size(); ++i) {
            for (std::size_t c = 0; c < 3; ++c, value += kTile) {
                float sum = 0.0f;
                for (int k = 0; k < kTile; ++k)
                    sum += value[k] * share[k];
                s.x[4 * i + c] += sum;
            }
        }
    }
    s.p = s.x;
    multiply(model, s);
    for (std::size_t i = 0; i < s.r.size(); ++i)
        s.r[i] -= s.q[i];
}

struct Gradients {
    int iterations = 0;
    double relative_residual = 0.0;
    bool indefinite = false; // stopped at a way of negative curvature
};

Gradients conjugate_gradients(const QuadraticModel& model, const QuadraticOptions& options,
                              QuadraticSystem& s) noexcept {
    Gradients report;
    std::fill(s.x.begin(), s.x.end(), 0.0f);
    s.r = s.b;
    const double size2 = product_of(s.r, s.r);
    if (size2 == 0.0)
        return report;
    const double enough2 = options.linear_tolerance * options.linear_tolerance * size2;
    if (s.block.known.modes > 0)
        start_from_known(model, s);
    double left2 = product_of(s.r, s.r);
    report.relative_residual = std::sqrt(left2 / size2);
    if (!(left2 > enough2))
        return report;
    precondition(model, s);
    s.p = s.z;
    double rz = product_of(s.r, s.z);
    while (report.iterations < options.max_linear) {
        multiply(model, s);
        const double curvature = product_of(s.p, s.q);
        report.indefinite = !(curvature > 0.0);
        if (report.indefinite)
            break;
        const auto alpha = static_cast<float>(rz / curvature);
        for (std::size_t i = 0; i < s.x.size(); ++i) {
            s.x[i] += alpha * s.p[i];
            s.r[i] -= alpha * s.q[i];
        }
        ++report.iterations;
        left2 = product_of(s.r, s.r);
        if (!(left2 > enough2))
            break;
        precondition(model, s);
        const double next = product_of(s.r, s.z);
        const auto beta = static_cast<float>(next / rz);
        rz = next;
        for (std::size_t i = 0; i < s.p.size(); ++i)
            s.p[i] = s.z[i] + beta * s.p[i];
    }
    report.relative_residual = std::sqrt(left2 / size2);
    return report;
}

} // namespace

LinearReport solve_nodes(const QuadraticModel& model, const QuadraticOptions& options,
                         QuadraticSystem& s) noexcept {
    Gradients done = conjugate_gradients(model, options, s);
    const bool projected = done.indefinite;
    int iterations = done.iterations;
    for (const float share : {0.5f, 0.0f}) { // half of it is often enough, and nearer to the truth
        if (!done.indefinite)
            break;
        scale_geometric_stiffness(share, s);
        done = conjugate_gradients(model, options, s);
        iterations += done.iterations;
    }
    return {iterations, done.relative_residual, projected};
}

LinearReport solve(const QuadraticModel& model, const QuadraticOptions& options,
                   std::span<const double> b, QuadraticSystem& system,
                   std::span<double> x) noexcept {
    if (system.recovering) {
        std::copy(b.begin(), b.end(), x.begin());
        solve_recovering(system, x);
        return {};
    }
    std::fill(system.b.begin(), system.b.end(), 0.0f);
    for (std::size_t k = 0; k < b.size(); ++k)
        system.b[model.place_of_unknown[k]] = static_cast<float>(b[k]);
    const LinearReport report = solve_nodes(model, options, system);
    for (std::size_t k = 0; k < x.size(); ++k)
        x[k] = system.x[model.place_of_unknown[k]];
    return report;
}

void stiffness_product(const QuadraticModel& model, std::span<const double> x, QuadraticSystem& s,
                       std::span<double> y) noexcept {
    if (s.recovering) {
        multiply(model.pattern, s.rest_stiffness_npm, x, y);
        return;
    }
    std::fill(s.p.begin(), s.p.end(), 0.0f);
    std::fill(s.q.begin(), s.q.end(), 0.0f);
    std::fill(s.way.begin(), s.way.end(), 0.0);
    for (std::size_t k = 0; k < x.size(); ++k) {
        const std::int32_t at = model.place_of_unknown[k];
        s.way[at] = x[k];
        s.p[at] = static_cast<float>(x[k]);
    }
    add_tangent_product(model, s.tangent, 1.0f, s.p, s.q);
    if (!model.bed_npm.empty())
        scalar_product(model, model.bed_npm, 1.0, s.way, s.damped_n);
    for (std::size_t k = 0; k < y.size(); ++k) {
        const std::int32_t at = model.place_of_unknown[k];
        y[k] = s.q[at] + (model.bed_npm.empty() ? 0.0 : s.damped_n[at]);
    }
}

void mass_product(const QuadraticModel& model, std::span<const double> x, QuadraticSystem& s,
                  std::span<double> y) noexcept {
    std::fill(s.way.begin(), s.way.end(), 0.0);
    for (std::size_t k = 0; k < x.size(); ++k)
        s.way[model.place_of_unknown[k]] = x[k];
    mass_product(model, 1.0, s.way, s.damped_n);
    for (std::size_t k = 0; k < y.size(); ++k)
        y[k] = s.damped_n[model.place_of_unknown[k]];
}

void internal_force(const QuadraticModel& model, const QuadraticSystem& s,
                    std::span<double> out_n) noexcept {
    for (std::size_t k = 0; k < out_n.size(); ++k) {
        const std::int32_t at = model.place_of_unknown[k];
        out_n[k] = s.internal_n[at] - model.weight_n[at];
    }
}

} // namespace tissue
