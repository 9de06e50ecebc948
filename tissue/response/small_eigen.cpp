// tissue/response/small_eigen.cpp
// Pivoted Cholesky and one-sided Jacobi for the contact basis. Tissue loop, every step.
#include "tissue/response/small_eigen.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tissue {
namespace {

using Column = std::array<double, kSmall>;

// Padded length and four sums: the compiler makes SIMD of it without changing the order.
double product_of(const Column& a, const Column& b) noexcept {
    std::array<double, 4> sum{};
    for (int k = 0; k < kSmall; k += 4) {
        for (int i = 0; i < 4; ++i)
            sum[i] += a[k + i] * b[k + i];
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

void rotate(Column& a, Column& b, double c, double s) noexcept {
    for (int k = 0; k < kSmall; ++k) {
        const double x = a[k], y = b[k];
        a[k] = c * x - s * y;
        b[k] = s * x + c * y;
    }
}

// Swaps rows and columns i < j of a symmetric matrix kept in its lower triangle.
void swap_symmetric(SmallMatrix& m, int size, int i, int j) noexcept {
    if (i == j)
        return;
    std::swap(m[i][i], m[j][j]);
    for (int k = 0; k < i; ++k)
        std::swap(m[k][i], m[k][j]);
    for (int k = i + 1; k < j; ++k)
        std::swap(m[i][k], m[k][j]);
    for (int k = j + 1; k < size; ++k)
        std::swap(m[i][k], m[j][k]);
}

// Takes column `at` as the next pivot and removes it from what is left.
void eliminate(SmallMatrix& m, int size, int at) noexcept {
    const double pivot = std::sqrt(m[at][at]);
    m[at][at] = pivot;
    for (int k = at + 1; k < size; ++k)
        m[at][k] /= pivot;
    for (int j = at + 1; j < size; ++j) {
        const double factor = m[at][j];
        for (int k = j; k < size; ++k)
            m[j][k] -= factor * m[at][k];
    }
}

void clear_outside(SmallMatrix& m, int taken) noexcept {
    for (int j = 0; j < kSmall; ++j) {
        for (int k = 0; k < kSmall; ++k) {
            if (j >= taken || k >= taken || k < j)
                m[j][k] = 0.0;
        }
    }
}

} // namespace

int pivoted_cholesky(SmallMatrix& matrix, int size, std::span<const int> group_size, double cut,
                     std::array<int, kSmall>& kept) noexcept {
    std::iota(kept.begin(), kept.end(), 0);
    int taken = 0, end = 0;
    for (const int group : group_size) {
        const int begin = end;
        end += group;
        // what earlier groups left out lies between `taken` and `begin`: bring this group forward
        for (int left = group, next = begin; left > 0; --left, ++next) {
            int best = next;
            for (int k = next; k < end; ++k) {
                if (matrix[k][k] > matrix[best][best])
                    best = k;
            }
            if (!(matrix[best][best] > cut))
                break;
            swap_symmetric(matrix, size, next, best);
            std::swap(kept[next], kept[best]);
            swap_symmetric(matrix, size, taken, next);
            std::swap(kept[taken], kept[next]);
            eliminate(matrix, size, taken);
            ++taken;
        }
    }
    clear_outside(matrix, taken);
    return taken;
}

bool cholesky(SmallMatrix& matrix, int size) noexcept {
    for (int at = 0; at < size; ++at) {
        if (!(matrix[at][at] > 0.0))
            return false;
        eliminate(matrix, size, at);
    }
    clear_outside(matrix, size);
    return true;
}

int positive_eigen(SmallMatrix& matrix, int size, std::array<double, kSmall>& value) noexcept {
    constexpr int kSweeps = 20;
    constexpr double kSmallAngle = 1e-15;
    if (!cholesky(matrix, size))
        return 0;
    int sweeps = 0;
    for (bool turned = true; turned && sweeps < kSweeps; ++sweeps) {
        turned = false;
        for (int j = 0; j < size; ++j)
            value[j] = product_of(matrix[j], matrix[j]);
        for (int p = 0; p < size - 1; ++p) {
            for (int q = p + 1; q < size; ++q) {
                const double cross = product_of(matrix[p], matrix[q]);
                if (std::abs(cross) <= kSmallAngle * std::sqrt(value[p] * value[q]))
                    continue;
                turned = true;
                const double zeta = (value[q] - value[p]) / (2.0 * cross);
                const double t =
                    std::copysign(1.0, zeta) / (std::abs(zeta) + std::sqrt(1.0 + zeta * zeta));
                const double c = 1.0 / std::sqrt(1.0 + t * t);
                rotate(matrix[p], matrix[q], c, c * t);
                value[p] -= t * cross;
                value[q] += t * cross;
            }
        }
    }

    // columns are now eigenvectors times the root of their eigenvalue
    for (int j = 0; j < size; ++j) {
        value[j] = product_of(matrix[j], matrix[j]);
        const double scale = 1.0 / std::sqrt(value[j]);
        for (double& x : matrix[j])
            x *= scale;
    }
    for (int j = 1; j < size; ++j) {
        for (int k = j; k > 0 && value[k] < value[k - 1]; --k) {
            std::swap(value[k], value[k - 1]);
            std::swap(matrix[k], matrix[k - 1]);
        }
    }
    return sweeps;
}

} // namespace tissue
