// tasks/score/sparc.cpp
// Spectral arc length of a speed, after the published reference implementation. Called by finish().
#include "tasks/score/smoothness.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>

namespace tasks {
namespace {

constexpr int kPadLevels = 4;
constexpr double kCutoff_hz = 10.0, kThreshold = 0.05;

// In place, radix 2, decimation in time (Cooley and Tukey 1965). `x` has a power of two entries.
void transform(std::vector<std::complex<double>>& x) {
    const std::size_t n = x.size();
    for (std::size_t i = 1, j = 0; i < n; ++i) { // j counts as i does, with its bits reversed
        std::size_t bit = n / 2;
        for (; j & bit; bit /= 2)
            j ^= bit;
        j ^= bit;
        if (i < j)
            std::swap(x[i], x[j]);
    }
    std::vector<std::complex<double>> turn(n / 2);
    for (std::size_t k = 0; k < turn.size(); ++k)
        turn[k] = std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k) /
                                      static_cast<double>(n));
    for (std::size_t half = 1; half < n; half *= 2) {
        const std::size_t stride = n / (2 * half);
        for (std::size_t block = 0; block < n; block += 2 * half)
            for (std::size_t k = 0; k < half; ++k) {
                const std::complex<double> a = x[block + k], b = x[block + half + k];
                const std::complex<double> w = turn[k * stride];
                const std::complex<double> turned{b.real() * w.real() - b.imag() * w.imag(),
                                                  b.real() * w.imag() + b.imag() * w.real()};
                x[block + k] = a + turned;
                x[block + half + k] = a - turned;
            }
    }
}

// |V| / max |V| of the bins up to the cut-off; empty at rest.
std::vector<double> low_spectrum(std::span<const double> speed_mps, double fs_hz) {
    const std::size_t n = std::bit_ceil(speed_mps.size()) << kPadLevels;
    std::vector<std::complex<double>> x(n);
    std::copy(speed_mps.begin(), speed_mps.end(), x.begin());
    transform(x);
    double largest = 0.0;
    for (const std::complex<double>& value : x)
        largest = std::max(largest, std::abs(value));
    std::vector<double> low;
    if (!(largest > 0.0) || !std::isfinite(largest))
        return low;
    const double bin_hz = fs_hz / static_cast<double>(n);
    for (std::size_t k = 0; k < n && static_cast<double>(k) * bin_hz <= kCutoff_hz; ++k)
        low.push_back(std::abs(x[k]) / largest);
    return low;
}

} // namespace

std::optional<double> sparc(std::span<const double> speed_mps, double fs_hz) {
    if (speed_mps.empty())
        return {};
    const std::vector<double> low = low_spectrum(speed_mps, fs_hz);
    const auto enough = [](double share) { return share >= kThreshold; };
    const auto first = std::find_if(low.begin(), low.end(), enough);
    const auto end = std::find_if(low.rbegin(), low.rend(), enough).base();
    if (end - first < 2)
        return {};
    const double step = 1.0 / static_cast<double>(end - first - 1);
    double length = 0.0;
    for (auto bin = first + 1; bin != end; ++bin)
        length += std::hypot(step, *bin - *(bin - 1));
    return -length;
}

} // namespace tasks
