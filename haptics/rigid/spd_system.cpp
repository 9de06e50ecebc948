#include "haptics/rigid/spd_system.h"

#include <algorithm>
#include <cmath>

namespace haptics {

bool solve(SpdSystem& system) noexcept {
    auto& a = system.a;
    const std::size_t n = system.n;
    for (std::size_t j = 0; j < n; ++j) {
        double pivot = a[j][j];
        for (std::size_t k = 0; k < j; ++k)
            pivot -= a[j][k] * a[j][k];
        if (!(pivot > 0.0))
            return false;
        a[j][j] = std::sqrt(pivot);
        for (std::size_t i = j + 1; i < n; ++i) {
            double sum = a[i][j];
            for (std::size_t k = 0; k < j; ++k)
                sum -= a[i][k] * a[j][k];
            a[i][j] = sum / a[j][j];
        }
    }
    auto& x = system.b;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k)
            x[i] -= a[i][k] * x[k];
        x[i] /= a[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k)
            x[i] -= a[k][i] * x[k];
        x[i] /= a[i][i];
    }
    return std::all_of(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n),
                       [](double v) { return std::isfinite(v); });
}

double largest_eigenvalue(Matrix6 m) noexcept {
    constexpr int kSweeps = 12; // quadratic: six are enough for 1e-15
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (std::size_t p = 0; p < 5; ++p) {
            for (std::size_t q = p + 1; q < 6; ++q) {
                if (m[p][q] == 0.0)
                    continue;
                // the rotation that makes m[p][q] zero (Golub, Van Loan 8.5)
                const double tau = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
                const double t = std::copysign(1.0, tau) / (std::abs(tau) + std::hypot(1.0, tau));
                const double c = 1.0 / std::hypot(1.0, t), s = t * c;
                for (auto& row : m) {
                    const double x = row[p], y = row[q];
                    row[p] = c * x - s * y;
                    row[q] = s * x + c * y;
                }
                for (std::size_t k = 0; k < 6; ++k) {
                    const double x = m[p][k], y = m[q][k];
                    m[p][k] = c * x - s * y;
                    m[q][k] = s * x + c * y;
                }
            }
        }
    }
    double most = m[0][0];
    for (std::size_t i = 1; i < 6; ++i)
        most = std::max(most, m[i][i]);
    return most;
}

} // namespace haptics
