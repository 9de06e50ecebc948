// See the header.
#include "tissue/rod/band_factor.h"

#include <algorithm>

namespace tissue {

BandMatrix make_band(int size, int band) {
    return {size, band, std::vector<double>(static_cast<std::size_t>(size * (band + 1)), 0.0)};
}

// Row by row: l_ij d_j = a_ij - sum_k l_ik d_k l_jk, d_i = a_ii - sum_k l_ik^2 d_k
bool factor(BandMatrix& matrix) noexcept {
    std::vector<double>& a = matrix.value;
    double largest = 0.0;
    for (int i = 0; i < matrix.size; ++i)
        largest = std::max(largest, a[matrix.at(i, i)]);
    for (int i = 0; i < matrix.size; ++i) {
        const int first = std::max(0, i - matrix.band);
        for (int j = first; j < i; ++j) { // leaves l_ij d_j for now
            for (int k = std::max(first, j - matrix.band); k < j; ++k)
                a[matrix.at(i, j)] -= a[matrix.at(i, k)] * a[matrix.at(j, k)];
        }
        for (int j = first; j < i; ++j) {
            const double scaled = a[matrix.at(i, j)];
            a[matrix.at(i, j)] = scaled / a[matrix.at(j, j)];
            a[matrix.at(i, i)] -= scaled * a[matrix.at(i, j)];
        }
        if (!(a[matrix.at(i, i)] > 1e-14 * largest))
            return false;
    }
    return true;
}

void solve(const BandMatrix& factored, std::span<double> x) noexcept {
    const std::vector<double>& a = factored.value;
    for (int i = 0; i < factored.size; ++i) {
        for (int j = std::max(0, i - factored.band); j < i; ++j)
            x[static_cast<std::size_t>(i)] -= a[factored.at(i, j)] * x[static_cast<std::size_t>(j)];
    }
    for (int i = 0; i < factored.size; ++i)
        x[static_cast<std::size_t>(i)] /= a[factored.at(i, i)];
    for (int i = factored.size - 1; i >= 0; --i) {
        for (int j = std::max(0, i - factored.band); j < i; ++j)
            x[static_cast<std::size_t>(j)] -= a[factored.at(i, j)] * x[static_cast<std::size_t>(i)];
    }
}

void multiply(const BandMatrix& matrix, std::span<const double> x, std::span<double> y) noexcept {
    std::fill(y.begin(), y.end(), 0.0);
    for (int i = 0; i < matrix.size; ++i) {
        const auto row = static_cast<std::size_t>(i);
        for (int j = std::max(0, i - matrix.band); j < i; ++j) {
            const auto column = static_cast<std::size_t>(j);
            y[row] += matrix.value[matrix.at(i, j)] * x[column];
            y[column] += matrix.value[matrix.at(i, j)] * x[row];
        }
        y[row] += matrix.value[matrix.at(i, i)] * x[row];
    }
}

} // namespace tissue
