// tissue/response/subgrid.cpp
// Compliances and the sphere's law from the layer theory. Set-up, any thread.
#include "tissue/response/subgrid.h"

#include "tissue/response/layer_theory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using std::numbers::pi;

constexpr double kThinnestLevel = 3.0; // tip radius over thickness
constexpr double kLargestX = 8.0;      // x^3 = 512: far beyond what tissue bears
constexpr int kFitDegree = 32;

void check_elastic(double young_pa, double poisson) {
    if (!(young_pa > 0.0))
        throw std::invalid_argument("young_pa = " + std::to_string(young_pa) +
                                    ": must be greater than 0");
    if (!(poisson >= 0.0 && poisson <= 0.5))
        throw std::invalid_argument("poisson = " + std::to_string(poisson) +
                                    ": must be from 0 to 0.5");
}

// (1-nu)/(2 pi G) = (1-nu^2)/(pi E)
double half_space_scale(double young_pa, double poisson) {
    check_elastic(young_pa, poisson);
    return (1.0 - poisson * poisson) / (pi * young_pa);
}

// A smooth function on [0, end] as a Chebyshev series.
struct Series {
    double end = 1.0;
    std::vector<double> coefficient;

    // Clenshaw; value and slope
    std::array<double, 2> at(double x) const {
        const double y = 2.0 * x / end - 1.0;
        double b1 = 0.0, b2 = 0.0, d1 = 0.0, d2 = 0.0;
        for (std::size_t k = coefficient.size(); k-- > 1;) {
            const double d = 2.0 * (b1 + y * d1) - d2;
            const double b = coefficient[k] + 2.0 * y * b1 - b2;
            d2 = d1;
            d1 = d;
            b2 = b1;
            b1 = b;
        }
        return {coefficient[0] + y * b1 - b2, (b1 + y * d1 - d2) * 2.0 / end};
    }
};

Series fit_series(double end, std::span<const double> value_at_node) {
    const int n = static_cast<int>(value_at_node.size());
    Series series{end, std::vector<double>(n, 0.0)};
    for (int k = 0; k < n; ++k) {
        for (int j = 0; j < n; ++j)
            series.coefficient[k] += value_at_node[j] * std::cos(pi * k * (j + 0.5) / n);
        series.coefficient[k] *= (k == 0 ? 1.0 : 2.0) / n;
    }
    return series;
}

struct LayerSeries {
    Series depth_factor, punch_stiffening; // over contact radius / thickness
};

LayerSeries fit_layer(double poisson) {
    std::vector<double> chi(kFitDegree), kappa(kFitDegree);
    for (int j = 0; j < kFitDegree; ++j) {
        const double y = std::cos(pi * (j + 0.5) / kFitDegree);
        const LayerContact c = solve_layer_contact(0.5 * kThinnestLevel * (1.0 + y), poisson);
        chi[j] = c.depth_factor;
        kappa[j] = c.punch_stiffening;
    }
    return {fit_series(kThinnestLevel, chi), fit_series(kThinnestLevel, kappa)};
}

// Sphere of radius 1 and E/(1-nu^2) = 1, over l = ln((1+a_c)/(1-a_c)), which stays well
// conditioned as the contact radius a_c = tanh(l/2) tends to the tip radius.
struct SpherePoint {
    double contact_radius, depth, force, dforce_dl;
};

// Sneddon 1965: d = a_c l / 2, P = (1 + a_c^2)/2 l - a_c.
SpherePoint thick_sphere(double l) {
    const double a = std::tanh(0.5 * l);
    const double rate = 0.5 * (1.0 - a * a); // d a_c / dl
    const double force =
        l < 0.02 ? l * l * l * (1.0 / 6.0 - l * l / 40.0) : 0.5 * (1.0 + a * a) * l - a;
    return {a, 0.5 * a * l, force, 2.0 * a * 0.5 * (a + l * rate)};
}

// On a layer: d = chi d_Sneddon, dP = 2 a_c kappa dd. The force itself is found by integration.
SpherePoint layered_sphere(double l, double ratio, const LayerSeries& layer) {
    const SpherePoint s = thick_sphere(l);
    const double rate = 0.5 * (1.0 - s.contact_radius * s.contact_radius);
    const auto [chi, dchi] = layer.depth_factor.at(s.contact_radius * ratio);
    const double kappa = layer.punch_stiffening.at(s.contact_radius * ratio)[0];
    const double ddepth = chi * 0.5 * (s.contact_radius + l * rate) + dchi * ratio * rate * s.depth;
    return {s.contact_radius, chi * s.depth, 0.0, 2.0 * s.contact_radius * kappa * ddepth};
}

// l with P(l) = force, by Newton from `l`; P is convex up to a_c ~ 1 and then linear, and is
// bracketed in case a step overshoots.
template <class Force> double invert(const Force& force_at, double force, double l) {
    double low = 0.0, high = 1e4;
    for (int pass = 0; pass < 100; ++pass) {
        const auto [value, slope] = force_at(l);
        (value < force ? low : high) = l;
        const double next = l - (value - force) / slope;
        const double kept = next > low && next < high ? next : 0.5 * (low + high);
        if (std::abs(kept - l) <= 1e-13 * kept)
            return kept;
        l = kept;
    }
    return l;
}

struct LawRow {
    std::vector<double> depth, contact_radius; // in tip radii
};

LawRow thick_row(int entries, double x_step) {
    LawRow row{std::vector<double>(entries, 0.0), std::vector<double>(entries, 0.0)};
    double l = std::cbrt(6.0) * x_step;
    for (int i = 1; i < entries; ++i) {
        const double x = i * x_step;
        l = invert(
            [](double at) {
                const SpherePoint s = thick_sphere(at);
                return std::array{s.force, s.dforce_dl};
            },
            x * x * x, l);
        const SpherePoint s = thick_sphere(l);
        row.depth[i] = s.depth;
        row.contact_radius[i] = s.contact_radius;
    }
    return row;
}

LawRow layered_row(int entries, double x_step, double ratio, const LayerSeries& layer) {
    static const QuadratureRule rule = gauss_legendre(10);
    LawRow row{std::vector<double>(entries, 0.0), std::vector<double>(entries, 0.0)};
    double l = 0.0, force = 0.0;
    for (int i = 1; i < entries; ++i) {
        const double x = i * x_step;
        const auto force_at = [&](double at) {
            double sum = force;
            for (std::size_t q = 0; q < rule.point.size(); ++q) {
                const double half = 0.5 * (at - l);
                sum += half * rule.weight[q] *
                       layered_sphere(l + half * (1.0 + rule.point[q]), ratio, layer).dforce_dl;
            }
            return std::array{sum, layered_sphere(at, ratio, layer).dforce_dl};
        };
        l = invert(force_at, x * x * x, i == 1 ? x_step : l);
        force = x * x * x;
        const SpherePoint s = layered_sphere(l, ratio, layer);
        row.depth[i] = s.depth;
        row.contact_radius[i] = s.contact_radius;
    }
    return row;
}

} // namespace

double punch_layer_factor(double radius_over_thickness, double poisson) {
    check_elastic(1.0, poisson);
    return 1.0 / solve_layer_contact(radius_over_thickness, poisson).punch_stiffening;
}

double kernel_layer_factor(double radius_over_thickness, double poisson) {
    check_elastic(1.0, poisson);
    return kernel_response(radius_over_thickness, poisson);
}

double punch_compliance_mpn(double young_pa, double poisson, double radius_m, double thickness_m) {
    return half_space_scale(young_pa, poisson) * 0.5 * pi *
           punch_layer_factor(radius_m / thickness_m, poisson) / radius_m;
}

double kernel_compliance_mpn(double young_pa, double poisson, double radius_m, double thickness_m) {
    return half_space_scale(young_pa, poisson) * kernel_self_integral() *
           kernel_layer_factor(radius_m / thickness_m, poisson) / radius_m;
}

double tangential_ratio(double poisson) {
    return (2.0 - poisson) / (2.0 * (1.0 - poisson));
}

SphereLaw make_sphere_law(double tip_radius_m, double young_pa, double poisson, int levels,
                          int entries) {
    check_elastic(young_pa, poisson);
    if (!(tip_radius_m > 0.0) || levels < 2 || entries < 2)
        throw std::invalid_argument("sphere law: tip_radius_m = " + std::to_string(tip_radius_m) +
                                    ", levels = " + std::to_string(levels) + ", entries = " +
                                    std::to_string(entries) + ": want > 0, >= 2, >= 2");
    const LayerSeries layer = fit_layer(poisson);
    SphereLaw law;
    law.force_scale_n = young_pa * tip_radius_m * tip_radius_m / (1.0 - poisson * poisson);
    law.x_step = kLargestX / (entries - 1);
    for (int level = 0; level < levels; ++level) {
        const double share = static_cast<double>(level) / (levels - 1);
        const double ratio = kThinnestLevel * share * share; // denser where the tissue is thick
        LawRow row = level == 0 ? thick_row(entries, law.x_step)
                                : layered_row(entries, law.x_step, ratio, layer);
        for (int i = 0; i < entries; ++i) {
            row.depth[i] *= i == 0 ? 0.0 : tip_radius_m / (i * law.x_step);
            row.contact_radius[i] *= tip_radius_m;
        }
        law.radius_over_thickness.push_back(ratio);
        law.depth_over_x_m.push_back(std::move(row.depth));
        law.contact_radius_m.push_back(std::move(row.contact_radius));
    }
    return law;
}

} // namespace tissue
