#include "tasks/score/smoothness.h"

#include "tasks/score/metrics.h"

#include <algorithm>
#include <cmath>

namespace tasks {

std::vector<std::span<const double>> sub_movements(std::span<const double> speed_mps,
                                                   double fs_hz) {
    std::vector<std::span<const double>> found;
    const auto enough = static_cast<std::size_t>(std::ceil(kSubMovementMin_s * fs_hz));
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= speed_mps.size(); ++i) {
        if (i < speed_mps.size() && speed_mps[i] > kMoving_mps)
            continue;
        if (i - begin >= enough)
            found.push_back(speed_mps.subspan(begin, i - begin));
        begin = i + 1;
    }
    return found;
}

std::optional<double> median(std::vector<double> values) {
    if (values.empty())
        return {};
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// Second differences of speed; N samples last T = N/fs, as in the published reference.
std::optional<double> ldlj(std::span<const double> speed_mps, double fs_hz) {
    if (speed_mps.size() < 3)
        return {};
    const double T = static_cast<double>(speed_mps.size()) / fs_hz;
    double v_peak = 0.0, integral = 0.0;
    for (const double v : speed_mps)
        v_peak = std::max(v_peak, std::abs(v));
    for (std::size_t i = 2; i < speed_mps.size(); ++i) {
        const double jerk =
            (speed_mps[i] - 2.0 * speed_mps[i - 1] + speed_mps[i - 2]) * fs_hz * fs_hz;
        integral += jerk * jerk / fs_hz;
    }
    const double dimensionless = T * T * T / (v_peak * v_peak) * integral;
    if (!(dimensionless > 0.0) || !std::isfinite(dimensionless))
        return {}; // at rest, or at exactly constant acceleration: no jerk to take a logarithm of
    return -std::log(dimensionless);
}

} // namespace tasks
