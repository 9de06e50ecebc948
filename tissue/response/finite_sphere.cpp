// Table of the half-space at finite strain, and the ratio to small strain that follows from it.
#include "tissue/response/finite_sphere.h"

#include "tissue/response/finite_sphere_table.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tissue {
namespace {

// Share of the next ratio in the table, and its number.
struct Between {
    std::size_t index;
    double weight;
};

Between between(double poisson) {
    const double nu = std::clamp(poisson, kFinitePoisson.front(), kFinitePoisson.back());
    std::size_t i = 0;
    while (i + 2 < kFinitePoisson.size() && nu >= kFinitePoisson[i + 1])
        ++i;
    return {i, (nu - kFinitePoisson[i]) / (kFinitePoisson[i + 1] - kFinitePoisson[i])};
}

// F (1-nu^2)/(E a^2) at the table's depths.
std::array<double, kFiniteDepth.size()> scaled_forces(double poisson) {
    const Between at = between(poisson);
    std::array<double, kFiniteDepth.size()> out{};
    for (std::size_t k = 0; k < out.size(); ++k) {
        for (const std::size_t i : {at.index, at.index + 1}) {
            const double share = i == at.index ? 1.0 - at.weight : at.weight;
            out[k] += share * kFiniteForce[i][k] * (1.0 - kFinitePoisson[i] * kFinitePoisson[i]);
        }
    }
    return out;
}

// Sneddon's sphere of radius 1: d at P = x^3, over l = ln((1+a)/(1-a)).
double small_depth(double x) {
    const double force = x * x * x;
    double low = 0.0, high = 2.0 * force + 4.0;
    for (int pass = 0; pass < 80; ++pass) {
        const double l = 0.5 * (low + high);
        const double a = std::tanh(0.5 * l);
        const double tried = l < 0.02 ? l * l * l / 6.0 : 0.5 * (1.0 + a * a) * l - a;
        (tried < force ? low : high) = l;
    }
    const double l = 0.5 * (low + high);
    return 0.5 * l * std::tanh(0.5 * l);
}

// Slopes for a cubic that is monotone wherever its values are (Fritsch & Carlson 1980).
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
    const std::size_t n = x.size();
    std::vector<double> chord(n - 1), slope(n, 0.0);
    for (std::size_t i = 0; i + 1 < n; ++i)
        chord[i] = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        if (chord[i - 1] * chord[i] <= 0.0)
            continue;
        const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
        const double w1 = 2.0 * after + before, w2 = after + 2.0 * before;
        slope[i] = (w1 + w2) / (w1 / chord[i - 1] + w2 / chord[i]);
    }
    slope[n - 1] = chord[n - 2];
    return slope;
}

struct Ratio {
    std::vector<double> x, value, slope{};
    double end_depth = 0.0, end_slope = 0.0; // of depth over x^3
};

// rho at the table's forces; flat from no force to the first of them, where meshes end.
Ratio ratio_of(double poisson) {
    Ratio r{.x = {0.0}, .value = {0.0}};
    const auto force = scaled_forces(poisson);
    for (std::size_t k = 0; k < force.size(); ++k) {
        r.x.push_back(std::cbrt(force[k]));
        r.value.push_back(kFiniteDepth[k] / small_depth(r.x.back()));
    }
    r.value[0] = r.value[1];
    r.slope = monotone_slopes(r.x, r.value);
    const double x = r.x.back(), h = 1e-4 * x;
    const double small = small_depth(x), rate = (small_depth(x + h) - small_depth(x - h)) / (2 * h);
    r.end_depth = r.value.back() * small;
    r.end_slope = (r.slope.back() * small + r.value.back() * rate) / (3.0 * x * x);
    return r;
}

double ratio_at(const Ratio& r, double x) {
    if (x >= r.x.back()) {
        const double end = r.x.back();
        return (r.end_depth + r.end_slope * (x * x * x - end * end * end)) / small_depth(x);
    }
    const auto next = std::upper_bound(r.x.begin(), r.x.end(), x);
    const std::size_t i = static_cast<std::size_t>(next - r.x.begin()) - 1;
    const double h = r.x[i + 1] - r.x[i], t = (x - r.x[i]) / h;
    const double u = 1.0 - t;
    return u * u * ((1.0 + 2.0 * t) * r.value[i] + t * h * r.slope[i]) +
           t * t * ((1.0 + 2.0 * u) * r.value[i + 1] - u * h * r.slope[i + 1]);
}

} // namespace

double finite_sphere_force(double depth, double poisson) {
    const auto force = scaled_forces(poisson);
    const std::vector<double> x(kFiniteDepth.begin(), kFiniteDepth.end());
    const auto next = std::lower_bound(x.begin() + 1, x.end() - 1, depth);
    const std::size_t i = static_cast<std::size_t>(next - x.begin());
    const double part = (depth - x[i - 1]) / (x[i] - x[i - 1]);
    return ((1.0 - part) * force[i - 1] + part * force[i]) / (1.0 - poisson * poisson);
}

double finite_depth_ratio(double x, double poisson) {
    return ratio_at(ratio_of(poisson), x);
}

SphereLaw make_finite_sphere_law(double tip_radius_m, double young_pa, double poisson, int levels,
                                 int entries) {
    SphereLaw law = make_sphere_law(tip_radius_m, young_pa, poisson, levels, entries);
    const Ratio ratio = ratio_of(poisson);
    for (int i = 1; i < entries; ++i) {
        const double rho = ratio_at(ratio, i * law.x_step);
        for (std::vector<double>& row : law.depth_over_x_m)
            row[i] *= rho;
    }
    return law;
}

} // namespace tissue
