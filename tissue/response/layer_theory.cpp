// tissue/response/layer_theory.cpp
// Layer integrals and the integral equation of a tip on a layer. Set-up, any thread.
#include "tissue/response/layer_theory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tissue {
namespace {

using std::numbers::pi;

constexpr double kLargestRatio = 50.0;
constexpr double kDecayed = 20.0; // 1 - M(z) < 1e-14 beyond

// Points and weights of a composite rule, weights already times half the panel.
QuadratureRule composite(const std::vector<double>& edges, int count) {
    const QuadratureRule base = gauss_legendre(count);
    QuadratureRule rule;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        const double half = 0.5 * (edges[i + 1] - edges[i]);
        for (int k = 0; k < count; ++k) {
            rule.point.push_back(edges[i] + half * (1.0 + base.point[k]));
            rule.weight.push_back(half * base.weight[k]);
        }
    }
    return rule;
}

std::vector<double> even_edges(double from, double to, int panels) {
    std::vector<double> edges(panels + 1);
    for (int i = 0; i <= panels; ++i)
        edges[i] = from + (to - from) * i / panels;
    return edges;
}

double kernel_transform(double s) {
    return s < 1e-3 ? 1.0 - s * s / 12.0 : 8.0 * std::cyl_bessel_j(2.0, s) / (s * s);
}

// Points s with weight k^(s)^2 ds. Panels shrink towards 0, where M(s/ratio) rises steeply for a
// thick layer; what is left out beyond 100 is 16/(pi 100^4) = 5e-8.
const QuadratureRule& kernel_rule() {
    static const QuadratureRule rule = [] {
        std::vector<double> edges{0.0};
        for (int k = -10; k <= 0; ++k)
            edges.push_back(std::ldexp(1.0, k));
        for (double s = 2.0; s <= 100.0; s += 1.0)
            edges.push_back(s);
        QuadratureRule r = composite(edges, 12);
        for (std::size_t q = 0; q < r.point.size(); ++q) {
            const double k = kernel_transform(r.point[q]);
            r.weight[q] *= k * k;
        }
        return r;
    }();
    return rule;
}

// Solves A x = b for a few right-hand sides by Cholesky; A full, symmetric, positive definite,
// row by row, destroyed.
void solve_dense(std::vector<double>& A, int n, std::vector<std::vector<double>>& b) {
    for (int j = 0; j < n; ++j) {
        for (int i = j; i < n; ++i) {
            double sum = A[i * n + j];
            for (int k = 0; k < j; ++k)
                sum -= A[i * n + k] * A[j * n + k];
            A[i * n + j] = i == j ? std::sqrt(sum) : sum / A[j * n + j];
        }
    }
    for (std::vector<double>& x : b) {
        for (int i = 0; i < n; ++i) {
            for (int k = 0; k < i; ++k)
                x[i] -= A[i * n + k] * x[k];
            x[i] /= A[i * n + i];
        }
        for (int i = n - 1; i >= 0; --i) {
            for (int k = i + 1; k < n; ++k)
                x[i] -= A[k * n + i] * x[k];
            x[i] /= A[i * n + i];
        }
    }
}

} // namespace

QuadratureRule gauss_legendre(int count) {
    QuadratureRule rule{std::vector<double>(count), std::vector<double>(count)};
    for (int i = 0; i < count; ++i) {
        double x = -std::cos(pi * (i + 0.75) / (count + 0.5));
        double slope = 0.0;
        for (int pass = 0; pass < 20; ++pass) { // Newton on the Legendre polynomial
            double before = 1.0, value = x;
            for (int k = 2; k <= count; ++k) {
                const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
                before = value;
                value = next;
            }
            slope = count * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        rule.point[i] = x;
        rule.weight[i] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
    return rule;
}

double layer_response(double z, double poisson) {
    // numerator and denominator times e^-2z, so that nothing overflows
    const double k = 3.0 - 4.0 * poisson;
    const double e = std::exp(-2.0 * std::min(z, 300.0));
    const double free = 1.0 - 2.0 * poisson;
    const double above = 0.25 * k * (1.0 - e * e) - z * e;
    const double below = 0.25 * k * (1.0 + e) * (1.0 + e) + (z * z + free * free) * e;
    return above / below;
}

// Pressure transform p^(k) = int_0^a phi(t) cos(kt) dt gives, in units of a,
//   (pi/2) phi(x) - int_0^1 K(x,t) phi(t) dt = f(x),
//   K(x,t) = ratio int_0^inf (1 - M(z)) cos(z ratio x) cos(z ratio t) dz,
// f = 1 for the flat punch, chi - x^2 for the paraboloid with chi such that phi(1) = 0.
// Nystroem with Gauss points; the square roots of the weights make the matrix symmetric.
LayerContact solve_layer_contact(double ratio, double poisson) {
    const double rho = std::clamp(ratio, 0.0, kLargestRatio);
    const int n = 24 + static_cast<int>(4.0 * rho);
    const QuadratureRule x = composite({0.0, 1.0}, n);
    const QuadratureRule z =
        composite(even_edges(0.0, kDecayed, 8 + static_cast<int>(8.0 * rho)), 8);

    // wave(i, q): one row per Gauss point, the last for the rim x = 1
    const std::size_t waves = z.point.size();
    std::vector<double> wave((n + 1) * waves), gain(waves);
    for (std::size_t q = 0; q < waves; ++q) {
        gain[q] = rho * z.weight[q] * (1.0 - layer_response(z.point[q], poisson));
        for (int i = 0; i <= n; ++i)
            wave[i * waves + q] = std::cos(z.point[q] * rho * (i < n ? x.point[i] : 1.0));
    }
    const auto kernel = [&](int i, int j) {
        double sum = 0.0;
        for (std::size_t q = 0; q < waves; ++q)
            sum += gain[q] * wave[i * waves + q] * wave[j * waves + q];
        return sum;
    };

    std::vector<double> A(n * n);
    std::vector<std::vector<double>> phi(2, std::vector<double>(n)); // times sqrt(weight)
    for (int i = 0; i < n; ++i) {
        const double root = std::sqrt(x.weight[i]);
        for (int j = 0; j <= i; ++j)
            A[i * n + j] = -root * std::sqrt(x.weight[j]) * kernel(i, j) + (i == j ? pi / 2 : 0.0);
        phi[0][i] = root;
        phi[1][i] = root * x.point[i] * x.point[i];
    }
    solve_dense(A, n, phi);

    std::array<double, 2> total{}, rim{1.0, 1.0};
    for (int k = 0; k < 2; ++k) {
        for (int i = 0; i < n; ++i) {
            total[k] += std::sqrt(x.weight[i]) * phi[k][i];
            rim[k] += std::sqrt(x.weight[i]) * phi[k][i] * kernel(n, i);
        }
    }
    const double chi = rim[1] / rim[0];
    return {0.5 * pi * total[0], chi, 0.75 * pi * (chi * total[0] - total[1]) / chi};
}

double kernel_response(double ratio, double poisson) {
    if (!(ratio > 0.0))
        return 1.0;
    const QuadratureRule& rule = kernel_rule();
    double sum = 0.0;
    for (std::size_t q = 0; q < rule.point.size(); ++q)
        sum += rule.weight[q] * (1.0 - layer_response(rule.point[q] / ratio, poisson));
    return 1.0 - sum / kernel_self_integral();
}

double kernel_self_integral() {
    static const double value = [] {
        double sum = 0.0;
        for (const double w : kernel_rule().weight)
            sum += w;
        return sum;
    }();
    return value;
}

} // namespace tissue
