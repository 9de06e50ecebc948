#include "tasks/score/smoothness.h"

#include "tasks/score/metrics.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

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

double squared_jerk_m2ps5(std::span<const glm::dvec3> path_m, double fs_hz) {
    double sum_m2 = 0.0;
    for (std::size_t i = 3; i < path_m.size(); ++i) {
        const glm::dvec3 third = path_m[i] - 3.0 * (path_m[i - 1] - path_m[i - 2]) - path_m[i - 3];
        sum_m2 += glm::dot(third, third);
    }
    return sum_m2 * std::pow(fs_hz, 5); // |d3p fs^3|^2 / fs
}

std::optional<double> jerk_norm(double duration_s, double length_m, double squared_jerk_m2ps5) {
    constexpr double kShortest_m = 1e-3;
    if (length_m < kShortest_m)
        return {};
    return std::sqrt(std::pow(duration_s, 5) / (2.0 * length_m * length_m) * squared_jerk_m2ps5);
}

std::optional<double> speed_correlation(std::span<const double> one_mps,
                                        std::span<const double> other_mps) {
    constexpr double kSteady_mps = 1e-6;
    const std::size_t n = std::min(one_mps.size(), other_mps.size());
    const auto both_move = [&](std::size_t i) {
        return one_mps[i] >= kMoving_mps && other_mps[i] >= kMoving_mps;
    };
    double count = 0.0, mean_a = 0.0, mean_b = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        if (!both_move(i))
            continue;
        count += 1.0;
        mean_a += one_mps[i];
        mean_b += other_mps[i];
    }
    if (count < 2.0)
        return {};
    mean_a /= count;
    mean_b /= count;
    double aa = 0.0, bb = 0.0, ab = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        if (!both_move(i))
            continue;
        const double a = one_mps[i] - mean_a, b = other_mps[i] - mean_b;
        aa += a * a;
        bb += b * b;
        ab += a * b;
    }
    const double least = kSteady_mps * kSteady_mps * count;
    if (aa < least || bb < least)
        return {};
    return ab / std::sqrt(aa * bb);
}

} // namespace tasks
