// tasks/score/low_pass.cpp
// Zero-phase low pass of recorded paths. Called by finish() and by `trocar measure`.
#include "tasks/score/metrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tasks {
namespace {

// Second-order Butterworth through the bilinear transform, w = tan(pi fc/fs):
//   H(z) = w^2 (1 + z^-1)^2 / ((1 + sqrt2 w + w^2) + 2 (w^2 - 1) z^-1 + (1 - sqrt2 w + w^2) z^-2)
struct Biquad {
    double b0, b1, b2, a1, a2;
};

Biquad butterworth(double fs_hz, double cutoff_hz) {
    const double w = std::tan(std::numbers::pi * cutoff_hz / fs_hz);
    const double scale = 1.0 / (1.0 + std::numbers::sqrt2 * w + w * w);
    const double b0 = w * w * scale;
    return {b0, 2.0 * b0, b0, 2.0 * (w * w - 1.0) * scale,
            (1.0 - std::numbers::sqrt2 * w + w * w) * scale};
}

// In place, started as if the first sample had been there for ever (direct form II transposed).
template <typename Iterator> void run(const Biquad& f, Iterator first, Iterator last) {
    glm::dvec3 z1 = *first * (1.0 - f.b0), z2 = *first * (f.b2 - f.a2);
    for (; first != last; ++first) {
        const glm::dvec3 x = *first, y = f.b0 * x + z1;
        z1 = f.b1 * x - f.a1 * y + z2;
        z2 = f.b2 * x - f.a2 * y;
        *first = y;
    }
}

} // namespace

std::vector<glm::dvec3> low_pass(std::span<const glm::dvec3> path_m, double fs_hz,
                                 double cutoff_hz) {
    const std::size_t n = path_m.size();
    if (n < 2 || cutoff_hz >= 0.5 * fs_hz)
        return {path_m.begin(), path_m.end()};

    // Reflected through the end points (2 x0 - x), two periods of the cut-off: the transient of
    // the start, exp(-sqrt2 pi fc t), is then below 2e-4.
    const auto wanted = static_cast<std::size_t>(std::ceil(2.0 * fs_hz / cutoff_hz));
    const std::size_t pad = std::min(n - 1, wanted);
    std::vector<glm::dvec3> work(n + 2 * pad);
    for (std::size_t i = 0; i < pad; ++i) {
        work[i] = 2.0 * path_m[0] - path_m[pad - i];
        work[n + pad + i] = 2.0 * path_m[n - 1] - path_m[n - 2 - i];
    }
    std::copy(path_m.begin(), path_m.end(), work.begin() + static_cast<std::ptrdiff_t>(pad));

    const Biquad filter = butterworth(fs_hz, cutoff_hz);
    run(filter, work.begin(), work.end());
    run(filter, work.rbegin(), work.rend());
    const auto begin = work.begin() + static_cast<std::ptrdiff_t>(pad);
    return {begin, begin + static_cast<std::ptrdiff_t>(n)};
}

} // namespace tasks
